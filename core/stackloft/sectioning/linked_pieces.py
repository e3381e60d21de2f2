r"""Pieces of slices linked into three-dimensional objects, one slice at a time (Rosenfeld & Pfaltz 1966).

::

    slice k      [ 1 ]   [ 2 ]        pieces of one slice that overlap pieces of the next one
    slice k+1      [ 3 ]  |           are one object: {1, 3}, {2, 4}
    slice k+2             [ 4 ]       (no overlap between slices: not linked)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.sectioning.slice_pieces import Corner, Pieces

_NO_STARTS: NDArray[np.int32] = np.zeros(0, np.int32)
_ONE_PAIR: IntArray = np.ones((1, 2), dtype=np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class _Runs:
    """A slice's pieces as runs of equal numbers."""

    starts: NDArray[np.int32]
    numbers: NDArray[Any]
    shape: tuple[int, int]
    corner: Corner

    @staticmethod
    def of(pieces: Pieces, corner: Corner) -> _Runs:
        if not pieces.size:
            return _Runs(_NO_STARTS, pieces.ravel(), (pieces.shape[0], pieces.shape[1]), corner)
        flat = pieces.ravel()
        starts = np.concatenate([[0], np.flatnonzero(flat[1:] != flat[:-1]) + 1])[: flat.size]
        return _Runs(starts.astype(np.int32), flat[starts], (pieces.shape[0], pieces.shape[1]), corner)

    def pieces(self) -> Pieces:
        size = self.shape[0] * self.shape[1]
        return np.repeat(self.numbers, np.diff(self.starts, append=size)).reshape(self.shape)


@dataclass(frozen=True, slots=True, eq=False)
class _Outlined:
    """A slice's one piece without a hole, as its outline."""

    outline: NDArray[np.int32]
    shape: tuple[int, int]
    corner: Corner

    def pieces(self) -> Pieces:
        canvas = np.zeros(self.shape, np.uint8)
        cv2.drawContours(canvas, [self.outline - np.array(self.corner[::-1], np.int32)], -1, 1, cv2.FILLED)
        return canvas


