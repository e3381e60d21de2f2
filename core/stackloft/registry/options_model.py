"""One place turns a plug-in's fields into validation, JSON Schema and plain values.

Text and typed values go through the same door: ``--set``, a recipe file, JSON and Python agree.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

from stackloft.model.errors import StackloftError, UsageError
from stackloft.model.lengths import parse_length, parse_lengths
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.find import nearest

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

NONE = "none"
"""How an open option is written in text."""


def validate(plugin: Any, options: Mapping[str, Any], key: str) -> dict[str, Any]:
    """Return every option of `plugin`, typed and within its bounds; what is not given is its default.

    Parameters
    ----------
    plugin : type
        The plug-in class.
    options : mapping
        By name (``pixel-size`` and ``pixel_size`` are the same); text or typed values. Lengths may
        carry a unit and come out in mm.
    key : str
        ``family.name``, for messages.

    Raises
    ------
    UsageError
        An unknown option (with the nearest name), or a value that is not allowed.
    """
    from pydantic import ValidationError  # noqa: PLC0415 - kept out of every start

    given = {name.replace("-", "_"): value for name, value in options.items()}
    fields = {item.name: item for item in fields_of(plugin)}
    for name in given:
        if name not in fields:
            raise UsageError(f"no option {name!r}", where=key, fix=nearest(name, list(fields)))
    try:
        model = options_model(plugin).model_validate(given)
    except ValidationError as error:
        raise _usage_error(error, fields, key) from None
    return {name: getattr(model, _inner(name)) for name in fields}


def schema(plugin: Any) -> dict[str, Any]:
    """Return the JSON Schema of the plug-in's options: types, bounds, units, defaults, help.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from stackloft.contracts.options import option
    >>> @dataclass(frozen=True)
    ... class Loft:
    ...     points: int = option(33, "points per loop", ge=4)
    >>> schema(Loft)["properties"]["points"]["minimum"]
    4
    """
    return options_model(plugin).model_json_schema()


def plain(value: Any) -> Any:
    """Return `value` as JSON and TOML hold it; `validate` turns it back into the same value.

    Examples
    --------
    >>> plain((1.5, 2.0))
    [1.5, 2.0]
    """
    if isinstance(value, enum.Enum):
        return value.value
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return str(value)


@cache
def options_model(plugin: Any) -> type[BaseModel]:
    """Return the pydantic model of the plug-in's options; field aliases are the options' names."""
    from pydantic import ConfigDict, create_model  # noqa: PLC0415 - kept out of every start

    config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True, title=plugin.__name__)
    fields: dict[str, Any] = {_inner(item.name): _definition(item) for item in fields_of(plugin)}
    model: type[BaseModel] = create_model(f"{plugin.__name__}Options", __config__=config, **fields)
    return model


def _inner(name: str) -> str:
    """Return a field name that cannot shadow a member of pydantic's BaseModel (``json``, ``copy``)."""
    return f"option_{name}"


def _definition(item: OptionField) -> tuple[Any, Any]:
    from pydantic import BeforeValidator, Field  # noqa: PLC0415 - kept out of every start

    extra: dict[str, Any] = {
        "unit": item.unit,
        "source": item.source,
        "enum": list(item.choices) if item.choices else None,
    }
    about = Field(
        default=item.default,
        alias=item.name,
        description=item.help or None,
        json_schema_extra={key: value for key, value in extra.items() if value},
    )
    inner = _bounded(item)
    whole: Any = inner | None if item.optional else inner
    return Annotated[whole, BeforeValidator(partial(_from_text, item))], about


def _bounded(item: OptionField) -> Any:
    from pydantic import AfterValidator, Field, PlainSerializer, WithJsonSchema  # noqa: PLC0415

    if _parser(item.annotation) is not None:
        text = {"type": "string"}
        return Annotated[item.annotation, PlainSerializer(str), WithJsonSchema(text)]
    if _parser(_element(item.annotation)) is not None:
        texts = {"type": "array", "items": {"type": "string"}}
        return Annotated[item.annotation, PlainSerializer(plain), WithJsonSchema(texts)]
    bounds: dict[str, Any] = dict(item.bounds)
    number = (
        {**bounds, "allow_inf_nan": False}
        if float in {item.annotation, _element(item.annotation)}
        else bounds
    )
    if get_origin(item.annotation) is tuple:
        parts = [
            part if part is Ellipsis else Annotated[part, Field(**number)]
            for part in get_args(item.annotation)
        ]
        return tuple[tuple(parts)]  # type: ignore[misc]  # built at run time
    return Annotated[item.annotation, Field(**number), AfterValidator(partial(_chosen, item))]


def _from_text(item: OptionField, value: Any) -> Any:
    """Turn text into what pydantic then checks; errors become ValueErrors, as pydantic wants them."""
    if item.optional and isinstance(value, str) and value.strip().lower() == NONE:
        return None
    if isinstance(value, bool) and item.annotation in {int, float}:
        message = "a number is needed"
        raise ValueError(message)
    try:
        return _typed(item, value)
    except StackloftError as error:
        raise ValueError(str(error)) from None


def _typed(item: OptionField, value: Any) -> Any:
    element = _element(item.annotation)
    if item.unit == "%" and isinstance(value, str):
        value = value.strip().removesuffix("%")
    if element is None:
        parse = parse_length if item.unit == "mm" else _parser(item.annotation)
        return parse(value) if parse and isinstance(value, str) else value
    if isinstance(value, str):
        value = parse_lengths(value) if item.unit == "mm" else value.split(",")
    parse = parse_length if item.unit == "mm" else _parser(element)
    if isinstance(value, (list, tuple)) and parse is not None:
        value = [parse(part) if isinstance(part, str) else part for part in value]
    return _repeated(item.annotation, value)


def _repeated(annotation: Any, value: Any) -> Any:
    """One value alone serves every place of a fixed tuple: ``--ends round`` is ``round,round``."""
    parts = get_args(annotation)
    if Ellipsis in parts or not isinstance(value, (list, tuple)) or len(value) != 1:
        return value
    return list(value) * len(parts)


def _element(annotation: Any) -> Any:
    """Return the type of a tuple's elements, None when it is no tuple of one type."""
    if get_origin(annotation) is not tuple:
        return None
    parts = {part for part in get_args(annotation) if part is not Ellipsis}
    return parts.pop() if len(parts) == 1 else None


def _parser(annotation: Any) -> Callable[[str], Any] | None:
    """Return the ``parse`` of a value class such as `End`; None for everything else."""
    if not isinstance(annotation, type) or issubclass(annotation, (enum.Enum, Path)):
        return None
    parse: Callable[[str], Any] | None = getattr(annotation, "parse", None)
    return parse


def _chosen(item: OptionField, value: Any) -> Any:
    if item.choices is not None and value is not None and value not in item.choices:
        hint = nearest(str(value), list(item.choices))
        message = f"one of {', '.join(item.choices)} is needed; {hint}"
        raise ValueError(message)
    return value


def _usage_error(error: ValidationError, fields: Mapping[str, OptionField], key: str) -> UsageError:
    first = error.errors()[0]
    name = str(first["loc"][0])
    item = fields[name]
    what = first["msg"].removeprefix("Value error, ").replace("Input should", "the value should")
    unit = f" in {item.unit}" if item.unit else ""
    return UsageError(
        what,
        where=f"{key}.{name}",
        found=repr(first["input"]),
        expected=f"{item.type_name}{unit}: {item.help}" if item.help else f"{item.type_name}{unit}",
    )
