"""The level at the body's edge, read off the mean grey profile across the whole boundary.

The half-way level between bands beside the boundary is right for a plain step. Where a skin is darker or
lighter than the flesh, the inner band sees a mixture, and the boundary moves by some tenths of a pixel. The
mean profile across the boundary, thousands of pixels put together, shows background, skin, flesh and blur
apart; a model of them fitted to it says where the edge lies and which grey level it has there.
"""

from __future__ import annotations

import numpy as np

from stackloft.geometry.edge_profile import EdgeFit, fit_edge
from stackloft.model.arrays import FloatArray
from stackloft_plugins.segmenters.across_edge import ACROSS, Across
from stackloft_plugins.segmenters.half_way import Edge

FURTHEST = 0.6
"""Pixels; an edge further from the half-way level's boundary is not believed."""
POOREST = 0.03
"""Misfit, as a fraction of the step, beyond which the model does not describe the edge."""
SHARPEST = 0.45
"""Pixels; a sharper blur is the pixels' own area, and the "skin" its difference from a Gaussian."""
_FEWEST = 40


def edge_level(edge: Edge, seen: Across) -> float:
    """Return the grey level at the edge.

    Parameters
    ----------
    edge : Edge
        What the bands beside the boundary say; its level is the first guess, and the answer when the
        profile shows no edge that the model describes.
    seen : Across
        What is seen across the boundary at that level.

    Returns
    -------
    float
    """
    profile = _mean_profile(seen)
    if profile is None:
        return edge.level
    fit = fit_edge(ACROSS, profile)
    if fit is None or not _tells_more(fit):
        return edge.level
    at_edge = float(np.interp(fit.position, ACROSS, profile))
    at_boundary = float(np.interp(0.0, ACROSS, profile))
    return edge.level + at_edge - at_boundary


def _tells_more(fit: EdgeFit) -> bool:
    """Return whether the fit is to be believed over the half-way level, which is right without a skin."""
    return fit.skin > 0.0 and fit.blur > SHARPEST and fit.misfit < POOREST and abs(fit.position) < FURTHEST


def _mean_profile(seen: Across) -> FloatArray | None:
    """Return the mean of the middle half of the grey levels at each outward distance."""
    if seen.looked_for < _FEWEST or len(seen.points) < 0.5 * seen.looked_for:
        return None
    ordered = np.sort(np.ascontiguousarray(seen.levels.T), axis=1)
    quarter = ordered.shape[1] // 4
    return np.asarray(ordered[:, quarter : ordered.shape[1] - quarter].mean(axis=1, dtype=np.float64))
