"""Points gather where a loop bends, stay even where it does not, and ignore rounding."""

import numpy as np
import pytest

from stackloft.geometry.point_density import spread_by_turning

K = 128
NONE = np.array([])


def tangents_of(curve):
    closed = np.concatenate([curve, curve[:1]])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    at = np.interp(np.arange(K) / K * length[-1], length, np.arange(len(length)))
    steps = np.diff(np.concatenate([closed, closed[1:2]]), axis=0)
    return steps[np.floor(at).astype(int) % len(curve)]


def ellipse(ratio, count=4000):
    t = 2 * np.pi * np.arange(count) / count
    return np.stack([ratio * np.cos(t), np.sin(t)], axis=1)


def test_a_circle_stays_even():
    spread = spread_by_turning(tangents_of(ellipse(1.0))[None], [NONE])
    np.testing.assert_allclose(spread.shares[0], np.arange(K + 1) / K, atol=1e-3)


def test_a_slender_loops_tips_get_more():
    spread = spread_by_turning(tangents_of(ellipse(4.0))[None], [NONE])
    density = np.diff(spread.shares[0])
    assert density[0] > 1.5 * density[K // 4]
    assert density.min() > 0.4 / K


@pytest.mark.parametrize("noise", [0.0, 1e-15])
def test_a_square_stays_even(noise):
    side = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    tangents = np.repeat(side, K // 4, axis=0) + noise * np.random.default_rng(1).normal(size=(K, 2))
    corners = np.array([0.0, 0.25, 0.5, 0.75]) % 1.0
    spread = spread_by_turning(tangents[None], [corners])
    np.testing.assert_allclose(spread.shares[0], np.arange(K + 1) / K, atol=1e-12)


def test_there_and_back():
    spread = spread_by_turning(tangents_of(ellipse(3.0))[None], [NONE])
    s = np.linspace(-1.3, 2.7, 41)
    np.testing.assert_allclose(spread.fraction(0, spread.share(0, s)), s, atol=1e-12)
