import numpy as np
import pytest

from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.smoothing import smooth_loop


def drawn_through(points):
    """Return the area of the smooth curve through vertices: what chords cut off is put back."""
    squared = ((np.roll(points, -1, axis=0) - points) ** 2).sum(axis=1).mean()
    return polygon_area(points) + np.pi / 6 * squared


@pytest.mark.parametrize("axes", [(4.0, 4.0), (4.7, 7.3), (6.0, 18.0), (40.0, 60.0)])
def test_smoothing_keeps_the_area_of_small_loops(axes):
    count = round(2 * np.pi * np.mean(axes))
    t = 2 * np.pi * np.arange(count) / count
    loop = Loop(np.column_stack([axes[0] * np.cos(t), axes[1] * np.sin(t)]))
    smooth = smooth_loop(loop, 1.0).points
    exact = np.pi * axes[0] * axes[1]
    assert drawn_through(smooth) == pytest.approx(exact, abs=max(0.25, 5e-4 * exact))


@pytest.mark.parametrize("axes", [(2.4, 3.1), (3.66, 4.68), (5.0, 5.0)])
def test_small_ovals_stay_as_long_as_they_are(axes):
    count = round(2 * np.pi * np.mean(axes))
    t = 2 * np.pi * np.arange(count) / count
    loop = Loop(np.column_stack([axes[0] * np.cos(t), axes[1] * np.sin(t)]))
    smooth = smooth_loop(loop, 1.0).points
    assert np.linalg.norm(smooth / axes, axis=1) == pytest.approx(1.0, abs=0.015)


def test_a_slit_ties_no_knot():
    """A banana's outline, 15 pixels across, with a slit of a pixel where another one touches it."""
    t = np.linspace(0.25, 2 * np.pi - 0.25, 42)
    round_ = 7.5 * np.column_stack([np.cos(t), np.sin(t)])
    slit = np.array([[5.0, -0.6], [3.4, 0.3], [2.0, -0.2], [0.5, 0.4], [2.1, 0.5], [3.6, -0.1], [5.2, 0.9]])
    smooth = smooth_loop(Loop(np.vstack([round_, slit])), 1.0).points
    assert not crosses_itself(smooth[None])[0]
