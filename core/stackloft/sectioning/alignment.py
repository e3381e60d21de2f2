r"""Slices that were photographed one by one, laid back on each other.

::

    as photographed      aligned          By fiducial marks that moved with each slice: they lie in the same
      [ ]                  [ ]            place again, whatever the body's shape. Without marks, by the
         [ ]        ->      [ ]           sections themselves: how their middles and shapes change along the
      [ ]                    [ ]          axis is smooth, and only the jitter about that course is taken back;
           [ ]                [ ]         bow, slant and twist are the body's own and stay.

A stack is never straightened: the course that stays is a free curve, as rough as is likeliest
(`geometry.smooth_trend`), not a line. What was done is told slice by slice, and is bounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.geometry.smooth_trend import jitter_about_trend
from stackloft.geometry.turning_jitter import turning_jitter
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Section
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SectionKind
from stackloft.sectioning.mark_alignment import by_marks
from stackloft.sectioning.slice_motion import Motion, moved

How = Literal["none", "translation", "rigid"]
HOW: tuple[How, ...] = ("none", "translation", "rigid")

FEWEST = 6
"""Sections below which jitter cannot be told from a body's own bow."""
FURTHEST = 0.2
"""Of the body's mean diameter: no section is moved further by what its neighbours say."""
STEEPEST = float(np.radians(12.0))
"""rad: no section is turned further by what its neighbours say."""
_EDGE = 0.1  # pixels: noise of a section's outline


def laid_out(segmentation: Segmentation, how: str) -> Segmentation:
    """Return the segmentation of the same slices where they belong: silhouettes at their planes, aligned.

    Parameters and errors as for `aligned`; silhouettes need one look at every slice as well.
    """
    if segmentation.stack.kind is not SectionKind.SILHOUETTE:
        return aligned(segmentation, how)
    from stackloft.sectioning.contour_sink import trace_stack  # noqa: PLC0415 - it needs OpenCV
    from stackloft.sectioning.silhouettes import at_their_planes  # noqa: PLC0415

    flat = replace(segmentation, stack=replace(segmentation.stack, kind=SectionKind.FACE))
    return aligned(at_their_planes(segmentation, trace_stack(flat)), how)


def aligned(segmentation: Segmentation, how: str) -> Segmentation:
    """Return the segmentation of the same slices, aligned.

    Parameters
    ----------
    segmentation : Segmentation
        Of photographs; without marks every slice is decoded once.
    how : {"auto", "none", "translation", "rigid"}
        ``auto``: as the stack's hints say, else ``none``.

    Raises
    ------
    InputError
        A scan, too few sections, or a slice without its marks.
    """
    stack = segmentation.stack
    chosen = (stack.hints.align or "none") if how == "auto" else how
    if chosen == "none":
        return segmentation
    if stack.kind is SectionKind.SLAB:
        raise UsageError(
            "a scanner's slices lie where their headers say", where="--align", found=chosen, expected="none"
        )
    rigid = chosen == "rigid"
    notices: tuple[Notice, ...] = ()
    if stack.marks is not None:
        motion, source = by_marks(stack, rigid=rigid), "fiducial marks"
    else:
        from stackloft.sectioning.contour_sink import trace_stack  # noqa: PLC0415 - it needs OpenCV

        contours = trace_stack(segmentation)
        motion, notices = by_neighbours(contours, rigid=rigid)
        source = "neighbouring sections"
    told = {**stack.provenance, "alignment": f"{chosen}, by {source}"}
    laid = replace(moved(stack, motion), provenance=told, marks=None)
    done = _told(stack.names, motion, source, rigid=rigid)
    return replace(segmentation, stack=laid, notices=(*segmentation.notices, *notices, done))


def by_neighbours(contours: ContourStack, *, rigid: bool) -> tuple[Motion, tuple[Notice, ...]]:
    """Return the motion that takes back the sections' jitter about their smooth course, bounded.

    Raises
    ------
    InputError
        Too few sections, or one without a body.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> bow = phantoms.make("banana").contour_stack(14)
    >>> bool(np.abs(by_neighbours(bow, rigid=True)[0].shift).max() < 0.2)
    True
    """
    sections = contours.sections
    if len(sections) < FEWEST:
        raise InputError(
            "too few sections to tell jitter from the body's own bow",
            where="--align",
            found=str(len(sections)),
            expected=f"at least {FEWEST}",
            fix="declare fiducial marks in stack.toml, or leave --align out",
        )
    z = contours.positions
    outlines = [_largest(section) for section in sections]
    middles = np.array([polygon_centroid(outline) for outline in outlines])
    diameter = float(np.sqrt(4 / np.pi * np.mean([abs(polygon_area(outline)) for outline in outlines])))
    shift = -jitter_about_trend(z, middles)
    noise = _EDGE * contours.resolution + 1e-4 * diameter
    turn = -turning_jitter(z, outlines, noise) if rigid else np.zeros(len(z))
    names = [section.name for section in sections]
    return _bounded(Motion(middles, shift, turn), FURTHEST * diameter, names)


def _largest(section: Section) -> FloatArray:
    if not section.loops:
        raise InputError("no body found", where=section.name)
    return max((loop.points for loop in section.loops), key=lambda points: abs(polygon_area(points)))


def _bounded(motion: Motion, furthest: float, names: Sequence[str]) -> tuple[Motion, tuple[Notice, ...]]:
    """Return the motion with no slice moved or turned further than the bounds, and who met them."""
    length = np.linalg.norm(motion.shift, axis=1)
    over = (length > furthest) | (np.abs(motion.turn) > STEEPEST)
    if not over.any():
        return motion, ()
    shift = motion.shift * np.minimum(1.0, furthest / np.maximum(length, 1e-300))[:, None]
    kept = replace(motion, shift=shift, turn=np.clip(motion.turn, -STEEPEST, STEEPEST))
    k = int(np.argmax(length / furthest + np.abs(motion.turn) / STEEPEST))
    message = (
        f"{names[k]}: lies {length[k]:.2g} mm and {np.degrees(motion.turn[k]):.2g}° off its neighbours' "
        f"course, more than alignment by neighbours may take back ({furthest:.2g} mm, "
        f"{np.degrees(STEEPEST):.2g}°)"
        f"{_others(int(over.sum()) - 1)}; look at the picture, or use fiducial marks"
    )
    return kept, (Notice("align-bounded", message),)


def _others(count: int) -> str:
    return f", and {count} more" if count else ""


def _told(names: Sequence[str], motion: Motion, source: str, *, rigid: bool) -> Notice:
    """Return what was done, slice by slice."""
    length = np.linalg.norm(motion.shift, axis=1)
    degrees = np.degrees(motion.turn)
    each = [
        f"{name} {x:+.2f} {y:+.2f} mm" + (f" {angle:+.2f}°" if rigid else "")
        for name, (x, y), angle in zip(names, motion.shift, degrees, strict=True)
    ]
    turned = f" and turned by up to {np.abs(degrees).max():.2g}°" if rigid else ""
    most = f"slices moved by up to {length.max():.2g} mm{turned}, by {source}"
    return Notice("aligned", f"{most}: {'; '.join(each)}")
