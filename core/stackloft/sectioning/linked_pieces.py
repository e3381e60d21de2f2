r"""Pieces of slices linked into three-dimensional objects, one slice at a time (Rosenfeld & Pfaltz 1966).

::

    slice k      [ 1 ]   [ 2 ]        pieces of one slice that overlap pieces of the next one
    slice k+1      [ 3 ]  |           are one object: {1, 3}, {2, 4}
    slice k+2             [ 4 ]       (no overlap between slices: not linked)
"""

from __future__ import annotations

import zlib

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, FloatArray, IntArray

Pieces = NDArray[np.int32]
"""(rows, columns) number of the piece that a pixel belongs to, from 1; 0: none"""


class LinkedPieces:
    """Takes one slice's pieces after the other; at the end says which of them are one object.

    Parameters
    ----------
    share : float
        Least part of the smaller of two pieces that must overlap to link them; 0: one pixel.

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
        self._packed: list[tuple[bytes, tuple[int, int]]] = []
        self._last: Pieces | None = None

    def add(self, pieces: Pieces, sizes: FloatArray, labels: IntArray | None = None) -> None:
        """Take a slice's pieces, numbered 1 … n, the size of each and its label; only equal labels link."""
        start = len(self._parents)
        self._starts.append(start)
        self._parents += range(start, start + len(sizes))
        self._labels.append(np.zeros(len(sizes), dtype=np.int64) if labels is None else labels)
        self._sizes.append(np.asarray(sizes, dtype=np.float64))
        if self._last is not None and len(sizes):
            before = self._starts[-2]
            for a, b in self._linking(self._last, pieces):
                if self._labels[-2][a - 1] == self._labels[-1][b - 1]:
                    self._join(before + a - 1, start + b - 1)
        self._last = pieces
        self._packed.append((zlib.compress(pieces.tobytes(), 1), (pieces.shape[0], pieces.shape[1])))

    def __len__(self) -> int:
        return len(self._packed)

    def pieces(self, number: int) -> Pieces:
        """Return the pieces of a slice, as they were taken."""
        packed, shape = self._packed[number]
        return np.frombuffer(zlib.decompress(packed), dtype=np.int32).reshape(shape)

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

    def _linking(self, a: Pieces, b: Pieces) -> IntArray:
        pairs, shared = overlaps(a, b)
        if not self._share or not len(pairs):
            return pairs
        areas = np.bincount(a.ravel())[pairs[:, 0]], np.bincount(b.ravel())[pairs[:, 1]]
        return np.asarray(pairs[shared >= self._share * np.minimum(*areas)])

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
    if not both.any():
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    width = int(b.max()) + 1
    pairs, shared = np.unique(a[both].astype(np.int64) * width + b[both], return_counts=True)
    return np.column_stack([pairs // width, pairs % width]), shared.astype(np.int64)


def pieces_of(mask: BoolArray, connectivity: int = 4) -> tuple[Pieces, IntArray]:
    """Return the connected pieces of a slice's mask and their sizes in pixels."""
    _, pieces, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(pieces, np.int32), np.asarray(stats[1:, cv2.CC_STAT_AREA], np.int64)
