"""``recipe.toml``: everything that was chosen in a run, so that it runs again to the bit.

::

    schema = "stackloft.recipe/1"
    reader = "photos"
    segmenter = "histogram"
    method = "loft"

    [options."reader.photos"]
    pixel_size = 0.3

    [options."reconstructor.loft"]
    points = 33
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from stackloft.model.errors import InputError, UsageError
from stackloft.pipeline.plan import Plan, Step
from stackloft.pipeline.request import MeasureRequest
from stackloft.registry import fields_of, nearest, plain
from stackloft.registry.options_model import NONE

SCHEMA = "stackloft.recipe/1"
_KEYS = ("schema", "reader", "segmenter", "method", "options")


def recipe_of(plan: Plan, *, segmented: bool) -> dict[str, Any]:
    """Return the recipe of a run: plain TOML values, every option resolved, no None.

    Parameters
    ----------
    plan : Plan
        The run.
    segmented : bool
        True when the segmenter had a part in it.
    """
    segmenter = plan.segmenter if segmented else None
    methods = [method for method in plan.methods if method.error is None]
    recipe: dict[str, Any] = {"schema": SCHEMA}
    for name, step in (("reader", plan.reader), ("segmenter", segmenter)):
        if step is not None:
            recipe[name] = step.loaded.listing.qualified if step.loaded.listing.clash else step.loaded.name
    recipe["method"] = ",".join(method.name for method in methods)
    recipe["options"] = {
        step.key: plain_options(step) for step in (plan.reader, segmenter) if step is not None
    }
    for method in methods:
        for step in method.steps:
            options = plain_options(step)
            agreed = recipe["options"].setdefault(step.key, options)
            if agreed != options:
                recipe["options"][f"{method.name}/{step.key}"] = options
    return recipe


def plain_options(step: Step) -> dict[str, Any]:
    """Return a step's options as TOML holds them; an open one is left out, or ``none`` if that matters."""
    values = {}
    for item in fields_of(step.loaded.plugin):
        value = plain(step.options[item.name])
        if value is not None or item.default is not None:
            values[item.name] = NONE if value is None else value
    return values


def write_recipe(recipe: Mapping[str, Any], stream: BinaryIO) -> None:
    """Write `Result.recipe` as TOML; floats keep every bit."""
    import tomli_w  # noqa: PLC0415 - used here alone

    tomli_w.dump(dict(recipe), stream)


def load_recipe(path: Path, source: Path) -> MeasureRequest:
    """Return the request that runs the recipe file at `path` on `source`.

    Raises
    ------
    InputError
        The file cannot be read or is no recipe.
    UsageError
        An unknown key, with the nearest one.
    """
    try:
        text = path.read_text(encoding="utf-8")
        recipe = tomllib.loads(text)
    except OSError as error:
        raise InputError("the recipe cannot be read", where=str(path), found=error.strerror) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError("this is no TOML", where=str(path), found=str(error)) from error
    return request_of_recipe(recipe, source, str(path))


def request_of_recipe(recipe: Mapping[str, Any], source: Path, where: str = "recipe") -> MeasureRequest:
    """Return the request that runs `recipe` (`Result.recipe` or a parsed file) on `source`.

    Examples
    --------
    >>> request_of_recipe({"schema": "stackloft.recipe/1", "method": "frustum"}, Path("apple")).method
    'frustum'
    """
    _check_recipe(recipe, where)
    return MeasureRequest(
        source,
        reader=recipe.get("reader"),
        segmenter=recipe.get("segmenter"),
        method=recipe.get("method"),
        base=recipe.get("options", {}),
    )


def _check_recipe(recipe: Mapping[str, Any], where: str) -> None:
    if recipe.get("schema", SCHEMA) != SCHEMA:
        found = repr(recipe["schema"])
        raise InputError("another kind or version of recipe", where=where, found=found, expected=SCHEMA)
    for key, value in recipe.items():
        if key not in _KEYS:
            raise UsageError(f"no recipe key {key!r}", where=where, fix=nearest(key, list(_KEYS)))
        if key != "options" and not isinstance(value, str):
            raise InputError(f"{key} must be text", where=where, found=repr(value))
    options = recipe.get("options", {})
    if not isinstance(options, Mapping) or not all(isinstance(x, Mapping) for x in options.values()):
        raise InputError("options must be tables by family.name", where=where, found=repr(options))
