"""An edge is found in a blurred profile, with and without a skin, and doubted where there is none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d

from stackloft.geometry.edge_profile import fit_edge

X = np.linspace(-6.0, 6.0, 49)
FINE = np.arange(-30.0, 30.0, 0.01)


def seen(grey_at_depth, edge, blur, background):
    depth = edge - FINE
    sharp = np.where(depth > 0, grey_at_depth(np.maximum(depth, 0.0)), background)
    return np.interp(X, FINE, gaussian_filter1d(sharp, blur / 0.01))


@given(st.floats(-0.5, 0.5), st.floats(0.5, 1.5), st.floats(0, 255), st.floats(0, 255))
@settings(max_examples=40, deadline=None)
def test_a_plain_edge_is_found_exactly(edge, blur, body, background):
    if abs(body - background) < 10:
        return
    fit = fit_edge(X, seen(lambda t: np.full(t.shape, body), edge, blur, background))
    assert fit.skin == 0.0
    assert fit.position == pytest.approx(edge, abs=0.01)
    assert fit.blur == pytest.approx(blur, abs=0.01)


@pytest.mark.parametrize("edge", [-0.25, 0.0, 0.2])
@pytest.mark.parametrize("background", [20.0, 235.0])
@pytest.mark.parametrize("skin", ["even", "fading"])
def test_a_skin_does_not_move_the_edge(edge, background, skin):
    flesh, rim, width = 205.0, 165.0, 2.0
    layers = {
        "even": lambda t: np.where(t < width, rim, flesh),
        "fading": lambda t: flesh + (rim - flesh) * np.exp(-((t / width) ** 2)),
    }
    profile = seen(layers[skin], edge, 0.8, background)
    fit = fit_edge(X, profile)
    assert fit.skin > 0.0
    assert fit.position == pytest.approx(edge, abs=0.02)
    half_way = np.interp(0.5 * (profile[0] + profile[-1]), *sorted_pair(profile))
    if background > 200:
        assert abs(fit.position - edge) < 0.5 * abs(half_way - edge)


def sorted_pair(profile):
    order = np.argsort(profile)
    return profile[order], X[order]


def test_no_edge_is_no_answer():
    assert fit_edge(X, np.full(X.shape, 80.0)) is None
    assert fit_edge(X, np.where(X > 0, np.nan, 3.0)) is None
    assert fit_edge(X, seen(lambda t: np.full(t.shape, 200.0), 5.0, 0.8, 20.0)) is None


def test_noise_of_a_grey_level_moves_it_by_hundredths():
    rng = np.random.default_rng(4)
    profile = seen(lambda t: np.full(t.shape, 180.0), 0.1, 0.9, 30.0)
    found = [fit_edge(X, profile + rng.normal(0, 0.3, X.shape)).position for _ in range(20)]
    assert abs(np.array(found) - 0.1).max() < 0.03
