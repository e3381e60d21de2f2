r"""A stack's field as one block of voxels, gathered slice by slice.

::

    slice k     +-----+             block of the crops' common rectangle, one pixel wider:
    slice k+1     +------+          background wherever a crop does not reach
                +--------+
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.sectioning.clean_field import clean_field
from stackloft.sectioning.common_lattice import lattice_of, on_lattice
from stackloft.sectioning.contour_sink import gathered

EVEN = 1e-3
"""Relative difference up to which steps of a lattice are taken for equal."""


@dataclass(frozen=True, slots=True, eq=False)
class FieldVolume:
    """The body as voxels."""

    values: NDArray[Any]
    """(slices, rows, columns): bool, True in the body; or float32 grey levels above the level."""
    first_pixel: tuple[int, int]
    """(row, column) of the block's first pixel in a slice; may be -1, as the block is wider than the body."""
    segmentation: Segmentation
    """Its stack is the block's lattice: slices shifted or turned against each other are brought onto it."""
    notices: tuple[Notice, ...] = ()

    def basis(self) -> FloatArray:
        """Return the lattice's steps along column, row and slice as columns of a (3, 3) matrix, bench mm.

        Raises
        ------
        InputError
            The slices are not evenly spaced, or differ in pixel size: then voxels form no lattice.
        """
        stack = self.segmentation.stack
        if len(stack) < 2:
            raise InputError("voxels need at least 2 slices", found=str(len(stack)))
        gaps, pixels = np.diff(stack.positions), stack.pixel_spacing
        for what, values in (("slices lie", gaps), ("pixels are", pixels)):
            if (np.ptp(values, axis=0) > EVEN * values.mean(axis=0)).any():
                raise InputError(
                    f"{what} unevenly spaced, so that the voxels form no lattice",
                    found=f"{values.min():g} to {values.max():g} mm",
                    fix="use --method loft or isosurface, which take the slices where they are",
                )
        row, column = pixels.mean(axis=0)
        return np.asarray(stack.affine[:3, :3] @ np.diag([column, row, gaps.mean()]))


class VolumeSink:
    """A `Sink` that gathers the volume and hands it to `finish`; refuses when it gets too large.

    Parameters
    ----------
    finish : callable
        FieldVolume to the sink's product.
    grey : bool
        True: grey levels (4 bytes a voxel); False: body or not (1 byte).
    limit : float
        Memory for the volume, MB; while a method works on it, it may need twice or three times as much.
    """

    looks_at_pictures = False

    def __init__(self, finish: Callable[[FieldVolume], Any], *, grey: bool, limit: float) -> None:
        self._finish = finish
        self._dtype = np.dtype(np.float32 if grey else np.bool_)
        self._limit = limit

    def begin(self, segmentation: Segmentation) -> None:
        """Get ready."""
        self._segmentation = segmentation
        self._lattice = lattice_of(segmentation.stack)
        self._crops: list[tuple[NDArray[Any], tuple[int, int]]] = []
        self._notices: list[Notice] = []
        self._lowest = 0.0

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002 - a Sink
        """Take one slice.

        Raises
        ------
        InputError
            The volume has outgrown its limit.
        """
        field = clean_field(section_field, labels=self._segmentation.binary)
        self._lowest = min(self._lowest, float(np.median(_frame(field))))
        row, column = section_field.offset
        first = (row - 1, column - 1)
        if self._lattice is self._segmentation.stack:
            crop = bordered(field).astype(np.float32) if self._dtype == np.float32 else np.pad(field > 0, 1)
        else:
            grey, first = on_lattice(self._segmentation.stack, index, bordered(field), first)
            crop = grey.astype(np.float32) if self._dtype == np.float32 else grey > 0
        self._crops.append((crop, first))
        self._notices += section_field.notices
        self._check_memory()

    def end(self) -> Any:
        """Return what `finish` makes of the volume.

        Raises
        ------
        InputError
            There is no body on any slice.
        """
        top, left, bottom, right = self._rectangle()
        background = False if self._dtype == np.bool_ else self._lowest
        shape = (len(self._crops), bottom - top, right - left)
        block = np.full(shape, background, dtype=self._dtype)
        for plane, (crop, (row, column)) in zip(block, self._crops, strict=True):
            rows, columns = crop.shape
            plane[row - top : row - top + rows, column - left : column - left + columns] = crop
        self._crops = []
        if not (block > 0).any():
            raise InputError("nothing in the slices is above the level: there is no body")
        segmentation = replace(self._segmentation, stack=self._lattice)
        return self._finish(FieldVolume(block, (top, left), segmentation, gathered(self._notices)))

    def _rectangle(self) -> tuple[int, int, int, int]:
        """Return top, left, bottom and right of all crops together."""
        corners = [(row, column, row + c.shape[0], column + c.shape[1]) for c, (row, column) in self._crops]
        low, high = np.min(corners, axis=0), np.max(corners, axis=0)
        return int(low[0]), int(low[1]), int(high[2]), int(high[3])

    def _check_memory(self) -> None:
        top, left, bottom, right = self._rectangle()
        size = (bottom - top) * (right - left) * len(self._segmentation) * self._dtype.itemsize / 1e6
        if size > self._limit:
            raise InputError(
                "the method needs the whole volume, which is larger than the memory it may take",
                found=f"{size:.0f} MB",
                expected=f"at most {self._limit:g} MB",
                fix="raise the method's option memory, or use a method that takes slice by slice "
                "(loft, voxel, partial-volume)",
            )


def bordered(field: FloatArray) -> FloatArray:
    """Return the field inside a border that mirrors its outermost values to the background's side.

    A body cut by the edge of what was seen is thereby closed half a step beyond it.

    Examples
    --------
    >>> bordered(np.array([[3.0]]))
    array([[-3., -3., -3.],
           [-3.,  3., -3.],
           [-3., -3., -3.]])
    """
    wide = np.pad(field, 1, mode="edge")
    for axis in range(wide.ndim):
        for face in (0, -1):
            border = np.moveaxis(wide, axis, 0)[face]
            np.copyto(border, -np.abs(border))
    return np.asarray(wide)


def _frame(field: FloatArray) -> FloatArray:
    return np.concatenate([field[0], field[-1], field[:, 0], field[:, -1]])
