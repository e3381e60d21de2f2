r"""What is wrong with the order of sections, if supposing so makes them smooth.

::

    as given   swapped    one missing    one doubled    an outlier
    * . .      . . *      * . . _ . *    . . * * . .    . . * . .      The change that makes a rough sequence
     .  *  →   * . .                                                   smooth, and no other, is what happened.

Every supposition is one change of the sequence; its gain is the roughness as given by the roughness so
changed. A body with a kink is rough whatever is supposed; a smooth one is smooth as given: in both the gain
stays near 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.roughness import FEWEST, roughness

FloatArray = NDArray[np.float64]
Change = Literal["swapped", "moved", "missing", "doubled", "outlier"]

_FURTHEST_MOVE = 40  # sections in a stack in which every section is tried at every place


@dataclass(frozen=True, slots=True)
class Supposition:
    """One change and what it gains."""

    change: Change
    first: int
    """The section's number: the one that is moved, left out or doubled, or the one before the gap."""
    second: int
    """The other one: swapped with, moved to, or after the gap."""
    gain: float
    """Roughness as given by roughness as changed, both with the noise's own added."""


def best_supposition(
    position: FloatArray, values: FloatArray, noise: float, longest_step: float
) -> Supposition | None:
    """Return the one change that makes the sequence smoothest; None for too few sections.

    Parameters
    ----------
    position : array (m)
        mm
    values : array (m, n)
        What changes smoothly from section to section.
    noise : float
        Standard deviation of one section's values, all n together: no gain is sought below it.
    longest_step : float
        The pitch that a missing section leaves, or a doubled one takes, mm.

    Examples
    --------
    >>> z = np.arange(10.0)
    >>> values = (90 - (z - 4.5) ** 2)[:, None]
    >>> values[[6, 7]] = values[[7, 6]]
    >>> best_supposition(z, values, 0.1, 1.0).change
    'swapped'
    """
    if len(position) < FEWEST:
        return None
    given = roughness(position, values) + noise**2
    found = [
        Supposition(change, first, second, given / (roughness(z, changed) + noise**2))
        for change, first, second, z, changed in _changes(position, values, longest_step)
        if len(z) >= FEWEST - 1
    ]
    return max(found, key=lambda one: one.gain) if found else None


def _changes(
    position: FloatArray, values: FloatArray, step: float
) -> Iterator[tuple[Change, int, int, FloatArray, FloatArray]]:
    m = len(position)
    everywhere = m <= _FURTHEST_MOVE
    for k in range(m):
        for other in range(k + 1, m if everywhere else min(m, k + 3)):
            yield "swapped", k, other, position, _swapped(values, k, other)
        for place in range(m) if everywhere else range(max(0, k - 4), min(m, k + 5)):
            if abs(place - k) > 1:
                yield "moved", k, place, position, _moved(values, k, place)
        if 0 < k < m - 1:
            yield "outlier", k, k, np.delete(position, k), np.delete(values, k, axis=0)
    for k in range(1, m - 2):
        beyond = np.arange(m) > k
        yield "missing", k, k + 1, position + step * beyond, values
    for k in range(m - 1):
        beyond = np.arange(m) > k
        closer = np.delete(position - step * beyond, k + 1)
        if (np.diff(closer) > 0).all():  # unequal cuts may leave no room for it
            yield "doubled", k, k + 1, closer, np.delete(values, k + 1, axis=0)


def _swapped(values: FloatArray, k: int, other: int) -> FloatArray:
    changed = values.copy()
    changed[[k, other]] = changed[[other, k]]
    return changed


def _moved(values: FloatArray, k: int, place: int) -> FloatArray:
    return np.insert(np.delete(values, k, axis=0), place, values[k], axis=0)
