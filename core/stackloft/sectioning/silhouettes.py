r"""Sections from the outlines of slices seen from above: at which plane each outline lies.

::

     z_k ____                    A slice that widens downwards shows its side wall: its outline is its lower
        /    \    widens:        face, at z_k + t. One that narrows hides its wall: its outline is its upper
       /______\   z_k + t        face, at z_k. The slice that holds the widest plane shows that one; where it
       \______/   narrows: z_k   lies follows from the parabola through the outlines before and after.

So every outline is a section again, at its own plane, wherever the body's sections lie within each other. A
body that leans to a side does not: its outlines hold parts of several planes, and what that may cost is told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SectionKind
from stackloft.sectioning.stack_hazards import MISTAKES

SETTLED = "silhouettes"
"""Key of the provenance of slices that were put at their widest planes; these no longer change evenly."""
_INSIDE = 0.05  # of the gap: the widest plane keeps so far from its neighbours'
_LEANS = 0.005


def at_their_planes(segmentation: Segmentation, contours: ContourStack) -> Segmentation:
    """Return the same slices as faces, each where its outline is the body's section.

    Parameters
    ----------
    segmentation : Segmentation
        Of silhouettes, with the slices' thickness.
    contours : ContourStack
        Its outlines.

    Raises
    ------
    InputError
        The slices' thickness is not known.
    """
    stack = segmentation.stack
    if stack.thickness is None:
        raise InputError(
            "slices seen as silhouettes need their thickness", where=stack.names[0],
            fix="give --thickness 5.6mm",
        )  # fmt: skip
    outlines = [
        max((loop.points for loop in section.loops), key=lambda points: abs(polygon_area(points)))
        for section in contours.sections
    ]
    areas = np.abs([polygon_area(outline) for outline in outlines])
    planes = planes_of(stack.positions, stack.thickness, areas)
    settled = replace(
        stack,
        positions=frozen_floats(planes),
        kind=SectionKind.FACE,
        thickness=None,
        provenance={**stack.provenance, SETTLED: "each at the widest plane of its slice"},
    )
    mistakes = tuple(notice for notice in contours.notices if notice.code in MISTAKES)
    more = (*_leaning(outlines, areas), *mistakes)
    return replace(segmentation, stack=settled, notices=(*segmentation.notices, *more))


def planes_of(upper: FloatArray, thickness: FloatArray, areas: FloatArray) -> FloatArray:
    """Return where each slice's widest plane lies, (m) mm, increasing.

    Parameters
    ----------
    upper : array (m)
        The slices' upper faces, mm.
    thickness : array (m)
        mm
    areas : array (m)
        The silhouettes'.

    Examples
    --------
    >>> z = np.arange(0.0, 20.0, 4.0)                       # a ball of radius 10 in five slices
    >>> widest = np.clip(10.0, z, z + 4)
    >>> planes_of(z, np.full(5, 4.0), np.pi * (100 - (widest - 10) ** 2)).round(9).tolist()
    [4.0, 8.0, 10.0, 12.0, 16.0]
    """
    m = len(areas)
    lower = upper + thickness
    planes = np.empty(m)
    peaks = []
    for k in range(m):
        grows = areas[min(k + 1, m - 1)] - areas[max(k, 0)] if k < m - 1 else areas[k] - areas[k - 1]
        grew = areas[k] - areas[k - 1] if k else grows
        planes[k] = lower[k] if grows > 0 else upper[k]
        if grew > 0 >= grows and 0 < k < m - 1:
            peaks.append(k)
        if grew < 0 < grows and 0 < k < m - 1:
            planes[k] = _neck(k, upper, lower, areas)
    for k in peaks:
        before, after = planes[k - 1], planes[k + 1]
        rise, fall = (float(np.sqrt(max(areas[k] - areas[j], 0.0))) for j in (k - 1, k + 1))
        part = rise / (rise + fall) if rise + fall > 0 else 0.5
        planes[k] = before + (after - before) * float(np.clip(part, _INSIDE, 1 - _INSIDE))
    return planes


def _neck(k: int, upper: FloatArray, lower: FloatArray, areas: FloatArray) -> float:
    """Return the plane of a slice that holds a neck: its upper face or its lower one, whichever fits."""
    m = len(areas)
    from_above = 2 * areas[k - 1] - areas[k - 2] if k >= 2 else areas[k - 1]
    from_below = 2 * areas[k + 1] - areas[k + 2] if k + 2 < m else areas[k + 1]
    return float(upper[k] if abs(areas[k] - from_above) <= abs(areas[k] - from_below) else lower[k])


def _leaning(outlines: Sequence[FloatArray], areas: FloatArray) -> tuple[Notice, ...]:
    """Return a notice when outlines drift aside by more than they grow or shrink from slice to slice.

    From one face of a slice to the other the outline moves outwards by g + d·cos θ, g being its growth and
    d the drift. The part of the smaller face that sticks out beyond the larger one widens the silhouette:
    ∫ max(0, −g − d·cos θ) ds = w·(√(d² − g²) − g·arccos(g/d)), w being the width across the drift.
    """
    middles = np.array([polygon_centroid(outline) for outline in outlines])
    step = np.gradient(middles, axis=0)
    drift = np.linalg.norm(step, axis=1)
    rims = np.array([
        float(np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1).sum()) for outline in outlines
    ])  # fmt: skip
    growth = np.minimum(np.abs(np.gradient(areas)) / rims, drift)
    across = np.column_stack([-step[:, 1], step[:, 0]]) / np.maximum(drift, 1e-300)[:, None]
    width = np.array([float(np.ptp(outline @ way)) for outline, way in zip(outlines, across, strict=True)])
    part = growth / np.maximum(drift, 1e-300)
    excess = width * (np.sqrt(drift**2 - growth**2) - growth * np.arccos(np.clip(part, 0, 1)))
    share = float(excess.sum() / areas.sum())
    if share < _LEANS:
        return ()
    message = (
        f"the silhouettes drift aside by {drift.mean():.2g} mm from slice to slice, so that they are wider "
        f"than the sections: volume about {100 * share:.1f} % high; photograph the cut faces without walls, "
        "or cut across the body's own axis"
    )
    return (Notice("silhouettes-lean", message),)
