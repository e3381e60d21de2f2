"""A run's recipe, written and run again, gives the same numbers to the bit."""

import io
import tomllib

import pytest

from stackloft.model.errors import InputError, UsageError
from stackloft.pipeline.recipe_file import load_recipe, request_of_recipe, write_recipe
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure


def written(result, folder):
    stream = io.BytesIO()
    write_recipe(result.recipe, stream)
    path = folder / "recipe.toml"
    path.write_bytes(stream.getvalue())
    return path


def figures(result):
    return {
        name: (row.volume and row.volume.value, row.area and row.area.value)
        for name, row in result.objects[0].methods.items()
    }


@pytest.mark.parametrize("method", ["prism", "plain", "long-prism,prism,plain", "all"])
def test_run_again_to_the_bit(house, disk, tmp_path, method):
    settings = {"product": {"factor": 0.1 + 0.2}, "prism/reconstructor.prism": {"stretch": 1 / 3}}
    if method == "plain":
        settings = {}
    shared = {"thickness": "0.1in"}
    first = measure(MeasureRequest(disk, method=method, shared=shared, settings=settings)).result
    again = measure(load_recipe(written(first, tmp_path), disk)).result
    ran = {name: value for name, value in figures(first).items() if name in figures(again)}
    assert figures(again) == ran
    assert again.recipe["options"] == first.recipe["options"]
    assert again.recipe == {**first.recipe, "method": again.recipe["method"]}


def test_the_recipe_holds_every_resolved_option(house, disk):
    recipe = measure(MeasureRequest(disk, method="prism", shared={"thickness": "1cm"})).result.recipe
    assert recipe == {
        "schema": "stackloft.recipe/1",
        "reader": "disk",
        "method": "prism",
        "options": {
            "reader.disk": {"thickness": 10.0},
            "reconstructor.prism": {"points": 33, "stretch": 1.0},
            "integrator.product": {"factor": 1.0, "limit": 5000.0},
        },
    }


def test_an_option_that_was_opened_stays_open(house, disk, tmp_path):
    settings = {"product": {"limit": "none", "factor": 100}}
    request = MeasureRequest(disk, method="prism", shared={"thickness": 1}, settings=settings)
    first = measure(request).result
    assert first.objects[0].volume.value == pytest.approx(200 * 4 * 100)
    assert first.recipe["options"]["integrator.product"]["limit"] == "none"
    again = measure(load_recipe(written(first, tmp_path), disk)).result
    assert again.objects[0].volume == first.objects[0].volume


def test_methods_that_disagree_keep_their_own_options(house, disk):
    request = MeasureRequest(disk, method="prism,long-prism", shared={"thickness": 1})
    options = measure(request).result.recipe["options"]
    assert options["reconstructor.prism"]["stretch"] == 1.0
    assert options["long-prism/reconstructor.prism"]["stretch"] == 2.0


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("= 3", InputError, "this is no TOML"),
        ('schema = "stackloft.recipe/9"', InputError, "expected: stackloft.recipe/1"),
        ('methd = "loft"', UsageError, "no recipe key 'methd'; fix: did you mean method"),
        ("method = 3", InputError, "method must be text; found: 3"),
        ("options = 3", InputError, "options must be tables"),
    ],
)
def test_what_is_no_recipe(tmp_path, text, error, message):
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(error, match=message):
        load_recipe(path, tmp_path)


def test_a_recipe_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="the recipe cannot be read; found: No such file"):
        load_recipe(tmp_path / "recipe.toml", tmp_path)


def test_a_hand_written_recipe_may_say_little(tmp_path):
    request = request_of_recipe(tomllib.loads("[options.loft]\npoints = 40"), tmp_path)
    assert request.method is None
    assert request.base == {"loft": {"points": 40}}
