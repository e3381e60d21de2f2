"""Mistakes that a stack of photographs shows by itself: order, missing, doubled and odd cuts, motion.

Section shapes and middles of a body change smoothly along its axis. What breaks the smoothness, and the one
change that mends it, tell what happened (`geometry.order_hypotheses`, `geometry.displacement`). Small
sections at the ends, which change fast, are left out; so is every stack of fewer than eight sections. Where
a section shows several outlines (limbs, several pieces) there is no one shape to follow: the longest run of
sections with one outline is judged.
The thresholds lie above what sound phantoms of 15 kinds show, tilted ones among them
(`tests/sectioning/test_stack_hazards.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from stackloft.geometry.convex_wander import explained_displacement
from stackloft.geometry.displacement import Displacement, best_displacement
from stackloft.geometry.order_hypotheses import Supposition, best_supposition
from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.geometry.support_features import support_features
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Section
from stackloft.model.notices import Notice
from stackloft.sectioning.misalignment import misaligned

MISTAKES = frozenset({"wrong-order", "slice-missing", "slice-doubled", "slice-odd", "motion", "misaligned"})
"""Codes of what is told here."""
FEWEST = 8
"""Sections, without the small ones at the ends."""
SMALL = 0.3
"""Of the largest area: smaller sections at an end are not judged."""
FEWEST_LAID = 6
"""Sections from which on it is told whether slices lie on each other."""
TIP = 0.05
"""Of the largest area: smaller sections at an end say nothing of that."""
GAINS = {"swapped": 4.0, "moved": 4.0, "missing": 4.0, "doubled": 4.0, "outlier": 7.0}
"""How much rougher than when changed a stack must be for the change to be told."""
MOVED = 10.0
"""Likewise for a displacement."""
LEAST_MOVE = (0.015, 3.0)
"""Of the mean diameter, and pixels: smaller displacements, beyond what the body's own corners may look like,
do no harm."""
LEAST_ODD = 0.01
"""Of the area: by which an odd section must differ from its neighbours' mean."""
_EDGE = 0.1  # pixels: noise of a section's outline
_ALIKE = 0.3  # of the usual change from section to section: closer sections are the same cut


@dataclass(frozen=True, slots=True, eq=False)
class _Judged:
    """The sections that are judged."""

    names: tuple[str, ...]
    z: FloatArray
    outlines: tuple[FloatArray, ...]
    """Largest outline of each, mm."""
    pixel: float

    @property
    def areas(self) -> FloatArray:
        return np.abs([polygon_area(outline) for outline in self.outlines])

    @property
    def diameter(self) -> float:
        """Of the circle of the mean area, mm."""
        return float(np.sqrt(4 / np.pi * self.areas.mean()))

    @property
    def middles(self) -> FloatArray:
        return np.array([polygon_centroid(outline) for outline in self.outlines])


def stack_hazards(sections: Sequence[Section], pixel: float) -> tuple[Notice, ...]:
    """Return what the sections of a photographed stack say of mistakes, by file name and figure.

    Parameters
    ----------
    sections : sequence of Section
        In order; traced on pictures.
    pixel : float
        Largest pixel size, mm.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> cuts = list(phantoms.make("apple").contour_stack(14).sections)
    >>> stack_hazards(cuts, 0.2)
    ()
    """
    judged = _judged(sections, pixel, SMALL, FEWEST)
    order, accused = ((), ()) if judged is None else _order(judged)
    motion = () if judged is None or order else _motion(judged)
    if motion:
        return motion
    others = [section for section in sections if section.name not in accused]
    return order + _misaligned(_judged(others, pixel, TIP, FEWEST_LAID))


def _judged(sections: Sequence[Section], pixel: float, small: float, fewest: int) -> _Judged | None:
    if any(not section.loops for section in sections):
        return None
    sections = _longest_run(sections)
    if len(sections) < fewest:
        return None
    outlines = [
        max((loop.points for loop in section.loops), key=lambda points: abs(polygon_area(points)))
        for section in sections
    ]
    areas = np.abs([polygon_area(outline) for outline in outlines])
    large = np.flatnonzero(areas >= small * areas.max())
    inner = slice(int(large[0]), int(large[-1]) + 1)
    kept = sections[inner]
    if len(kept) < fewest:
        return None
    names = tuple(section.name for section in kept)
    return _Judged(names, np.array([section.z for section in kept]), tuple(outlines[inner]), pixel)


def _longest_run(sections: Sequence[Section]) -> Sequence[Section]:
    """Return the longest run of sections that have one outline each (holes are no matter)."""
    runs = groupby(sections, key=lambda section: sum(not loop.hole for loop in section.loops) == 1)
    return max((list(run) for single, run in runs if single), key=len, default=[])