class LinkedPieces:
    """Takes one slice's pieces after the other; at the end says which of them are one object.

    Parameters
    ----------
    share : float
        Least part of the smaller of two pieces that must overlap to link them, sizes being pixels; 0: one
        pixel.

    Examples
    --------
    >>> links = LinkedPieces()
    >>> for row in ([1, 1, 0, 2], [0, 1, 0, 0], [1, 0, 0, 2]):
    ...     links.add(np.array([row], dtype=np.int32), np.ones(max(row)))
    >>> links.objects().tolist()            # of pieces 1 2 | 1 | 1 2
    [0, 1, 0, 2, 3]
    """

    def __init__(self, share: float = 0.0) -> None:
        self._share = share
        self._parents: list[int] = []
        self._starts: list[int] = []
        self._sizes: list[FloatArray] = []
        self._labels: list[IntArray] = []
        self._runs: list[_Runs | _Outlined] = []
        self._last: tuple[Pieces, Corner] | None = None

    def add(
        self,
        pieces: Pieces,
        sizes: FloatArray,
        labels: IntArray | None = None,
        corner: Corner = (0, 0),
        before: tuple[Pieces, Corner] | None = None,
        outline: NDArray[np.int32] | None = None,
    ) -> None:
        """Take a slice's pieces, numbered 1 … n, the size of each and its label; only equal labels link.

        The pieces may be a crop of the slice whose first pixel lies at `corner`; `before` is another crop
        of the slice before, where the one that was given then was too narrow. An `outline`, as a
        `SectionField` has it, says that there is one piece without a hole.
        """
        if before is not None:
            self._last = before
        start = len(self._parents)
        self._starts.append(start)
        self._parents += range(start, start + len(sizes))
        self._labels.append(np.zeros(len(sizes), dtype=np.int64) if labels is None else labels)
        self._sizes.append(np.asarray(sizes, dtype=np.float64))
        if self._last is not None and len(sizes) and pieces.size and self._last[0].size:
            earlier = self._starts[-2]
            alone = outline is not None and before is None and isinstance(self._runs[-1], _Outlined)
            for a, b in self._linking(*_common(self._last, (pieces, corner)), alone=alone):
                if self._labels[-2][a - 1] == self._labels[-1][b - 1]:
                    self._join(earlier + a - 1, start + b - 1)
        self._last = (pieces, corner)
        shape = (pieces.shape[0], pieces.shape[1])
        self._runs.append(_Runs.of(pieces, corner) if outline is None else _Outlined(outline, shape, corner))

    def __len__(self) -> int:
        return len(self._runs)

    def pieces(self, number: int) -> tuple[Pieces, Corner]:
        """Return the pieces of a slice, as they were taken, and the crop's corner."""
        runs = self._runs[number]
        return runs.pieces(), runs.corner

    def shape(self, number: int) -> tuple[Corner, tuple[int, int]]:
        """Return the corner and the shape of a slice's crop."""
        return self._runs[number].corner, self._runs[number].shape

    def labels(self) -> IntArray:
        """Return every piece's label."""
        return np.concatenate(self._labels) if self._labels else np.zeros(0, dtype=np.int64)

    def of_slice(self, number: int) -> slice:
        """Return where a slice's pieces are among all pieces."""
        start = self._starts[number]
        return slice(start, start + len(self._sizes[number]))

    def sizes(self) -> FloatArray:
        """Return every piece's size."""
        return np.concatenate(self._sizes) if self._sizes else np.zeros(0)

    def objects(self) -> IntArray:
        """Return every piece's object, numbered from 0 in the order in which they appear."""
        roots = np.array([self._root(k) for k in range(len(self._parents))], dtype=np.int64)
        _, first, number = np.unique(roots, return_index=True, return_inverse=True)
        return np.argsort(np.argsort(first))[number] if len(roots) else roots

    def _linking(self, a: Pieces, b: Pieces, *, alone: bool) -> IntArray:
        """Return the linked pairs (piece of `a`, piece of `b`) of two slices' common part.

        `alone`: both show one piece, so that one pixel that they share, in a middle row mostly, tells.
        """
        if alone and not self._share and len(a) and (a[len(a) // 2] & b[len(b) // 2]).any():
            return _ONE_PAIR
        pairs, shared = overlaps(a, b)
        if not self._share or not len(pairs):
            return pairs
        before, after = self._sizes[-2][pairs[:, 0] - 1], self._sizes[-1][pairs[:, 1] - 1]
        return np.asarray(pairs[shared >= self._share * np.minimum(before, after)])

    def _join(self, a: int, b: int) -> None:
        first, second = self._root(a), self._root(b)
        self._parents[max(first, second)] = min(first, second)

    def _root(self, k: int) -> int:
        while self._parents[k] != k:
            self._parents[k] = self._parents[self._parents[k]]
            k = self._parents[k]
        return k


def overlaps(a: Pieces, b: Pieces) -> tuple[IntArray, IntArray]:
    """Return the pairs of pieces (of `a`, of `b`) that share pixels, (n, 2), and how many they share, (n).

    Examples
    --------
    >>> pairs, shared = overlaps(np.array([[1, 2, 2]], np.int32), np.array([[3, 3, 0]], np.int32))
    >>> pairs.tolist(), shared.tolist()
    ([[1, 3], [2, 3]], [1, 1])
    """
    both = (a > 0) & (b > 0)
    shared = int(np.count_nonzero(both))
    if not shared:
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    if a.dtype == b.dtype == np.uint8 and a.max() == b.max() == 1:  # two slices of one piece each
        return _ONE_PAIR, np.array([shared])
    first, second = a[both].astype(np.int64), b[both].astype(np.int64)
    width = int(second.max()) + 1
    pairs, counts = np.unique(first * width + second, return_counts=True)
    return np.column_stack([pairs // width, pairs % width]), counts.astype(np.int64)


def _common(first: tuple[Pieces, Corner], second: tuple[Pieces, Corner]) -> tuple[Pieces, Pieces]:
    """Return the parts of two crops that lie over each other."""
    (a, (a_row, a_column)), (b, (b_row, b_column)) = first, second
    top, left = max(a_row, b_row), max(a_column, b_column)
    bottom = max(top, min(a_row + a.shape[0], b_row + b.shape[0]))
    right = max(left, min(a_column + a.shape[1], b_column + b.shape[1]))
    return (
        a[top - a_row : bottom - a_row, left - a_column : right - a_column],
        b[top - b_row : bottom - b_row, left - b_column : right - b_column],
    )
