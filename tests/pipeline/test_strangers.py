"""What strangers' packages do to a run: nothing, unless they are asked for."""

import pytest

from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import PluginError
from stackloft.pipeline.plan import make_plan
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.registry import find
from stackloft.testing.conformance.ellipsoids import contour_stack
from stackloft.testing.conformance.throwaway import installed

FAMILIES = ("readers", "segmenters", "reconstructors", "meshers", "integrators", "writers", "recipes")

SEGMENTER = """
from dataclasses import dataclass
from typing import ClassVar
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack

@dataclass(frozen=True)
class Other:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (SliceStack,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)
    general: ClassVar[bool] = GENERAL
    def segment(self, stack): raise AssertionError("not asked for")
"""


def volume(method="loft"):
    result = measure(MeasureRequest("body", method=method), product=contour_stack(1)).result
    return result.objects[0].volume.value, result.objects[0].methods


def test_broken_strangers_in_every_family_change_nothing(tmp_path):
    before, _ = volume()
    groups = {f"stackloft.{family}": {"ruin": "ruin_all:Ruin"} for family in FAMILIES}
    with installed(tmp_path, "ruin", groups, {"ruin_all": "import sys\nsys.exit('ruin')"}):
        after, _ = volume()
        assert after == before
        whole, rows = volume("all")
        assert whole == before
        assert "recipe.ruin of ruin 1.0 is quarantined; found: SystemExit: ruin" in rows["ruin"].error


def test_a_broken_stranger_with_a_built_in_s_name_loses(tmp_path):
    before, _ = volume()
    groups = {
        "stackloft.recipes": {"loft": "ruin_loft:loft"},
        "stackloft.reconstructors": {"loft": "ruin_loft:L"},
    }
    with installed(tmp_path, "ruin-loft", groups, {"ruin_loft": "1 / 0"}):
        assert volume()[0] == before


def test_a_healthy_stranger_with_a_built_in_s_name_must_be_told_apart(tmp_path):
    source = (
        "from stackloft.contracts.recipe import Recipe\nloft = Recipe(('integrator.cavalieri',), 'other')\n"
    )
    before, _ = volume()
    with installed(
        tmp_path, "twin-loft", {"stackloft.recipes": {"loft": "twin_loft:loft"}}, {"twin_loft": source}
    ):
        with pytest.raises(PluginError, match=r"stackloft 0.1.0, twin-loft 1.0; fix: name one in full"):
            volume()
        assert volume("stackloft:loft")[0] == before
        whole, rows = volume("all")
        assert whole == before
        assert {"stackloft:loft", "twin-loft:loft"} <= set(rows)


def test_a_recipe_s_steps_are_its_own_distribution_s(tmp_path):
    source = (
        "from stackloft_plugins.integrators.cavalieri import Cavalieri\n"
        "from stackloft.model.measurement import Integral\n"
        "from stackloft.contracts.recipe import Recipe\n"
        "from dataclasses import dataclass\n"
        "@dataclass(frozen=True)\n"
        "class Mine(Cavalieri):\n"
        "    def integrate(self, product): return Integral(1.0, None)\n"
        "mine = Recipe(('integrator.cavalieri',), 'mine')\n"
    )
    groups = {
        "stackloft.integrators": {"cavalieri": "twin_cav:Mine"},
        "stackloft.recipes": {"mine": "twin_cav:mine"},
    }
    before, _ = volume("cavalieri")
    with installed(tmp_path, "twin-cav", groups, {"twin_cav": source}):
        assert volume("cavalieri")[0] == before
        assert volume("mine")[0] == 1.0
        with pytest.raises(PluginError, match="several distributions register integrator 'cavalieri'"):
            find("integrator", "cavalieri")


@pytest.mark.parametrize(("general", "chosen"), [("True", "other"), ("False", None)])
def test_one_of_several_segmenters_must_be_the_general_one(tmp_path, slices, general, chosen):
    source = SEGMENTER.replace("GENERAL", general)
    groups = {"stackloft.segmenters": {"other": "other_seg:Other"}}
    built_in = getattr(find("segmenter", "histogram").plugin, "general", False)
    with installed(tmp_path, "other-seg", groups, {"other_seg": source}):
        request = MeasureRequest("body")
        if built_in != (general == "True"):
            wanted = chosen or "histogram"
            assert make_plan(request, slices).segmenter.loaded.name == wanted
        else:
            with pytest.raises(
                PluginError, match="several segmenters fit these slices; found: histogram, other"
            ):
                make_plan(request, slices)
        named = make_plan(MeasureRequest("body", segmenter="histogram"), slices)
        assert named.segmenter.loaded.name == "histogram"


@pytest.fixture
def slices():
    import numpy as np  # noqa: PLC0415

    from stackloft.model.slice_stack import SectionKind, SliceStack  # noqa: PLC0415

    spacing = np.full((2, 2), 0.5)
    return SliceStack(
        lambda k: np.zeros((4, 4)), ("a", "b"), (4, 4), np.arange(2.0), spacing, SectionKind.FACE
    )


def test_slices_without_a_segmenter_name_the_broken_one(tmp_path, slices, monkeypatch):
    monkeypatch.setattr("stackloft.pipeline.plan._choose_segmenter", lambda request, kinds: None)
    groups = {"stackloft.segmenters": {"ruin": "ruin_seg:S"}}
    message = r"into Segmentation \(a segmenter\); quarantined: segmenter.ruin \(ImportError: no cv2"
    with (
        installed(tmp_path, "ruin-seg", groups, {"ruin_seg": "raise ImportError('no cv2')"}),
        pytest.raises(PluginError, match=message),
    ):
        make_plan(MeasureRequest("body"), slices)


def test_a_product_is_measured_as_what_it_is():
    stack = contour_stack(1)
    assert isinstance(measure(MeasureRequest("body"), product=stack).contours, ContourStack)
