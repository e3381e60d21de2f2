"""Means on a grid of cells are those in a Gaussian window about each pixel, sixteen times as quick."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft_plugins.segmenters.cell_means import CELL, cell_means


def directly(shape, where, values, reach, trust):
    """Return the mean at the known pixels, summed over all of them."""
    rows, columns = np.divmod(where, shape[1])
    apart = (rows[:, None] - rows) ** 2 + (columns[:, None] - columns) ** 2
    weight = np.exp(-0.5 * apart / reach**2) / (2 * np.pi * reach**2)
    usual = values.mean()
    return usual + weight @ (values - usual) / (weight.sum(axis=1) + trust)


def everywhere(found):
    return -found.taken_off(np.zeros(found.shape, np.float32))


@pytest.mark.parametrize("reach", [6.0, 8.0])
def test_means_along_a_band(reach):
    angle = np.linspace(0, 2 * np.pi, 3000)
    rows, columns = np.round(150 + 100 * np.sin(angle)), np.round(160 + 110 * np.cos(angle))
    where = np.unique((rows * 321 + columns).astype(np.int64))
    values = 50 + 10 * np.cos(3 * np.arctan2(where // 321 - 150, where % 321 - 160))
    found = cell_means((307, 321), where, values, reach, 1e-3)
    expected = directly((307, 321), where, values, reach, 1e-3)
    assert np.abs(found.at(where) - expected).max() < 0.35
    assert np.abs(found.at(where) - expected).std() < 0.1
    assert everywhere(found).ravel()[where] == pytest.approx(found.at(where), abs=0.15)


@settings(max_examples=30, deadline=None)
@given(st.integers(5, 60), st.integers(5, 60), st.integers(0, 2**32 - 1), st.floats(-1e3, 1e3))
def test_one_value_everywhere_is_that_value(rows, columns, seed, value):
    rng = np.random.default_rng(seed)
    where = np.unique(rng.integers(0, rows * columns, 20))
    found = cell_means((rows, columns), where, np.full(len(where), value), 2.0 * CELL, 1e-3)
    assert everywhere(found) == pytest.approx(np.full((rows, columns), value), rel=1e-5, abs=1e-6)
