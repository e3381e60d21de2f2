r"""Slices that lie shifted, turned or scaled against each other, brought onto one lattice.

::

    slice k    /\/\/          +-+-+-+      The field is read, linearly, where the lattice's pixels lie in
               \/\/\    ->    +-+-+-+      the slice: what needs voxels one above the other (isosurface,
                              +-+-+-+      crofton) then sees the body as the contours do.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.ndimage import affine_transform

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.slice_stack import SliceStack, turn_matrix


def lattice_of(stack: SliceStack) -> SliceStack:
    """Return the stack as it is on its common lattice; the stack itself when it is one already.

    Pixel (0, 0) of the lattice lies at x = y = 0, and its pixels are the slices' mean ones.
    """
    if stack.origins is None and stack.turns is None:
        return stack
    spacing = np.broadcast_to(stack.pixel_spacing.mean(axis=0), stack.pixel_spacing.shape)
    return replace(stack, pixel_spacing=frozen_floats(spacing), origins=None, turns=None, marks=None)


def on_lattice(
    stack: SliceStack, index: int, field: FloatArray, first_pixel: tuple[int, int]
) -> tuple[FloatArray, tuple[int, int]]:
    """Return the field of slice `index` on the common lattice, and its first pixel there.

    Parameters
    ----------
    stack : SliceStack
        As it was read or aligned.
    index : int
    field : array (rows, columns)
    first_pixel : tuple of int
        (row, column) of the field's first pixel in the slice.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> stack = SliceStack(lambda k: np.zeros((4, 4)), ("a", "b"), (4, 4), np.arange(2.0), np.ones((2, 2)),
    ...                    SectionKind.FACE, origins=np.array([[0.0, 0.0], [2.0, 1.0]]))
    >>> moved, first = on_lattice(stack, 1, np.array([[1.0, 2.0], [3.0, 4.0]]), (0, 0))
    >>> first, moved.tolist()
    ((1, 2), [[1.0, 2.0], [3.0, 4.0]])
    """
    own = stack.pixel_spacing[index]
    common = stack.pixel_spacing.mean(axis=0)
    rows, columns = field.shape
    corners = np.array([[0, 0], [0, columns - 1], [rows - 1, 0], [rows - 1, columns - 1]]) + first_pixel
    placed = stack.placed(index, (corners * own)[:, ::-1])[:, ::-1] / common
    low = np.floor(np.round(placed.min(axis=0), 9)).astype(int)
    high = np.ceil(np.round(placed.max(axis=0), 9)).astype(int)
    turn = np.eye(2) if stack.turns is None else turn_matrix(float(stack.turns[index]))
    origin = np.zeros(2) if stack.origins is None else stack.origins[index][::-1]
    back = (turn.T)[::-1, ::-1] * common / own[:, None]  # (row, column) steps of the lattice in the slice's
    start = (turn.T)[::-1, ::-1] @ (low * common - origin) / own - first_pixel
    shape = (int(high[0] - low[0]) + 1, int(high[1] - low[1]) + 1)
    seen = affine_transform(field, back, start, output_shape=shape, order=1, mode="nearest")
    return np.asarray(seen, dtype=np.float64), (int(low[0]), int(low[1]))
