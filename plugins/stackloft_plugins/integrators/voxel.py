"""Voxel: the number of voxels in the body times a voxel's volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.contracts.sink import Sink
from stackloft.model.measurement import Integral
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.sectioning.clean_field import clean_field
from stackloft.sectioning.slabs import slab_sum
from stackloft.sectioning.streaming import streamed


@dataclass(frozen=True)
class Voxel:
    """Pixels above the level × pixel size × slice length, slice by slice; no area.

    Assumes that a pixel is body or not, and that each slice stands for the axis half-way to its neighbours.
    Unbiased in the plane for a body that lies at random on the pixels; across slices it errs as Cavalieri's
    rule does, by +1/(2m²) on an ellipsoid seen on m slices at mid-thickness, and high by half a slice per
    end where the outermost slices show the end faces themselves. The steps' own area (the sum of exposed
    voxel faces) would exceed a ball's by half and does not get better with finer voxels, so none is given.
    A label map is counted as it is; on grey slices crumbs are left out and glare filled as for contours.
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Segmentation,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def sink(self) -> Sink:
        """Return what takes the slices one by one and ends with the Integral."""
        return _VoxelSink()

    def integrate(self, product: Segmentation) -> Integral:
        """Return the volume, mm³; the area is None.

        Raises
        ------
        InputError
            No body on any slice; a single slice whose thickness nobody gave.
        """
        return streamed(product, self, Integral)


class _VoxelSink:
    """Counts."""

    looks_at_pictures = False

    def begin(self, segmentation: Segmentation) -> None:
        self._segmentation = segmentation
        self._counts = np.zeros(len(segmentation))

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002
        field = clean_field(section_field, labels=self._segmentation.binary)
        self._counts[index] = np.count_nonzero(field > 0)

    def end(self) -> Integral:
        stack = self._segmentation.stack
        volume, bias = slab_sum(self._counts * stack.pixel_spacing.prod(axis=1), stack)
        return Integral(volume, None, volume_bias=bias)
