"""A run over a small stranger's route: figures, methods, warnings, errors."""

import math

import pytest

from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError, PluginError, UsageError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure

VOLUME = 200.0 * 4 * 2.5  # area × 4 pitches


def ask(source, method="prism", **more):
    more.setdefault("shared", {"thickness": "0.25cm"})
    return MeasureRequest(source, method=method, **more)


def test_figures_of_one_method(house, disk):
    outcome = measure(ask(disk))
    (body,) = outcome.result.objects
    assert body.volume.value == pytest.approx(VOLUME, rel=1e-14)
    assert (body.volume.unit, body.volume.method, body.area.unit) == ("mm^3", "prism", "mm^2")
    assert body.area.value == pytest.approx(400.0)
    assert set(body.methods) == {"prism"}
    assert body.derived["density"] == pytest.approx(1.0 / (VOLUME / 1000))
    assert body.derived["specific_surface"] == pytest.approx(400.0 / VOLUME)
    assert body.derived["equivalent_diameter"] == pytest.approx((6 * VOLUME / math.pi) ** (1 / 3))
    assert body.derived["sphericity"] == pytest.approx(math.pi ** (1 / 3) * (6 * VOLUME) ** (2 / 3) / 400.0)
    assert [end.kind for end in body.ends] == ["face", "face"]
    assert [row.area for row in body.sections] == pytest.approx([200.0] * 5)
    assert [row.z for row in body.sections] == [0.0, 2.5, 5.0, 7.5, 10.0]
    assert body.sections[0].perimeter == pytest.approx(4 * 10 * math.sqrt(2))


def test_products_are_handed_over(house, disk):
    outcome = measure(ask(disk))
    assert isinstance(outcome.contours, ContourStack)
    assert isinstance(outcome.solid, LoftedSolid)
    assert outcome.segmentation is None
    assert outcome.stack is None


def test_warnings_are_gathered_once(house, disk):
    codes = [notice.code for notice in measure(ask(disk)).result.warnings]
    assert codes == ["disk-like", "prism"]


def test_source_and_provenance(house, disk):
    result = measure(ask(disk)).result
    assert result.source["path"] == str(disk)
    assert result.source["reader"] == "disk"
    assert len(result.source["digest"]) == 64
    assert result.provenance["versions"]["disk-house"] == "1.0"
    assert {"python", "numpy", "scipy", "stackloft"} <= set(result.provenance["versions"])
    seconds = result.provenance["seconds"]
    assert {"read", "digest", "reconstructor.prism", "integrator.product", "total"} <= set(seconds)
    assert seconds["total"] >= seconds["reconstructor.prism"] >= 0


def test_several_methods_share_products_and_the_first_is_primary(house, disk):
    result = measure(ask(disk, "plain,prism")).result
    (body,) = result.objects
    assert body.volume.method == "plain"
    assert body.area is None
    assert body.derived["sphericity"] is None
    assert set(body.methods) == {"plain", "prism"}
    assert house.CALLS == ["read", "prism 33 1.0"]


def test_methods_that_differ_in_options_do_not_share(house, disk):
    body = measure(ask(disk, "prism,long-prism")).result.objects[0]
    assert house.CALLS == ["read", "prism 33 1.0", "prism 33 2.0"]
    assert body.methods["long-prism"].volume.value == pytest.approx(2 * body.volume.value)


def test_all_keeps_failures_as_rows(house, disk):
    body = measure(ask(disk, "all")).result.objects[0]
    rows = body.methods
    assert body.volume.method == "loft" or rows["loft"].error
    assert rows["refuses"].error == "too thin"
    assert "integrator.crashes of disk-house 1.0 failed; found: RuntimeError: boom" in rows["crashes"].error
    assert "cannot take ContourStack" in rows["upside-down"].error
    assert "integrator as its last step" in rows["endless"].error
    assert "gave no volume that can be true; found: nan" in rows["nan"].error
    assert "returned str, announced was Integral" in rows["text"].error
    assert "has no volume" in rows["zero"].error
    assert (
        "typo sets its own options wrongly; found: integrator.plain: no option 'ruel'" in rows["typo"].error
    )
    assert rows["plain"].error is None
    assert rows["area-only"].area.value == 7.0
    assert house.CALLS.count("prism 33 1.0") == 1


