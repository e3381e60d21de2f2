"""Random stacks of loops: a closed solid whose volume agrees with the sections', or one clear refusal."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.sectioning.section_regions import section_regions
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

PITCH = 5.0
KINDS = ("plain", "plain", "nested", "crossing", "touching", "tiny", "duplicated", "jumping")


def wavy(rng, centre, radius, *, crossing=False):
    t = 2 * np.pi * np.arange(40) / 40
    r = radius * (1 + 0.15 * rng.random() * np.cos(rng.integers(2, 5) * t + rng.uniform(0, 6.28)))
    points = centre + np.column_stack([r * np.cos(t), r * np.sin(t)])
    if crossing:
        i = int(rng.integers(20))
        points[[i, i + 20]] = points[[i + 20, i]]
    return points


def tracks(rng, sections):
    """Return (first, stop, centre, drift, radius) of parts that live between random sections."""
    found = [(0, sections, np.zeros(2), rng.uniform(-0.6, 0.6, 2), 22.0)]
    for _ in range(rng.integers(0, 4)):
        first, stop = sorted(rng.integers(0, sections + 1, 2))
        inner = rng.random() < 0.5
        angle, away = rng.uniform(0, 6.28), rng.uniform(0, 14) if inner else rng.uniform(34, 60)
        centre = away * np.array([np.cos(angle), np.sin(angle)])
        radius = rng.uniform(2, 7) if inner else rng.uniform(2, 12)
        found.append((first, max(stop, first + 1), centre, rng.uniform(-0.6, 0.6, 2), radius))
    return found


def extra(rng, kind, first):
    """Return the loops that a kind of stack sometimes has beside its parts."""
    if rng.random() > 0.3:
        return []
    return {
        "nested": lambda: [wavy(rng, np.zeros(2), 8.0), wavy(rng, np.zeros(2), 3.0)],
        "duplicated": lambda: [first.copy()],
        "tiny": lambda: [wavy(rng, rng.uniform(-30, 30, 2), 1e-3)],
        "touching": lambda: [first + [44.0, 0.0]],
        "jumping": lambda: [wavy(rng, rng.uniform(-60, 60, 2), rng.uniform(1, 20))],
    }.get(kind, list)()


def random_stack(seed):
    rng = np.random.default_rng(seed)
    sections = int(rng.integers(3, 9))
    kind = KINDS[int(rng.integers(len(KINDS)))]
    parts = tracks(rng, sections)
    stack = []
    for k in range(sections):
        loops = [
            wavy(
                rng,
                centre + drift * k,
                radius * (1 + 0.1 * rng.standard_normal()),
                crossing=kind == "crossing" and rng.random() < 0.2,
            )
            for first, stop, centre, drift, radius in parts
            if first <= k < stop
        ]
        loops += extra(rng, kind, loops[0])
        stack.append(Section(PITCH * k, tuple(Loop(points) for points in loops), f"section {k + 1}"))
    return ContourStack(tuple(stack))


def shoelace(points):
    x, y = points.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def areas(stack):
    """Return the sections' areas by their vertices; None where loops cross by straight sides alone."""
    found = []
    for section in stack.sections:
        try:
            regions = section_regions([loop.points for loop in section.loops])
        except InputError:
            return None
        signs = np.where(regions.holes, -1.0, 1.0)
        found.append(float(signs @ [shoelace(p) for p in regions.loops]))
    return np.array(found)


def verdict(seed):
    """Return "measured" or "refused"; anything else is a fault."""
    try:
        stack = random_stack(seed)
        solid = LoftReconstructor(ends="face").reconstruct(stack)
        volume = SurfaceGauss().integrate(solid).volume
    except InputError:
        return "refused"
    mesh = solid.tessellate(0.5)
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    number = int(mesh.faces.max()) + 1
    forward, back = edges @ [number, 1], edges @ [1, number]
    assert len(np.unique(forward)) == len(forward), seed
    assert np.array_equal(np.sort(forward), np.sort(back)), seed
    z, a = stack.positions, areas(stack)
    if a is None:
        return "measured"
    spline = float(CubicSpline(z, a).integrate(z[0], z[-1]))
    steps = float(np.abs(np.diff(a)).sum() * PITCH)  # what appears between two sections may do so anywhere
    assert abs(volume - spline) <= 0.03 * spline + 0.6 * steps, seed
    return "measured"


def test_random_stacks_are_measured_or_refused():
    counts = Counter(verdict(seed) for seed in range(24))
    assert counts["measured"] >= 8


@pytest.mark.prove
def test_a_thousand_random_stacks(proof):
    counts = Counter(verdict(seed) for seed in range(1000))
    proof(
        "loft-random-stacks",
        "1000 seeded random stacks: loops appearing, vanishing, touching, nested, crossing, tiny, duplicated",
        ("outcome", "stacks"),
        sorted(counts.items()),
    )
    assert counts["measured"] >= 300
