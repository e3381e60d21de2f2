"""What a person should know about the scale: what is not known and may cost, what does not agree."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from stackloft.geometry.pinhole import face_scale, one_scale_cost
from stackloft.model.arrays import FloatArray
from stackloft.model.notices import Notice
from stackloft_plugins.readers.picture_decode import PictureHeader
from stackloft_plugins.readers.picture_scale import Bench
from stackloft_plugins.readers.reference_sighting import Found

USUAL = (600.0, 1000.0)
"""mm: distances at which hand-held and stand cameras photograph food."""
WORTH_TELLING = 0.005
"""Relative error in volume."""
_OBLIQUE = 0.01
_MOVED = (1.5, 4.0)  # pixels: what counts as still, and what as a jump


def plane_notice(bench: Bench, headers: Sequence[PictureHeader], seen: Sequence[bool]) -> tuple[Notice, ...]:
    """Return ``scale-plane-unknown`` when distance or plane of the faces matter and nobody tells them.

    A pixel size told for pictures that no camera is known to have taken is believed: it is said to hold
    on the cut face. The files of a camera (EXIF), or a reference object that only some pictures show, are
    another matter, for under a fixed camera the faces recede.
    """
    said = bench.said
    one_scale = (
        not all(seen) if said.reference is not None and not said.explicit else _one_told(bench, headers)
    )
    if one_scale and bench.relative is None:
        costs = [one_scale_cost(bench.travelled, distance) for distance in _distances(bench, headers)]
        if max(map(abs, costs)) >= WORTH_TELLING:
            told = "no camera distance" if said.plane == "receding" else "not said whether the faces recede"
            return (_costly(f"one scale for all pictures ({told})", costs, bench, headers),)
    if said.reference is not None and not said.explicit and bench.face_by_reference is None:
        heights = bench.heights if bench.heights is not None else bench.travelled + said.height
        costs = [
            float(np.mean(face_scale(np.full(len(heights), distance), heights) ** -2.0) - 1)
            for distance in _distances(bench, headers)
        ]
        if max(map(abs, costs)) >= WORTH_TELLING:
            return (
                _costly("the reference object is not in the plane of the cut face", costs, bench, headers),
            )
    return ()


def _one_told(bench: Bench, headers: Sequence[PictureHeader]) -> bool:
    return bench.said.pixel_size is not None and any(header.tags.by_camera for header in headers)


def _distances(bench: Bench, headers: Sequence[PictureHeader]) -> tuple[float, ...]:
    if bench.said.distance is not None:
        return (bench.said.distance,)
    written = [header.tags.subject_distance for header in headers if header.tags.subject_distance]
    return (float(np.median(written)),) if written else USUAL


def _costly(what: str, costs: Sequence[float], bench: Bench, headers: Sequence[PictureHeader]) -> Notice:
    at = " or ".join(
        f"{100 * cost:+.1f} % at {distance:g} mm"
        for cost, distance in zip(costs, _distances(bench, headers), strict=True)
    )
    message = (
        f"{headers[0].path.parent.name}: {what}; under a fixed camera that may cost {at} in volume; "
        'say plane = "fixed" or "receding" and distance in [camera] of stack.toml'
    )
    return Notice("scale-plane-unknown", message)


def reference_notices(
    headers: Sequence[PictureHeader], found: Sequence[Found | None], reasons: Sequence[str]
) -> tuple[Notice, ...]:
    """Return what is odd about the reference object: missing where most show it, oblique, or moved."""
    names = [header.path.name for header in headers]
    seen = [one for one in found if one is not None]
    notices = []
    missing = [k for k, one in enumerate(found) if one is None]
    if missing and len(seen) > len(found) / 2:
        which = ", ".join(names[k] for k in missing[:4]) + (", …" if len(missing) > 4 else "")
        message = f"{which}: {reasons[missing[0]]}; the scale is taken from the other {len(seen)} pictures"
        notices.append(Notice("reference-missing", message))
    oblique = [(one.size.oblique, k) for k, one in enumerate(found) if one is not None]
    worst, k = max(oblique)
    if worst > _OBLIQUE:
        message = (
            f"{names[k]}: the reference object's two diameters differ by {100 * worst:.1f} %; the camera "
            "does not look straight down"
        )
        notices.append(Notice("reference-oblique", message))
    return (*notices, *_moved(names, found))


def _moved(names: Sequence[str], found: Sequence[Found | None]) -> tuple[Notice, ...]:
    """Return a notice when an object that lies still in most pictures jumps in some."""
    at = [(k, np.array(one.centre)) for k, one in enumerate(found) if one is not None]
    if len(at) < 4:
        return ()
    steps: FloatArray = np.array([np.linalg.norm(b - a) for (_, a), (_, b) in pairwise(at)])
    jump = int(np.argmax(steps))
    if np.median(steps) > _MOVED[0] or steps[jump] < _MOVED[1]:
        return ()
    message = (
        f"{names[at[jump + 1][0]]}: camera or plate moved: the reference object lies "
        f"{steps[jump]:.0f} pixels from where {names[at[jump][0]]} shows it"
    )
    return (Notice("motion", message),)
