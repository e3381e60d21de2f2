"""Links that ``stack.toml`` fixes, and choices that are told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stackloft
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import Hints
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

ANGLE = 2 * np.pi * np.arange(60) / 60


def disc(radius, x, y=0.0):
    return Loop(np.column_stack([x + radius * np.cos(ANGLE), y + radius * np.sin(ANGLE)]))


def bar(x, y, length, width):
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return Loop(corners * [length / 2, width / 2] + [x, y], np.arange(4))


def stepped(links=None):
    """Two discs, one on the other, set off by half their radius after the fifth section."""
    sections = tuple(Section(float(k), (disc(10.0, 0.0 if k < 5 else 5.0),), f"s{k}") for k in range(10))
    return ContourStack(sections, hints=Hints(links=links or {}))


def test_two_bodies_that_overlap_are_parted_by_hand():
    lofted = LoftReconstructor(ends="face").reconstruct(stepped())
    parted = LoftReconstructor(ends="face").reconstruct(stepped({"s4": ()}))
    assert (len(lofted.shells), len(parted.shells)) == (1, 2)
    found = SurfaceGauss().integrate(parted)
    disc_area = np.pi * 100.0
    assert found.volume == pytest.approx(9.0 * disc_area, rel=1e-4)
    assert found.area == pytest.approx(4 * disc_area + 9.0 * 20.0 * np.pi, rel=1e-4)


def crossed(links=None):
    """Two bars side by side, then two bars across them: loops that part and meet at once."""
    flat = (bar(0.0, 1.6, 6.0, 2.5), bar(0.0, -1.6, 6.1, 2.5))
    across = (bar(1.6, 0.0, 2.5, 6.0), bar(-1.6, 0.0, 2.5, 6.1))
    sections = tuple(Section(3.0 * k, flat if k < 4 else across, f"s{k}") for k in range(8))
    return ContourStack(sections, hints=Hints(links=links or {}))


def test_an_ambiguous_link_is_told_with_the_choice():
    solid = LoftReconstructor(ends="face").reconstruct(crossed())
    (told,) = [n for n in solid.notices if n.code == "ambiguous-link"]
    assert "s3 to s4" in told.message
    assert "loop 1 → " in told.message
    assert "loop 2 → " in told.message


@pytest.mark.parametrize("links", [((1, 1), (2, 2)), ((1, 2), (2, 1))])
def test_links_by_hand_decide_an_ambiguous_one(links):
    solid = LoftReconstructor(ends="face").reconstruct(crossed({"s3": links}))
    assert not [n for n in solid.notices if n.code == "ambiguous-link"]
    assert len(solid.shells) == 2
    middles = [shell.patches[[0, -1], :, [0, 3], 0].mean(axis=1) for shell in solid.shells]
    ends = {(bool(m[0, 1] > 0), bool(m[1, 0] > 0)) for m in middles}
    assert ends == {(i == 2, j == 2) for i, j in links}  # number 1, the larger, is below, then on the left


@pytest.mark.parametrize(("links", "told"), [(((1, 3),), "loop 3 of s4"), (((3, 1),), "loop 3 of s3")])
def test_a_loop_that_is_not_there_is_named(links, told):
    with pytest.raises(InputError, match=told):
        LoftReconstructor(ends="face").reconstruct(crossed({"s3": links}))


def test_a_hole_is_no_outline():
    ring = (disc(10.0, 0.0), replace(disc(4.0, 0.0), hole=True))
    stack = ContourStack(
        tuple(Section(float(k), ring, f"s{k}") for k in range(4)), hints=Hints(links={"s1": ((1, 2),)})
    )
    with pytest.raises(InputError, match="a hole to an outline"):
        LoftReconstructor(ends="face").reconstruct(stack)


def test_stack_toml_fixes_links(tmp_path):
    rows = ["section,z,loop,x,y"]
    for section in stepped().sections:
        for x, y in section.loops[0].points:
            rows.append(f"{section.name},{section.z},0,{x:.9g},{y:.9g}")
    (tmp_path / "loops.csv").write_text("\n".join(rows), encoding="utf-8")
    one = stackloft.measure(tmp_path, "loft", ends="face").objects[0]
    (tmp_path / "stack.toml").write_text("[slice.5]\nlinks = []\n", encoding="utf-8")
    two = stackloft.measure(tmp_path, "loft", ends="face").objects[0]
    (tmp_path / "stack.toml").write_text("[slice.5]\nlinks = [[1, 1]]\n", encoding="utf-8")
    same = stackloft.measure(tmp_path, "loft", ends="face").objects[0]
    assert same.area.value == pytest.approx(one.area.value, rel=1e-3)
    assert two.area.value > 1.2 * one.area.value
    assert two.volume.value == pytest.approx(9.0 * np.pi * 100.0, rel=1e-3)
