"""The reference object in every picture of a stack: found by two threads, checked against the others."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.reference import Reference
from stackloft.model.reused_memory import memory_reused
from stackloft_plugins.readers.picture_decode import PictureHeader, decode_picture, decode_smaller
from stackloft_plugins.readers.picture_scale import Bench
from stackloft_plugins.readers.reference_sighting import Found, Missing

THREADS = 2
LOOKED_AT = 1800
"""Pixels on the longer side of the copies in which the object is looked for, at least."""
FINE = 300.0
"""Pixels: an object of that size in the copy is measured there, to 0.03 %; a smaller one in the picture."""
_UNLIKE = 0.02
"""Relative: a size further from the others' is not that of the same object."""
_UNLIKE_UNKNOWN = 0.5
"""Likewise where nobody says how far the faces recede."""


@dataclass(frozen=True, slots=True, eq=False)
class Sightings:
    """What was found in the pictures of a stack."""

    found: tuple[Found | None, ...]
    reasons: tuple[str, ...]
    """Why a picture shows none; empty where it does."""
    notices: tuple[Notice, ...] = ()


def find_in_stack(
    headers: Sequence[PictureHeader], reference: Reference, bench: Bench, paper: int
) -> Sightings:
    """Return the reference object in each picture.

    Every picture is decoded once, smaller where that is quicker and the object still large.

    Raises
    ------
    InputError
        No picture shows it, or one cannot be decoded.
    """
    from stackloft.sectioning.opencv_threads import without_opencv_threads  # noqa: PLC0415 - needs OpenCV
    from stackloft_plugins.readers.reference_find import find_reference  # noqa: PLC0415 - likewise

    def look(header: PictureHeader) -> Found | Missing:
        small, factor = decode_smaller(header, paper, LOOKED_AT)
        seen = find_reference(small, reference.kind)
        if factor == 1 or isinstance(seen, Missing):
            return seen
        if seen.size.size >= FINE:
            return seen.enlarged(factor)
        return find_reference(decode_picture(header, paper), reference.kind)

    pool = ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-reference")
    with pool, without_opencv_threads(), memory_reused():
        seen = list(pool.map(look, headers))
    found = tuple(one if isinstance(one, Found) else None for one in seen)
    reasons = tuple(one.reason if isinstance(one, Missing) else "" for one in seen)
    if not any(found):
        raise InputError(
            f"no reference object ({reference}) in any picture",
            where=str(headers[0].path.parent),
            found=f"{headers[0].path.name}: {reasons[0]}",
            expected="it whole, in a corner, apart from the body and from the picture's edge",
            fix="photograph it so, or give --pixel-size",
        )
    cut = [header.path.name for header, one in zip(headers, seen, strict=True) if _is_cut(one)]
    sightings = _like_each_other(Sightings(found, reasons), headers, bench)
    if not cut:
        return sightings
    which = ", ".join(cut[:4]) + (", …" if len(cut) > 4 else "")
    message = f"{which}: an object in a corner, perhaps the reference, is cut off by the picture's border"
    return replace(sightings, notices=(*sightings.notices, Notice("reference-cut-off", message)))


def _is_cut(one: Found | Missing) -> bool:
    return isinstance(one, Missing) and one.cut_off


def _like_each_other(sightings: Sightings, headers: Sequence[PictureHeader], bench: Bench) -> Sightings:
    """Return the sightings without those whose size is another object's."""
    ratio = bench.face_by_reference
    relative = bench.relative
    known = ratio is not None and relative is not None
    expected = ratio / relative if ratio is not None and relative is not None else np.ones(len(headers))
    sizes = np.array([np.nan if one is None else one.size.size for one in sightings.found])
    focal = sizes / expected  # proportional to the focal length: the same for all
    usual = float(np.nanmedian(focal)) if np.count_nonzero(~np.isnan(focal)) > 2 else _first(focal)
    off = np.abs(focal / usual - 1)
    unlike = np.nan_to_num(off) > (_UNLIKE if known else _UNLIKE_UNKNOWN)
    if not unlike.any():
        return sightings
    k = int(np.argmax(np.nan_to_num(off)))
    message = (
        f"{headers[k].path.name}: the object in its corner is {100 * (focal[k] / usual - 1):+.1f} % off the "
        "size of the reference object in the other pictures; it is not used"
    )
    return replace(
        sightings,
        found=tuple(None if bad else one for one, bad in zip(sightings.found, unlike, strict=True)),
        notices=(Notice("reference-outlier", message),),
    )


def _first(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    return float(values[~np.isnan(values)][0])