@pytest.mark.parametrize(
    ("method", "error", "message"),
    [
        ("refuses", InputError, "too thin"),
        ("crashes", PluginError, "integrator.crashes of disk-house 1.0 failed; found: RuntimeError: boom"),
        ("text", PluginError, "returned str"),
        ("nan", PluginError, "can be true"),
        ("zero", InputError, "no volume"),
        ("minus", PluginError, "gave no volume that can be true; found: -3"),
        ("area-only", InputError, "--method: method area-only gives no volume"),
        ("area-only,plain", InputError, "name a method that gives a volume first: --method plain,area-only"),
        ("prizm", PluginError, "no recipe is called 'prizm'; fix: did you mean prism"),
        ("endless", PluginError, "an integrator as its last step"),
        ("typo", PluginError, "method typo sets its own options wrongly; found: integrator.plain: no option"),
        ("plain,all", UsageError, "not a method"),
        ("", UsageError, "not a method"),
    ],
)
def test_the_primary_method_s_failure_is_raised(house, disk, method, error, message):
    with pytest.raises(error, match=message):
        measure(ask(disk, method))


def test_a_second_method_s_failure_is_a_row(house, disk):
    rows = measure(ask(disk, "plain,crashes,refuses")).result.objects[0].methods
    assert rows["plain"].error is None
    assert "boom" in rows["crashes"].error
    assert rows["refuses"].volume is None


def test_what_failed_once_is_not_tried_again(house, disk):
    rows = measure(ask(disk, "plain,refuses,refuses-again")).result.objects[0].methods
    assert rows["refuses"].error == rows["refuses-again"].error == "too thin"
    assert house.CALLS.count("fails") == 1


def test_missing_step_is_named_with_the_plugin_that_makes_it(house, disk):
    message = (
        "method upside-down: integrator.product cannot take ContourStack; expected: LoftedSolid; "
        "fix: reconstructor.(loft|prism) makes that step"
    )
    with pytest.raises(PluginError, match=message):
        measure(ask(disk, "upside-down"))
    assert house.CALLS == []


def test_a_type_no_chain_reaches(house, tmp_path):
    path = tmp_path / "body.mesh"
    path.write_text("")
    with pytest.raises(PluginError, match="missing is a plug-in that turns TriMesh into ContourStack"):
        measure(MeasureRequest(path, method="prism"))


def test_methods_that_do_fit_are_named_and_run_under_all(house, tmp_path):
    path = tmp_path / "body.mesh"
    path.write_text("")
    with pytest.raises(PluginError, match="methods that start from TriMesh: polyhedral, repair, surface"):
        measure(MeasureRequest(path, method="loft"))
    result = measure(MeasureRequest(path, method="all")).result
    (body,) = result.objects
    assert (body.volume.value, body.volume.method, body.sections) == (5.0, "surface", ())
    assert "cannot take TriMesh" in body.methods["loft"].error
    assert result.recipe["method"].startswith("surface")


def test_the_reader_s_own_refusal_comes_through(house, disk):
    with pytest.raises(InputError, match="unknown pitch; fix: --thickness"):
        measure(MeasureRequest(disk, method="prism"))


def test_progress_is_told_of_every_stage(house, disk):
    heard = []

    class Listener:
        def begin(self, stage, total):
            heard.append(stage)

        def advance(self, steps=1):
            heard.append("+")

        def end(self):
            heard.append(".")

    measure(ask(disk), progress=Listener())
    assert heard == ["read", ".", "reconstructor.prism", ".", "integrator.product", "."]


def test_a_product_in_memory_is_measured_alike(house, disk):
    contours = measure(ask(disk)).contours
    outcome = measure(MeasureRequest(disk, method="prism"), product=contours)
    assert outcome.result.objects[0].volume.value == measure(ask(disk)).result.objects[0].volume.value
    assert outcome.result.source["reader"] == "python"
    with pytest.raises(UsageError, match="takes no reader"):
        measure(MeasureRequest(disk, reader="disk", method="prism"), product=contours)
