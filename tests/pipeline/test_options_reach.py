"""Which plug-in an option reaches, and what is refused."""

import pytest

from stackloft.model.errors import UsageError
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure

PITCH = {"thickness": 2.5}


def prism_calls(house, disk, **request):
    house.CALLS.clear()
    request.setdefault("shared", PITCH)
    measure(MeasureRequest(disk, method=request.pop("method", "prism"), **request))
    return house.CALLS[1]


@pytest.mark.parametrize(
    "key", ["prism", "reconstructor", "reconstructor.prism", "disk-house:prism", "prism/reconstructor.prism"]
)
def test_every_address_reaches_the_plugin(house, disk, key):
    assert prism_calls(house, disk, settings={key: {"points": "40"}}) == "prism 40 1.0"


def test_the_more_particular_address_wins(house, disk):
    settings = {"reconstructor.prism": {"points": 6}, "reconstructor": {"points": 4}, "prism": {"points": 5}}
    assert prism_calls(house, disk, settings=settings) == "prism 6 1.0"


def test_order_of_layers(house, disk):
    long = {"method": "long-prism"}
    assert prism_calls(house, disk, **long) == "prism 33 2.0"
    base = {"reconstructor.prism": {"stretch": 3, "points": 7}}
    assert prism_calls(house, disk, base=base, **long) == "prism 7 3.0"
    shared = {**PITCH, "points": 8}
    assert prism_calls(house, disk, base=base, shared=shared, **long) == "prism 8 3.0"
    settings = {"prism": {"points": 9}}
    assert prism_calls(house, disk, base=base, shared=shared, settings=settings, **long) == "prism 9 3.0"


def test_a_method_s_own_address_leaves_the_other_method_alone(house, disk):
    settings = {"long-prism/reconstructor.prism": {"stretch": 5}}
    measure(MeasureRequest(disk, method="prism,long-prism", shared=PITCH, settings=settings))
    assert house.CALLS[1:] == ["prism 33 1.0", "prism 33 5.0"]


@pytest.mark.parametrize(
    ("request_parts", "message"),
    [
        (
            {"shared": {**PITCH, "height": 3}},
            r"--height: no plug-in of this run \(reader.disk, .*\) takes it",
        ),
        ({"shared": {"thicknes": 3}}, "--thicknes: .*; fix: did you mean thickness"),
        ({"shared": {"thickness": "-3mm"}}, "reader.disk.thickness: the value should be greater than 0"),
        ({"settings": {"prizm": {"points": 3}}}, "--set: .* addressed by 'prizm'; fix: did you mean prism"),
        ({"settings": {"prism": {"pionts": 3}}}, "reconstructor.prism has no option 'pionts'; fix: .*points"),
        ({"settings": {"prism": {"points": 3}}}, "reconstructor.prism.points: .* greater than or equal to 4"),
        ({"settings": {"plain": {"x": 3}}}, "addressed by 'plain'"),
        ({"base": {"prizm": {"points": 3}}}, "recipe: .* addressed by 'prizm'"),
        ({"base": {"prism": {"pionts": 3}}}, "recipe: reconstructor.prism has no option 'pionts'"),
    ],
)
def test_what_reaches_nobody_is_refused_before_reading(house, disk, request_parts, message):
    with pytest.raises(UsageError, match=message):
        measure(MeasureRequest(disk, method="prism", **request_parts))
    assert house.CALLS == []


def test_recipe_options_of_a_plugin_without_a_part_are_noticed(house, disk):
    base = {"reconstructor.prism": {"points": 7}}
    result = measure(MeasureRequest(disk, method="plain", shared=PITCH, base=base)).result
    assert [notice.code for notice in result.warnings] == ["recipe-unused", "disk-like"]
