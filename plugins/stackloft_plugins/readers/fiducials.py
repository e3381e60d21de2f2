r"""Fiducial marks: equal discs that were fixed to the block before it was cut, found in every picture.

::

    o  +------+        o +------+       Two marks or more, beside the body and apart from it, of one diameter,
       | body | o   ->   | body |  o    darker or lighter than the plate. They move with their slice, so that
       +------+        o +------+       where they lie tells how the slice was laid down.
      o

Candidates are what is round and of that diameter; the pattern is that of the picture whose candidates most
other pictures share. Marks are hidden before the body is looked for, as a reference object is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.point_match import matched
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.reference import Reference
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.reference_find import grey_window, object_found, resizable
from stackloft_plugins.readers.reference_shapes import (
    LEVELS,
    Shape,
    contrast_with_plate,
    greatest,
    is_round,
    shapes_at,
)
from stackloft_plugins.readers.reference_sighting import Found
from stackloft_plugins.readers.reference_size import disc_at

THREADS = 2
_ALIKE = 0.12
"""Relative: how far a mark's diameter may be from the one told."""
_ACROSS = 12.0  # pixels: a mark in the copy in which marks are looked for
_SMALL = 900  # pixels: that copy's longer side, where marks are large enough
_REACH = 0.3  # of the least distance between two marks
_SHARED = 0.5  # of the pictures: a mark of the pattern is seen in so many
_STRETCHED = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """The marks of a stack."""

    places: FloatArray
    """(m, k, 2) column, row; NaN where one was not seen"""
    found: tuple[tuple[Found, ...], ...]
    """What is hidden in each picture."""
    notices: tuple[Notice, ...] = ()


def marks_of(
    decode: Callable[[int], Picture], names: Sequence[str], spacing: FloatArray, mark: Reference
) -> Marks:
    """Return the fiducial marks of every picture; every picture is decoded once.

    Parameters
    ----------
    decode : callable
        Slice number to picture, the reference object already hidden.
    names : sequence of m str
    spacing : array (m, 2)
        Row and column spacing, mm.
    mark : Reference
        A disc.

    Raises
    ------
    InputError
        No picture shows two such marks.
    """

    def look(number: int) -> tuple[Found, ...]:
        return find_marks(decode(number), mark.size / float(spacing[number].mean()))

    with ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-marks") as pool:
        seen = list(pool.map(look, range(len(names))))
    lying = [
        np.array([one.centre for one in found]).reshape(-1, 2) * own[::-1]
        for found, own in zip(seen, spacing, strict=True)
    ]
    pattern = _pattern(lying)
    if pattern is None:
        counts = ", ".join(f"{name}: {len(found)}" for name, found in list(zip(names, seen, strict=True))[:3])
        raise InputError(
            f"no fiducial marks ({mark}) that the pictures share",
            found=f"{counts}, …",
            expected="at least two whole discs of that diameter beside the body, the same in all pictures",
            fix="correct the diameter or the pixel size, or take fiducials out of stack.toml",
        )
    reach = _reach(pattern)
    places = np.array([matched(points, pattern, reach) for points in lying])
    notices = (*_missing(places, names), *_stretched(places, names))
    return Marks(frozen_floats(places / spacing[:, None, ::-1]), tuple(seen), notices)


def find_marks(picture: NDArray[Any], diameter: float) -> tuple[Found, ...]:
    """Return the discs of about `diameter` pixels that stand apart in a picture.

    Examples
    --------
    >>> scene = np.full((200, 300), 240, dtype=np.uint8)
    >>> scene[60:160, 120:260] = 90
    >>> for x, y in ((40, 50), (60, 150)):
    ...     _ = cv2.circle(scene, (x, y), 12, 60, cv2.FILLED)
    >>> [tuple(round(v) for v in mark.centre) for mark in find_marks(scene, 25.0)]
    [(40, 50), (60, 150)]
    """
    rows, columns = picture.shape[:2]
    step = max(1.0, min(max(rows, columns) / _SMALL, diameter / _ACROSS))
    size = (round(columns / step), round(rows / step))
    small = cv2.resize(resizable(picture), size, interpolation=cv2.INTER_AREA) if step > 1 else picture
    contrast = contrast_with_plate(small)
    most = greatest(contrast)
    found: list[Found] = []
    least = 0.4 * np.pi / 4 * (diameter / step) ** 2
    for part in LEVELS:
        shapes = shapes_at(contrast, part * most, least)
        for shape in shapes:
            measured = _measured(picture, shape, step, diameter)
            if measured is not None and not _known(measured, found, diameter):
                others = [other for other in shapes if other is not shape]
                found.append(_placed(measured, shape, others, step, (rows, columns)))
    return tuple(sorted(found, key=lambda one: one.centre))


