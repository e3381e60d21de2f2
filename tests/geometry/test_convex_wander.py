"""No convex body's sections wander more than their widths explain; sections laid elsewhere do."""

import numpy as np
import pytest

from stackloft.geometry.convex_wander import explained_displacement, unexplained_wander
from stackloft.geometry.displacement import best_displacement


def polytope_cuts(seed, count=11, corners=9, regular=True):
    """Return where a random convex polytope is cut, and the corners of its cuts (unordered: edges is all)."""
    rng = np.random.default_rng(seed)
    body = rng.normal(size=(corners, 3)) * [30, 20, 40]
    z = np.linspace(body[:, 2].min(), body[:, 2].max(), count + 2)[1:-1]
    if not regular:
        z = np.sort(rng.uniform(z[0], z[-1], count))
    return z, [section(body, at) for at in z]


def section(body, at):
    """Return where the segments between any two of the body's points cross the plane."""
    below, above = body[body[:, 2] <= at], body[body[:, 2] > at]
    part = (at - below[:, None, 2]) / (above[None, :, 2] - below[:, None, 2])
    crossing = below[:, None] + part[..., None] * (above[None] - below[:, None])
    return crossing[..., :2].reshape(-1, 2)


@pytest.mark.parametrize("regular", [True, False])
def test_convex_bodies_with_corners_explain_all_their_wander(regular):
    for seed in range(60):
        z, cuts = polytope_cuts(seed, regular=regular)
        assert unexplained_wander(z, cuts).max() < 1e-9


def test_what_looks_like_a_displacement_in_a_convex_body_is_explained():
    """Where its middles bend as a step of d makes them bend, the widths allow d."""
    for seed in range(60):
        z, cuts = polytope_cuts(seed)
        middles = np.array([(cut.max(axis=0) + cut.min(axis=0)) / 2 for cut in cuts])
        first = best_displacement(z, middles, 1e-9).first
        bends = np.abs(np.diff(middles, 2, axis=0))
        concerned = [k - 1 for k in (first - 1, first) if 0 < k < len(z) - 1]
        for axis in (0, 1):
            allowed = explained_displacement(z, cuts, np.arange(len(z)) >= first, np.eye(2)[axis])
            assert bends[concerned, axis].min() <= allowed + 1e-9


def test_jitter_of_a_prism_is_seen_at_its_strength():
    rng = np.random.default_rng(4)
    square = np.array([[-20.0, -20], [20, -20], [20, 20], [-20, 20]])
    shaken = [square + rng.normal(scale=2.0, size=2) for _ in range(400)]
    wander = unexplained_wander(np.arange(400.0) * 3, shaken)
    assert np.sqrt((wander**2).mean()) == pytest.approx(2.0 * np.sqrt(2), rel=0.1)


def test_where_the_body_lies_and_its_units_do_not_matter():
    z, cuts = polytope_cuts(3)
    cuts = [cut + [0.1 * k**3, 0] for k, cut in enumerate(cuts)]
    wander = unexplained_wander(z, cuts)
    assert wander.max() > 0.1
    slanted = [cut * 10 + [5, 7] + [0.4 * at, at] for at, cut in zip(z, cuts, strict=True)]
    np.testing.assert_allclose(unexplained_wander(10 * z + 900, slanted), 10 * wander, rtol=1e-9)
