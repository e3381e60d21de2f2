"""In which order sections are added: first and last, then the middle of the widest gap, and so on.

::

    9 sections    0 . . . . . . . 8
                  0 . . . 4 . . . 8
                  0 . 2 . 4 . 6 . 8      nested: a section once taken stays
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from stackloft.model.arrays import FloatArray

MOST = 33
"""Section counts studied one by one up to here; above, about eight for each doubling."""


def bisection_order(positions: Sequence[float] | FloatArray) -> tuple[int, ...]:
    """Return every section's index in the order in which sections are added.

    The widest gap with a section in it is halved by the section nearest to its middle; of equal gaps the
    first.

    Parameters
    ----------
    positions : (m,) mm
        Increasing, m ≥ 2.

    Examples
    --------
    >>> bisection_order([0, 1, 2, 3, 4, 5, 6, 7, 8])
    (0, 8, 4, 2, 6, 1, 3, 5, 7)
    >>> bisection_order([0, 1, 2, 9, 10])  # by distance, not by number
    (0, 4, 2, 3, 1)
    """
    z = np.asarray(positions, dtype=float)
    order = [0, len(z) - 1]
    taken = sorted(order)
    while len(order) < len(z):
        gaps = [(z[b] - z[a], -a, b) for a, b in pairwise(taken) if b - a > 1]
        _, minus, right = max(gaps)
        left = -int(minus)
        inside = np.arange(left + 1, right)
        order.append(int(inside[np.argmin(np.abs(z[inside] - 0.5 * (z[left] + z[right])))]))
        taken = sorted(order)
    return tuple(order)


def section_counts(m: int) -> tuple[int, ...]:
    """Return how many sections are studied, from 2 to all `m`.

    Examples
    --------
    >>> section_counts(11)
    (2, 3, 4, 5, 6, 7, 8, 9, 10, 11)
    >>> section_counts(80)[-5:]
    (51, 57, 64, 72, 80)
    """
    counts = list(range(2, min(m, MOST) + 1))
    while counts[-1] < m:
        counts.append(min(m, counts[-1] + max(1, counts[-1] // 8)))
    return tuple(counts)
