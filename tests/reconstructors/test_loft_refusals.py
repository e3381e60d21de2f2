"""What cannot be lofted honestly is refused by name; random stacks give a solid or one clear error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError, StackloftError
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor


def circle(radius, count=60, centre=(0.0, 0.0)):
    t = 2 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1) + centre


def stack(*loops, step=5.0, **more):
    return ContourStack(tuple(Section(step * k, (Loop(p),), f"s{k}") for k, p in enumerate(loops)), **more)


def test_a_figure_of_eight_is_refused_by_name():
    t = 2 * np.pi * np.arange(80) / 80
    eight = np.stack([10 * np.sin(t), 6 * np.sin(2 * t) + 2 * np.cos(t)], axis=1)
    with pytest.raises(InputError, match=r"s1: the loop (crosses itself|is too jagged)"):
        LoftReconstructor().reconstruct(stack(circle(9), eight, circle(9)))


def test_a_jagged_loop_is_refused_by_name():
    rng = np.random.default_rng(1)
    spiky = circle(1.0, 40) * np.exp(rng.normal(0, 0.8, 40))[:, None] * 10
    with pytest.raises(InputError, match="s1: the loop"):
        LoftReconstructor().reconstruct(stack(circle(9), spiky, circle(9)))


@pytest.mark.parametrize("radius", [12.0, 20.0, 40.0])
def test_a_flange_is_joined_straight_and_a_shift_keeps_the_volume(radius):
    loops = [circle(10.0) for _ in range(9)]
    loops[4] = circle(radius)
    found = SurfaceGauss().integrate(LoftReconstructor(ends="face").reconstruct(stack(*loops))).volume
    straight = np.pi * (100 * 30 + 10 / 3 * (100 + 10 * radius + radius**2))
    assert found == pytest.approx(straight, rel=0.01)
    loops[4] = circle(10.0, centre=(400.0, 0.0))
    shifted = LoftReconstructor(ends="face").reconstruct(stack(*loops))
    assert SurfaceGauss().integrate(shifted).volume == pytest.approx(np.pi * 100 * 40, rel=0.03)


def test_touching_is_no_crossing():
    bow = np.array([[0.0, 0.0], [2.0, 1.0], [4.0, 0.0], [4.0, 2.0], [2.0, 1.0], [0.0, 2.0]])
    assert not crosses_itself(bow[None])[0]
    assert not crosses_itself(bow[None, [0, 2, 3, 5]])[0]
    assert crosses_itself(bow[None, [0, 3, 2, 5]])[0]


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_random_stacks_give_a_solid_or_one_clear_error(seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(1, 12)
    kind = rng.integers(0, 5)
    sections = []
    for k in range(count):
        n = rng.integers(3, 50)
        rough = [0.0, 0.02, 0.1, 0.4, 1.0][kind]
        p = circle(10.0, n) * np.exp(rng.normal(0, rough, (n, 1))) * rng.choice([1e-6, 1.0, 1e5])
        if rng.random() < 0.1:
            p = np.repeat(p, 2, axis=0)
        if rng.random() < 0.1:
            p = p[::-1]
        sections.append(Section(float(k * rng.uniform(1, 5) + k), (Loop(p + rng.normal(0, 2, 2)),), f"s{k}"))
    options = {"points": int(rng.choice([5, 9, 33, 80])), "ends": str(rng.choice(["auto", "face", "point"]))}
    try:
        contours = ContourStack(tuple(sections), exact=bool(rng.random() < 0.7), resolution=0.3)
        found = SurfaceGauss().integrate(LoftReconstructor(**options).reconstruct(contours))
    except StackloftError:
        return
    assert np.isfinite([found.volume, found.area]).all()
    assert 36 * np.pi * found.volume**2 <= found.area**3 * (1 + 1e-9)  # isoperimetric inequality
