"""The mean meridian and the spline across rows."""

import numpy as np
import pytest

from stackloft.geometry.meridian import cubic_across, mean_meridian


@pytest.mark.parametrize("m", [7, 15, 31])
def test_a_ball_s_meridian_is_half_a_circle(m):
    z = np.linspace(-1, 1, m) * 5
    found = mean_meridian(z, np.sqrt(25 - z**2), (True, True))
    assert found.nodes[-1] == pytest.approx(5 * np.pi, rel=0.4 / m**2)
    t = np.linspace(0, found.nodes[-1], 200)
    assert np.all(np.diff(found.z(t)) >= 0)
    np.testing.assert_allclose(found.z(t), -5 * np.cos(np.pi * t / found.nodes[-1]), atol=4.0 / m**2)


def test_a_cone_is_straight():
    z = np.linspace(0, 4, 6)
    found = mean_meridian(z, 3 - 0.75 * z, (False, False))
    np.testing.assert_allclose(found.nodes, 1.25 * z, atol=1e-9)
    np.testing.assert_allclose(found.z(np.array([-1.0, 2.5, 99.0])), [0.0, 2.0, 4.0], atol=1e-9)


@pytest.mark.parametrize("k", [2, 3, 4, 7])
def test_few_rows_and_given_slopes(k):
    t = np.linspace(0, 1, k)
    straight = cubic_across(t, np.stack([2 * t, -t], axis=1), (None, None))
    np.testing.assert_allclose(straight(0.37), [0.74, -0.37], atol=1e-12)
    bent = cubic_across(t, t**2, (np.array(0.0), np.array(2.0)))
    assert float(bent(0.37)) == pytest.approx(0.37**2, abs=1e-12)
