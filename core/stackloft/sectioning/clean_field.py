"""A slice's field with crumbs and glare taken out, by the same rules as its contours.

Methods that look at voxels must measure the same body as those that look at contours; what `tracing` drops
is brought to the background's side of the level here, what it fills to the body's.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.slice_lines import TraceRules
from stackloft.sectioning.slice_pieces import pinched


def cleaned(section: SectionField, *, labels: bool, rules: TraceRules | None = None) -> SectionField:
    """Return the section with what `clean_field` changes; itself where there is nothing to change."""
    if labels or _is_clean(section):
        return section
    level = section.level if section.local_levels is None else section.local_levels
    return replace(section, values=clean_field(section, labels=False, rules=rules) + level, noise=None)


def _is_clean(section: SectionField) -> bool:
    """Return whether the body is one piece without a hole, which most are."""
    if section.outline is not None:
        return True
    bits = np.ascontiguousarray(section.above()).view(np.uint8)
    outlines, _ = cv2.findContours(bits, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return len(outlines) == 1 and not pinched(bits, outlines[0][:, 0])


def clean_field(section: SectionField, *, labels: bool, rules: TraceRules | None = None) -> FloatArray:
    """Return the field above its level, positive in the body.

    Parameters
    ----------
    section : SectionField
        Body above the level.
    labels : bool
        True for a label map: somebody has said which pixels are body, so nothing is dropped or filled.
    rules : TraceRules, optional
        What is debris, branch and hole.

    Returns
    -------
    (rows, columns) array
        Grey levels above the level, of the crop. Pixels whose side was changed have the mirrored value.

    Examples
    --------
    >>> grey = np.zeros((20, 20))
    >>> grey[2:12, 2:12], grey[5, 5], grey[16, 16] = 9.0, 0.0, 9.0
    >>> field = clean_field(SectionField(grey, 4.0), labels=False)
    >>> int((field > 0).sum()), float(field[5, 5]), float(field[16, 16])
    (100, 4.0, -5.0)
    """
    field = section.relative()
    if labels or _is_clean(section) or not (field > 0).any():
        return field
    rules = rules or TraceRules()
    crumbs, largest = _crumbs(field, rules)
    field = np.where(crumbs, -np.abs(field), field)
    glare = _filled(field, largest, rules)
    field[glare] = np.maximum(np.abs(field[glare]), np.finfo(float).tiny)
    return field


def _components(mask: BoolArray, connectivity: int) -> tuple[IntArray, IntArray]:
    """Return each pixel's component (0: none) and the components' areas."""
    _, own, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(own, np.int64), np.asarray(stats[:, cv2.CC_STAT_AREA], np.int64)


def _crumbs(field: FloatArray, rules: TraceRules) -> tuple[BoolArray, float]:
    """Return the pixels of objects too small to be a branch of the body, and the largest object's area."""
    own, areas = _components(field > 0, 4)
    areas[0] = 0
    largest = float(areas.max())
    small = areas < rules.branch * largest
    small[0] = False
    return small[own], largest


def _filled(field: FloatArray, largest: float, rules: TraceRules) -> BoolArray:
    """Return the pixels of holes that are small, or through which no background is seen."""
    own, areas = _components(field <= 0, 8)
    frame = np.concatenate([own[0], own[-1], own[:, 0], own[:, -1]])
    clear = rules.background_like * float(
        np.median(np.concatenate([field[0], field[-1], field[:, 0], field[:, -1]]))
    )
    fill = areas < rules.hole * largest
    for hole in np.flatnonzero(~fill):
        fill[hole] = bool(np.median(field[own == hole]) > clear)
    fill[np.unique(frame)] = False
    fill[0] = False
    return fill[own]
