"""Polygons that run once round a point are known to be simple without looking at pairs of edges."""

import numpy as np
import pytest

from stackloft.geometry import simple_polygon
from stackloft.geometry.simple_polygon import crosses_itself


def ring(turns, count, wobble, rng):
    t = 2 * np.pi * turns * np.arange(count) / count
    reach = 1.0 + wobble * rng.normal(size=count)
    return np.column_stack([reach * np.cos(t), reach * np.sin(t)]) + rng.normal(size=2)


@pytest.mark.parametrize("wobble", [0.0, 0.1, 0.5])
def test_the_quick_look_agrees_with_pairs_of_edges(wobble, monkeypatch):
    rng = np.random.default_rng(5)
    polygons = np.stack([ring(turns, 33, wobble, rng) for turns in (1, -1, 2, -2, 3) for _ in range(40)])
    quick = crosses_itself(polygons)
    monkeypatch.setattr(simple_polygon, "_star_shaped", lambda points: np.zeros(len(points), dtype=bool))
    assert (quick == crosses_itself(polygons)).all()


def test_twice_round_is_no_simple_polygon():
    rng = np.random.default_rng(1)
    assert crosses_itself(np.stack([ring(turns, 33, 0.02, rng) for turns in (1, 2)])).tolist() == [
        False,
        True,
    ]
