r"""Which axis of a scan's array a body should be cut across, as Goñi, Purlis & Salvadori (2007) choose it.

::

      a banana       cut along its length: every section is one filled outline, and it changes little
       .-----.       from one to the next; cut flat, the ends show two pieces, and the sections vary
      (  .-.  )
       \/   \/

Filled sections come first (one piece, no hole); among axes with equally many of them the least variation:
what differs between neighbouring sections, as a part of their mean area. Near ties keep the slices as they
are.
"""

from __future__ import annotations

import cv2
import numpy as np

from stackloft.model.arrays import BoolArray
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation

_SIDE = 96
"""Pixels and slices a side of the coarse copy that is looked at."""
_ALIKE = 0.05
"""How much less an axis must vary, or how many more of its sections be filled, to be better."""


def best_axis(body: Segmentation) -> tuple[int, str]:
    """Return the axis, and in words why; all slices of the body are decoded once.

    Parameters
    ----------
    body : Segmentation
        One body on its own slices.
    """
    scores = [_score(np.moveaxis(_coarse(body), axis, 0)) for axis in range(3)]
    best = 0
    for axis in (1, 2):
        filled, variation = scores[axis]
        more = filled - scores[best][0]
        if more > _ALIKE or (abs(more) <= _ALIKE and variation < (1 - _ALIKE) * scores[best][1]):
            best = axis
    told = "; ".join(
        f"{axis}: {100 * filled:.0f} % of sections filled, variation {variation:.2f}"
        for axis, (filled, variation) in enumerate(scores)
    )
    return best, f"axis {best} was chosen ({told})"


def axis_notice(told: str) -> tuple[Notice, ...]:
    """Return the notice of an axis that was chosen; none where nobody asked."""
    return (Notice("axis-chosen", told),) if told else ()


def _coarse(body: Segmentation) -> BoolArray:
    """Return the body's pixels, (slices, rows, columns), every so many in each direction."""
    stack = body.stack
    steps = [max(1, side // _SIDE) for side in (len(stack), *stack.shape)]
    planes = []
    for k in range(0, len(stack), steps[0]):
        section = body.field_of(k, stack.decode(k))
        level = section.level if section.local_levels is None else section.local_levels
        whole = np.zeros(stack.shape, dtype=np.bool_)
        row, column = section.offset
        rows, columns = section.values.shape
        whole[row : row + rows, column : column + columns] = section.values > level
        planes.append(whole[:: steps[1], :: steps[2]])
    return np.stack(planes)


def _score(sections: BoolArray) -> tuple[float, float]:
    """Return the part of the sections that are one filled piece, and how much they vary."""
    areas = sections.sum(axis=(1, 2))
    shown = sections[areas > 0]
    filled = float(np.mean([_is_filled(section) for section in shown]))
    framed = np.concatenate([np.zeros_like(shown[:1]), shown, np.zeros_like(shown[:1])])
    changes = np.count_nonzero(framed[1:] != framed[:-1])
    return filled, float(changes) / float(areas[areas > 0].mean())


def _is_filled(section: BoolArray) -> bool:
    pieces, _ = cv2.connectedComponents(section.astype(np.uint8), connectivity=8)
    outer, _ = cv2.connectedComponents((~np.pad(section, 1)).astype(np.uint8), connectivity=4)
    return pieces == 2 and outer == 2