_Disc = tuple[tuple[float, float], Any]


def _measured(picture: NDArray[Any], shape: Shape, step: float, diameter: float) -> _Disc | None:
    """Return a disc's centre and size on the whole picture's pixels; None for what is none of that size."""
    (x, y), sides, _ = shape.box
    across = 0.5 * sum(sides) * step
    if not is_round(shape) or abs(across / diameter - 1) > 2 * _ALIKE + 2 * step / diameter:
        return None
    grey, (left, top) = grey_window(picture, shape, step)
    middle = ((x + 0.5) * step - 0.5 - left, (y + 0.5) * step - 0.5 - top)
    disc = disc_at(grey, middle, 0.5 * across)
    if disc is None or abs(disc[1].size / diameter - 1) > _ALIKE or disc[1].misfit > 0.03:
        return None
    (x, y), size = disc
    return (x + left, y + top), size


def _known(disc: _Disc, found: Sequence[Found], diameter: float) -> bool:
    return any(np.linalg.norm(np.subtract(disc[0], one.centre)) < diameter for one in found)


def _placed(disc: _Disc, shape: Shape, others: list[Shape], step: float, whole: tuple[int, int]) -> Found:
    hidden = object_found(disc[1], shape, others, step, whole)
    return Found(disc[1], disc[0], hidden.corner, hidden.hidden)


def _pattern(lying: Sequence[FloatArray]) -> FloatArray | None:
    """Return the marks that most pictures share, as they lie in one of them; None for fewer than two."""
    best: FloatArray | None = None
    most = 0.0
    for points in lying:
        if len(points) < 2:
            continue
        seen = np.array([np.isfinite(matched(other, points, _reach(points))[:, 0]) for other in lying])
        shared = seen.mean(axis=0) >= _SHARED
        if shared.sum() >= 2 and seen[:, shared].sum() > most:
            best, most = points[shared], float(seen[:, shared].sum())
    return best


def _reach(pattern: FloatArray) -> float:
    apart = np.linalg.norm(pattern[:, None] - pattern[None], axis=2)
    return _REACH * float(apart[apart > 0].min())


def _missing(places: FloatArray, names: Sequence[str]) -> tuple[Notice, ...]:
    seen: NDArray[np.bool_] = np.asarray(np.isfinite(places).all(axis=2))
    few = [k for k, own in enumerate(seen) if not own.all()]
    if not few:
        return ()
    listed = ", ".join(f"{names[k]} ({int(seen[k].sum())})" for k in few[:5])
    more = f" and {len(few) - 5} more" if len(few) > 5 else ""
    message = f"{listed}{more}: not all {places.shape[1]} fiducial marks were found"
    return (Notice("fiducial-missing", message),)


def _stretched(places: FloatArray, names: Sequence[str]) -> tuple[Notice, ...]:
    """Return a notice when marks lie further apart, or nearer, than in the other pictures."""
    whole = np.isfinite(places).all(axis=(1, 2))
    if whole.sum() < 3:
        return ()
    spread = np.where(
        whole, np.linalg.norm(places - places.mean(axis=1, keepdims=True), axis=2).mean(axis=1), 0
    )
    usual = float(np.median(spread[whole]))
    off = np.where(whole, spread / usual - 1, 0.0)
    k = int(np.argmax(np.abs(off)))
    if abs(off[k]) < _STRETCHED:
        return ()
    message = (
        f"{names[k]}: its fiducial marks lie {100 * off[k]:+.1f} % off their usual distance from each other; "
        "its scale is wrong, or what was found is no mark"
    )
    return (Notice("fiducials-apart", message),)