def _order(judged: _Judged) -> tuple[tuple[Notice, ...], tuple[str, ...]]:
    """Return what is wrong with the order, and the sections that this is about."""
    features = np.array([support_features(outline) for outline in judged.outlines])
    noise = 2 * _EDGE * judged.pixel * float(np.sqrt(features.sum(axis=1).mean()))
    pitch = float(np.median(np.diff(judged.z)))
    best = best_supposition(judged.z, features, noise, pitch)
    if best is None or best.gain < GAINS[best.change]:
        return (), ()
    names = judged.names
    notices = _order_notices(judged, features, best)
    return notices, (names[best.first], names[best.second]) if notices else ()


def _order_notices(judged: _Judged, features: FloatArray, best: Supposition) -> tuple[Notice, ...]:
    names = judged.names
    told = f"the sections are then {best.gain:.0f} times as smooth"
    if best.change in {"swapped", "moved"}:
        return (Notice("wrong-order", _order_text(best, names, told)),)
    if best.change == "missing":
        message = (
            f"{names[best.first]}, {names[best.second]}: a cut seems to be missing between them ({told}); "
            "give --positions if one was not photographed"
        )
        return (Notice("slice-missing", message),)
    if best.change == "doubled":
        return _doubled(features, best, names, told)
    return _odd(judged, best, told)


def _order_text(best: Supposition, names: Sequence[str], told: str) -> str:
    if best.change == "swapped":
        return f"{names[best.first]}, {names[best.second]}: seem to be in each other's place ({told})"
    where = names[best.second]
    return f"{names[best.first]}: seems to be out of order and to belong where {where} is ({told})"


def _doubled(features: FloatArray, best: Supposition, names: Sequence[str], told: str) -> tuple[Notice, ...]:
    """Return a notice when two neighbours are as good as the same; leaving out either is as smooth."""
    steps = np.linalg.norm(np.diff(features, axis=0), axis=1)
    near = [k for k in (best.first, best.first + 1) if k < len(steps)]
    k = min(near, key=lambda at: float(steps[at]))
    if steps[k] > _ALIKE * float(np.median(steps)):
        return ()
    message = (
        f"{names[k]}, {names[k + 1]}: seem to show the same cut: they differ by "
        f"{100 * steps[k] / float(np.median(steps)):.0f} % of what neighbours usually do ({told}); "
        "move one away, or set skip = true for it and give --positions"
    )
    return (Notice("slice-doubled", message),)


def _odd(judged: _Judged, best: Supposition, told: str) -> tuple[Notice, ...]:
    k, areas = best.first, judged.areas
    if not 2 <= k <= len(areas) - 3:
        return ()
    beside = (areas[k - 1] + areas[k + 1]) * 2 / 3 - (areas[k - 2] + areas[k + 2]) / 6
    off = areas[k] / beside - 1
    if abs(off) < LEAST_ODD:
        return ()
    message = (
        f"{judged.names[k]}: its area is {100 * off:+.1f} % off what its neighbours lead to expect ({told} "
        "without it); look at its contour"
    )
    return (Notice("slice-odd", message),)


def _motion(judged: _Judged) -> tuple[Notice, ...]:
    best = best_displacement(judged.z, judged.middles, _EDGE * judged.pixel)
    if best is None or best.gain < MOVED or not _inside(best.first, judged):
        return ()
    least = max(LEAST_MOVE[0] * judged.diameter, LEAST_MOVE[1] * judged.pixel)
    if best.length < least or best.length - _own_corners(best, judged) < least:
        return ()
    whole = "lies" if best.single else "and all that follow lie"
    message = (
        f"{judged.names[best.first]}: {whole} {best.length:.2g} mm beside the others "
        f"(the middles are {best.gain:.0f} times as smooth without that); camera or piece moved"
    )
    return (Notice("motion", message),)


def _own_corners(found: Displacement, judged: _Judged) -> float:
    """Return how much of a displacement a tilted body's corners may look like, mm."""
    numbers = np.arange(len(judged.names))
    displaced = numbers == found.first if found.single else numbers >= found.first
    whereto = np.array(found.shift) / found.length
    return explained_displacement(judged.z, judged.outlines, displaced, whereto)


def _misaligned(judged: _Judged | None) -> tuple[Notice, ...]:
    loose = None if judged is None else misaligned(judged.names, judged.z, judged.outlines)
    return () if loose is None else (loose,)


def _inside(k: int, judged: _Judged) -> bool:
    return 2 <= k <= len(judged.names) - 2
