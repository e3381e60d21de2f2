"""One declaration gives validation, text parsing, JSON Schema and plain values."""

import json
from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

import jsonschema
import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st

from stackloft.contracts.options import option
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError, PluginError, UsageError
from stackloft.registry import Loaded, instantiate, parse_settings, plain, schema, validate
from stackloft.registry.fields import fields_of
from stackloft.registry.scan import Listing


class Rule(StrEnum):
    RECTANGLE = "rectangle"
    TRAPEZOID = "trapezoid"


@dataclass(frozen=True)
class Everything:
    api: ClassVar[str] = "1"

    points: int = option(33, "points per loop", ge=4, le=500, source="Goñi 2007")
    pixel_size: float | None = option(None, "pixel size", unit="mm", gt=0)
    size_or_text: float | str | None = option(None, "as people write it", unit="mm", gt=0)
    positions: tuple[float, ...] | str | None = option(None, "slice positions", unit="mm")
    ratio: float = option(0.5, "ratio", ge=0, lt=1)
    smooth: bool = option(True, "smooth or not")
    method: str = option("otsu", "threshold", choices=("otsu", "isodata"))
    rule: Rule = option(Rule.RECTANGLE, "rule of integration")  # noqa: RUF009
    ends: tuple[End, End] = option((End(), End()), "both ends")
    counts: tuple[int, ...] = option((1, 2), "counts", ge=1)
    json: str = option("", "a name that pydantic's BaseModel uses itself")
    copy: float | None = option(0.25, "open although its default is not", ge=0)


def valid(**options):
    return validate(Everything, options, "reader.everything")


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("points", "40", 40),
        ("pixel_size", "0.25 cm", 2.5),
        ("pixel-size", "57.5um", 0.0575),
        ("pixel_size", "none", None),
        ("pixel_size", 3, 3.0),
        ("size_or_text", "5.6mm", 5.6),
        ("positions", "0,0.5,1cm", (0.0, 5.0, 10.0)),
        ("positions", [0, "5mm", 10.5], (0.0, 5.0, 10.5)),
        ("smooth", "false", False),
        ("smooth", "yes", True),
        ("method", "isodata", "isodata"),
        ("rule", "trapezoid", Rule.TRAPEZOID),
        ("ends", "face,round:2mm", (End(EndKind.FACE), End(EndKind.ROUND, 2.0))),
        ("ends", "round", (End(EndKind.ROUND), End(EndKind.ROUND))),
        ("ends", (End(EndKind.FACE), End()), (End(EndKind.FACE), End())),
        ("counts", "3,4,5", (3, 4, 5)),
        ("json", "x", "x"),
        ("copy", "none", None),
    ],
)
def test_text_and_typed_values(name, text, value):
    found = valid(**{name: text})[name.replace("-", "_")]
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        (
            "points",
            "3",
            r"reader.everything.points: the value should be greater than or equal to 4; found: '3'",
        ),
        ("points", "3.5", "integer"),
        ("points", True, "a number is needed"),
        ("points", "none", "integer"),
        ("pixel_size", "0", "greater than 0"),
        ("pixel_size", "5 stone", "unknown unit"),
        ("pixel_size", "wide", "not a length"),
        ("pixel_size", float("nan"), "finite"),
        ("pixel_size", "1e999", "finite"),
        ("ratio", 1, "less than 1"),
        ("ratio", float("inf"), "finite"),
        ("method", "isodta", "one of otsu, isodata is needed; did you mean isodata"),
        ("rule", "simpson", "rectangle"),
        ("ends", "sharp", "unknown end"),
        ("ends", "face,round,face", "at most 2"),
        ("counts", "1,0", "greater than or equal to 1"),
        ("positions", "0,a", "not a length"),
        ("smooth", "maybe", "boolean"),
    ],
)
def test_what_is_not_allowed_is_named(name, value, message):
    with pytest.raises(UsageError, match=message) as caught:
        valid(**{name: value})
    assert caught.value.where == f"reader.everything.{name}"
    assert caught.value.exit_status == 2


def test_unknown_option_names_the_nearest():
    with pytest.raises(
        UsageError, match=r"reader.everything: no option 'pixelsize'; fix: did you mean pixel_size"
    ):
        valid(pixelsize=1)


def test_defaults_are_the_dataclass_s_own():
    assert Everything(**valid()) == Everything()


def test_schema_is_valid_and_says_what_the_declaration_says():
    found = schema(Everything)
    jsonschema.Draft202012Validator.check_schema(found)
    points, size = found["properties"]["points"], found["properties"]["pixel_size"]
    assert (points["minimum"], points["maximum"], points["default"]) == (4, 500, 33)
    assert points["source"] == "Goñi 2007"
    assert size["unit"] == "mm"
    assert found["properties"]["method"]["enum"] == ["otsu", "isodata"]
    assert found["additionalProperties"] is False
    assert set(found["properties"]) == {item.name for item in fields_of(Everything)}
    json.dumps(found)


def test_plain_values_satisfy_the_schema_and_come_back():
    values = valid(pixel_size="0.3mm", ends="face,round:2.5mm", rule="trapezoid", positions="0,1,2.5")
    document = {name: plain(value) for name, value in values.items()}
    jsonschema.validate(document, schema(Everything))
    assert valid(**json.loads(json.dumps(document))) == values


@given(
    pixel=st.none() | st.floats(1e-6, 1e6),
    positions=st.lists(st.floats(-1e9, 1e9), min_size=1, max_size=5),
    points=st.integers(4, 500),
)
def test_toml_keeps_every_bit(pixel, positions, points):
    import tomllib  # noqa: PLC0415

    values = valid(pixel_size=pixel, positions=positions, points=points)
    document = {name: "none" if value is None else plain(value) for name, value in values.items()}
    assert valid(**tomllib.loads(tomli_w.dumps(document))) == values


def test_fields_describe_themselves():
    fields = {item.name: item for item in fields_of(Everything)}
    assert fields["pixel_size"].type_name == "float or none"
    assert fields["size_or_text"].type_name == "float or none"
    assert fields["positions"].type_name == "tuple[float, ...] or none"
    assert fields["points"].bounds == {"ge": 4, "le": 500}
    assert "api" not in fields


def test_settings_from_the_command_line():
    found = parse_settings(["segmenter.threshold = isodata", "reconstructor.loft.max-points=40", "a.b=c=d"])
    assert found == {
        "segmenter": {"threshold": "isodata"},
        "reconstructor.loft": {"max_points": "40"},
        "a": {"b": "c=d"},
    }


@pytest.mark.parametrize("text", ["threshold=1", "segmenter.threshold", ".x=1", "a.=1", ""])
def test_settings_that_are_none(text):
    with pytest.raises(UsageError, match=r"expected: family.option=value"):
        parse_settings([text])


def test_an_option_set_twice_is_refused():
    with pytest.raises(UsageError, match=r"a.x-y is set twice"):
        parse_settings(["a.x_y=1", "a.x-y=2"])


def raising(error):
    @dataclass(frozen=True)
    class Picky:
        def __post_init__(self):
            raise error

    return Loaded(Listing("reader", "picky", "acme", "1", "acme:Picky"), Picky)


@pytest.mark.parametrize(
    ("error", "kind", "message"),
    [
        (ValueError("first after last"), UsageError, "reader.picky: first after last"),
        (InputError("no table"), InputError, "no table"),
        (KeyError("x"), PluginError, "plug-in reader.picky of acme 1 failed; found: KeyError"),
    ],
)
def test_a_plugin_s_own_checks_speak_for_it(error, kind, message):
    with pytest.raises(kind, match=message):
        instantiate(raising(error), {})
