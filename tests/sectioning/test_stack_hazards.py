"""Mistakes in a stack are told by name; sound stacks are left in peace."""

from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

import stackloft
from stackloft.model.contour_stack import Loop, Section
from stackloft.sectioning.stack_hazards import stack_hazards
from stackloft.testing import phantoms

PIXEL = 0.3
FOOD = ("apple", "meat", "potato", "banana", "ellipsoid", "two-lobed", "superellipsoid")
OTHERS = ("box", "cone", "cylinder", "double-cone", "dumbbell", "frustum", "prism", "twisted-bar")
SAMPLES = Path(__file__).parents[2] / "sample_stacks"
MISTAKES = {"wrong-order", "slice-missing", "slice-doubled", "slice-odd", "motion", "misaligned"}


def body(name, seed):
    rng = np.random.default_rng(seed)
    more = {"seed": int(rng.integers(1000))} if name == "potato" else {}
    return phantoms.make(name, rotation=None if seed % 2 else int(rng.integers(10**6)), **more), rng


def cut(name, seed, sections=None):
    """Return positions and noisy outlines (0.05 px, three points wide) of a stack; None where it branches."""
    phantom, rng = body(name, seed)
    stack = phantom.contour_stack(sections or int(rng.integers(9, 19)), points=300)
    if any(len(section.loops) > 1 for section in stack.sections):
        return None
    return stack.positions, [noisy(section.loops[0].points, rng) for section in stack.sections], rng


def noisy(points, rng):
    wobble = gaussian_filter1d(rng.normal(size=points.shape), 3, axis=0, mode="wrap")
    return points + wobble / wobble.std() * 0.05 * PIXEL


def told(z, outlines):
    names = [f"cut_{k:02d}.jpg" for k in range(len(z))]
    sections = [Section(float(at), (Loop(p),), name) for at, p, name in zip(z, outlines, names, strict=True)]
    return stack_hazards(sections, PIXEL)


def spoilt(kind, z, outlines, rng):
    """Return the stack with one mistake made in it, and the number of the slice that it is about."""
    k = int(rng.integers(3, len(z) - 4))
    changed = list(outlines)
    if kind == "wrong-order":
        changed[k], changed[k + 1] = changed[k + 1], changed[k]
    if kind == "slice-missing":
        return z[:-1], [*changed[:k], *changed[k + 1 :]], k - 1
    if kind == "slice-doubled":
        return (
            np.append(z, 2 * z[-1] - z[-2]),
            [*changed[: k + 1], noisy(outlines[k], rng), *changed[k + 1 :]],
            k,
        )
    if kind == "slice-odd":
        middle = changed[k].mean(axis=0)
        changed[k] = middle + 1.04 * (changed[k] - middle)
    if kind == "motion":
        changed = [p + [3.0, 2.0] if i >= k else p for i, p in enumerate(changed)]
    if kind == "misaligned":
        changed = [turned(p, rng.uniform(-5, 5)) + rng.uniform(-3, 3, 2) for p in changed]
    return z, changed, k


def turned(points, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    middle = points.mean(axis=0)
    return middle + (points - middle) @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("kind", sorted(MISTAKES))
def test_each_mistake_in_an_ellipsoid_is_told_by_name_and_figure(kind):
    z, outlines, rng = cut("ellipsoid", 3, sections=16)
    assert told(z, outlines) == ()
    z, outlines, k = spoilt(kind, z, outlines, rng)
    (notice,) = told(z, outlines)
    assert notice.code == kind
    assert kind == "misaligned" or f"cut_{k:02d}.jpg" in notice.message
    assert any(figure.isdigit() for figure in notice.message.split(":", 1)[1])


@pytest.mark.parametrize("sample", ["apple", "meat"])
def test_the_samples_are_sound(sample):
    warnings = stackloft.measure(SAMPLES / sample).warnings
    assert not MISTAKES & {notice.code for notice in warnings}


@pytest.mark.parametrize("name", FOOD + OTHERS)
def test_sound_upright_bodies_are_silent(name):
    for seed in (1, 5):
        found = cut(name, seed, sections=13)
        assert found is None or told(*found[:2]) == ()


def test_few_sections_say_nothing():
    z, outlines, _ = cut("apple", 1, sections=7)
    assert told(z, outlines[::-1]) == ()


@pytest.mark.prove
def test_rates(proof):
    rows = []
    for family, names in (("food", FOOD), ("other bodies", OTHERS)):
        stacks = [found for seed in range(40) for name in names if (found := cut(name, seed)) is not None]
        alarms = sum(bool(told(z, outlines)) for z, outlines, _ in stacks)
        rows.append((family, "none made", len(stacks), alarms))
        for kind in sorted(MISTAKES):
            made = [spoilt(kind, *found) for found in stacks]
            right = sum(kind in {one.code for one in told(z, outlines)} for z, outlines, _ in made)
            rows.append((family, kind, len(made), right))
        told_of = {row[1]: row[3] for row in rows if row[0] == family}
        assert alarms <= 0.03 * len(stacks)
        assert told_of["misaligned"] >= 0.95 * len(stacks)
    claim = "Mistakes told, and alarms on sound stacks, half of them tilted, 9 to 18 sections"
    proof("stack-hazards", claim, ("bodies", "mistake", "stacks", "told"), rows)


@pytest.mark.parametrize(
    ("name", "rotation"),
    [("y-branch", None), ("two-bodies", None), ("torus", (90, 0, 0)), ("horseshoe", None)],
)
def test_limbs_and_pieces_are_no_mistakes(name, rotation):
    phantom = phantoms.make(name, rotation=rotation)
    assert stack_hazards(list(phantom.contour_stack(21, points=120).sections), 0.3) == ()
