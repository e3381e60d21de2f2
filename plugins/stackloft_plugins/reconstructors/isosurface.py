"""Isosurface: the level's surface through the voxels, by flying edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.contracts.sink import Sink
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.bias import Bias
from stackloft.model.errors import InputError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.model.tri_mesh import TriMesh
from stackloft.sectioning.field_volume import FieldVolume, VolumeSink
from stackloft.sectioning.slabs import slab_sum
from stackloft.sectioning.streaming import streamed
from stackloft_plugins.reconstructors.flying_edges import zero_surface

_RATIOS = np.array([1.0, 1.5, 2.0, 3.0, 5.0, 10.0])
_LOWEST = np.array([4.0, 4.0, 4.0, 6.0, 8.0, 16.0])
_HIGHEST = np.array([9.5, 13.0, 15.5, 20.0, 27.0, 31.0])
"""%: area of a label map's surface against the truth, by pitch over pixel size. The range over poses of
balls and of ellipsoids 1 : 0.4 : 0.3 at 20 and more slices across (measured, ``tests/reconstructors``), with
room below for maps drawn by hand, whose outlines keep to the voxels (+6.5 % on a banana)."""


@dataclass(frozen=True)
class Isosurface:
    """The surface on which the grey level, linear between voxels, equals the level (Lorensen & Cline 1987).

    Slices are taken where they are: uneven positions, pixel sizes and a sheared affine are honoured. The
    block is padded, so that the surface closes; a body that the stack cuts off is closed half a step beyond.
    Assumes that grey levels follow the distance to the boundary over about a voxel, as in a scan whose blur
    is no smaller than its voxels. Where slices are much further apart than that (photographs of cuts), the
    surface has steps between them and its area errs high. On a label map it always does, by 8.8 % at cubic
    voxels and more on others, however fine they are; such a surface is marked as biased.
    """

    memory: float = option(2000.0, "largest volume held in memory", unit="MB", gt=0)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Segmentation,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)
    needs_volume: ClassVar[bool] = True

    def sink(self) -> Sink:
        """Return what gathers the voxels and ends with the surface."""
        return VolumeSink(_surface, grey=True, limit=self.memory)

    def reconstruct(self, product: Segmentation) -> TriMesh:
        """Return the closed surface in bench millimetres.

        Raises
        ------
        InputError
            No body on any slice, or a volume above ``memory``.
        """
        return streamed(product, self, TriMesh)


def _surface(volume: FieldVolume) -> TriMesh:
    stack = volume.segmentation.stack
    closed = np.concatenate([_lid(volume.values[0]), volume.values, _lid(volume.values[-1])])
    grid, faces = zero_surface(closed)
    vertices = _placed(grid - [0.0, 0.0, 1.0], volume.first_pixel, stack)
    if np.linalg.det(stack.affine[:3, :3]) < 0.0:
        faces = faces[:, ::-1]
    steps = _step_bias(volume.segmentation)
    counts = np.count_nonzero(volume.values > 0, axis=(1, 2)) * stack.pixel_spacing.prod(axis=1)
    return TriMesh(
        frozen_floats(vertices),
        frozen_ints(faces),
        biased=steps.reason if steps and volume.segmentation.binary else None,
        volume_bias=slab_sum(counts, stack)[1],
        area_bias=steps,
        notices=volume.notices,
    )


def _lid(plane: FloatArray) -> FloatArray:
    """Return the plane beyond an outermost slice: its values mirrored to the background's side."""
    return -np.abs(plane)[None]


def _placed(grid: FloatArray, first_pixel: tuple[int, int], stack: SliceStack) -> FloatArray:
    """Return grid points (column, row, slice) as bench millimetres."""
    z = stack.positions
    ends = np.diff(z)[[0, -1]] if len(z) > 1 else np.full(2, _single_thickness(stack))
    slices = np.arange(-1, len(z) + 1)
    height = np.interp(grid[:, 2], slices, np.concatenate([[z[0] - ends[0]], z, [z[-1] + ends[1]]]))
    origins = np.zeros((len(z), 2)) if stack.origins is None else stack.origins
    per_slice = np.concatenate([stack.pixel_spacing, origins], axis=1).T
    row, column, left, top = (np.interp(grid[:, 2], slices[1:-1], values) for values in per_slice)
    points = np.column_stack(
        [left + (grid[:, 0] + first_pixel[1]) * column, top + (grid[:, 1] + first_pixel[0]) * row, height]
    )
    return np.asarray(points @ stack.affine[:3, :3].T + stack.affine[:3, 3])


def _single_thickness(stack: SliceStack) -> float:
    if stack.thickness is None:
        raise InputError("a single slice has no thickness", found="1 slice", fix="give --thickness")
    return float(stack.thickness[0])


def _step_bias(segmentation: Segmentation) -> Bias | None:
    """Return how far off the area is by steps between voxels; None for a scan's grey levels.

    A label map has steps all over; photographed cuts have them between slices alone, as nothing is grey
    there.
    """
    stack = segmentation.stack
    if not segmentation.binary and stack.kind is SectionKind.SLAB:
        return None
    pitch = np.diff(stack.positions).mean() if len(stack) > 1 else _single_thickness(stack)
    spacings = np.array([*stack.pixel_spacing.mean(axis=0), pitch])
    ratio = float(spacings.max() / spacings.min())
    low, high = float(np.interp(ratio, _RATIOS, _LOWEST)), float(np.interp(ratio, _RATIOS, _HIGHEST))
    if not segmentation.binary:
        return Bias(-1.0, high, "the surface has steps between slices, which are far apart for their pixels")
    reason = (
        f"the surface of a label map is stair-stepped: its area is {low:.0f} to {high:.0f} % high at voxels"
        f" {ratio:.3g} : 1, however fine they are; use crofton or loft for the area"
    )
    return Bias(low, high, reason)
