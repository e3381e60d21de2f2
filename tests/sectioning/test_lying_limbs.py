"""Slender parts that are there at once are cut off at their root; what merely grows is not."""

from __future__ import annotations

import numpy as np
import pytest

from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.levels import Level
from stackloft.sectioning.lying_limbs import ROOTS, limbs_cut_off


def circle(radius, count=240):
    t = 2 * np.pi * (np.arange(count) + 0.5) / count
    return radius * np.column_stack([np.cos(t), np.sin(t)])


def with_limbs(directions, length=20.0, width=2.0, radius=10.0):
    """Return a disc with straight limbs that begin at its rim, counter-clockwise, in short sides."""
    half = np.arcsin(0.5 * width / radius)
    out = np.linspace(0.0, 1.0, 30)
    points = []
    turns = sorted(directions)
    for k, turn in enumerate(turns):
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        root, tip = radius * np.cos(half), radius + length
        for side, steps in ((-1.0, out), (1.0, out[::-1])):
            r = root + steps * (tip - root)
            points.append(r[:, None] * along + 0.5 * side * width * across)
        following = turns[(k + 1) % len(turns)] + (2 * np.pi if k + 1 == len(turns) else 0.0)
        arc = np.linspace(turn + half, following - half, 60)[1:-1]
        points.append(radius * np.column_stack([np.cos(arc), np.sin(arc)]))
    return np.concatenate(points)


def level(points, z, section):
    return Level(z, (Loop(points),), (points,), f"cut {section}", section)


@pytest.mark.parametrize("directions", [[0.3], [0.3, 2.0], [0.0, 1.5, 4.0]])
@pytest.mark.parametrize("upward", [False, True])
def test_limbs_are_cut_off_whichever_way_they_go(directions, upward):
    plain, limbed = circle(10.2), with_limbs(directions)
    low, high = (limbed, plain) if upward else (plain, limbed)
    step = limbs_cut_off(level(low, 0.0, 0), level(high, 1.0, 1))
    assert step.upward == upward
    assert step.order == (len(directions),)
    areas = [polygon_area(part.points) for part in step.cut.parts]
    nearest = (
        10.2 + ROOTS[0] * 2 * np.pi * 10.2
    )  # the root: outside the other loop, or one short side farther
    for area in areas[:-1]:
        assert 2.0 * (30.0 - nearest - 0.75) < area < 2.0 * (30.0 - nearest)
    assert sum(areas) == pytest.approx(polygon_area(limbed), rel=1e-12)


@pytest.mark.parametrize(
    "grown",
    [
        circle(14.0),  # all round
        circle(10.0) * [1.6, 1.0],  # longer
        circle(10.0) + [6.0, 0.0],  # moved
        with_limbs([0.3], length=2.5, width=4.0),  # a stump
    ],
)
def test_what_grows_is_no_limb(grown):
    assert limbs_cut_off(level(circle(10.0), 0.0, 0), level(grown, 1.0, 1)) is None


def test_a_root_across_a_bay_is_no_cut():
    """Where a bent limb's root would be cut through the air, it is left: what is cut off is simple."""
    hook = np.array(
        [[10, -1], [30, -1], [30, 1], [13, 1], [13, 6], [10, 6], [10, 9], [-10, 9], [-10, -9], [10, -9]]
    )
    dense = [
        a + (b - a) * k / 40 for a, b in zip(hook, np.roll(hook, -1, axis=0), strict=True) for k in range(40)
    ]
    plain = np.array([[-10, -9], [10, -9], [10, 9], [-10, 9]], dtype=float)
    step = limbs_cut_off(level(plain, 0.0, 0), level(np.array(dense), 1.0, 1))
    assert step is None or not any(crosses_itself(part.points[None])[0] for part in step.cut.parts)


def test_holes_are_left_alone():
    low, high = circle(10.0)[::-1], with_limbs([0.3])[::-1]
    assert limbs_cut_off(level(low, 0.0, 0), level(high, 1.0, 1)) is None
