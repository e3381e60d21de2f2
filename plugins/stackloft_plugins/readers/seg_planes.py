r"""The planes of a DICOM segmentation, with those put back that were left out because they are empty.

::

    z   0   2   4   .   .   10   12         gaps of 2, 2, 6, 2: the gap of 6 is three usual ones, so that two
        f1  f2  f3  -   -   f4   f5         planes without a frame lie in it; what is not there is empty
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft.sectioning.object_choice import KIND, OBJECT, OBJECTS
from stackloft_plugins.readers.dicom_series import one_shape
from stackloft_plugins.readers.seg_file import (
    FRACTIONAL,
    LABEL_MAP,
    FramePixels,
    SegmentFrames,
    plane_of_frames,
)
from stackloft_plugins.readers.slab_notices import slab_notices
from stackloft_plugins.readers.slice_geometry import Placed, normal_of, place_slices

_WHOLE = 0.05
"""How far a gap may be from a whole number of usual gaps and still be slices left out."""
_MOST_PLANES = 10_000


@dataclass(frozen=True, slots=True, eq=False)
class SegmentPlanes:
    """Where the planes lie, and which frames are on each."""

    path: Path
    content: SegmentFrames
    pixels: FramePixels
    placed: Placed
    frames: tuple[dict[int, int], ...]
    """Of each plane, in order: segment number (0 in a label map) to frame number."""
    thickness: float | None

    def label(self, number: int) -> str:
        """Return a segment's number, and its label where that may be shown."""
        name = self.content.labels[number]
        return f"{number} ({name})" if name else str(number)

    def picture(self, plane: int, number: int) -> Picture:
        """Return a segment's pixels on a plane: 0 and 1, or fractions as they are stored."""
        own = self.frames[plane].get(0 if self.content.kind == LABEL_MAP else number)
        if own is None:
            return np.zeros(self.content.frames[0].shape, dtype=np.uint8)
        stored = self.pixels(own)
        return (stored == number).astype(np.uint8) if self.content.kind == LABEL_MAP else stored

    def size(self, number: int) -> float:
        """Return the sum of a segment's pixels, weighted by the gaps beside their planes."""
        weights = np.gradient(self.placed.positions)
        sums = [
            float(self.picture(k, number).sum(dtype=np.float64)) if number in owners or 0 in owners else 0.0
            for k, owners in enumerate(self.frames)
        ]
        return float(weights @ np.array(sums))

    def stack(self, number: int, notices: tuple[Notice, ...]) -> SliceStack:
        """Return the planes as slices that show one segment."""
        folder = self.path.parent
        count, first = len(self.frames), self.content.frames[0]
        slabs = None if self.thickness is None else frozen_floats(np.full(count, self.thickness))
        every = sorted(self.content.labels)
        scale = {FRACTIONAL: f"fraction ({self.content.fractional.lower()}), boundary at a half"}
        return SliceStack(
            decode=lambda plane: self.picture(plane, number),
            names=tuple(f"{self.path.name}[{k + 1}]" for k in range(count)),
            shape=first.shape,
            positions=self.placed.positions,
            pixel_spacing=frozen_floats(np.tile(first.spacing, (count, 1))),
            kind=SectionKind.SLAB,
            thickness=slabs,
            affine=self.placed.affine,
            hints=load_stack_file(folder).hints(folder, {}),
            notices=(*notices, *self.placed.notices, *slab_notices(self.placed.positions, slabs)),
            provenance={
                "positions": "Image Position (Patient) along the normal",
                "pixel size": "Pixel Spacing",
                "grey scale": scale.get(self.content.kind, f"{self.content.kind.lower()} segments"),
                "segment": self.label(number),
                OBJECT: str(number),
                OBJECTS: ",".join(map(str, every)),
                KIND: "segment",
                **dict(self.content.private),
            },
        )


def segment_planes(content: SegmentFrames, path: Path) -> SegmentPlanes:
    """Return the planes with those put back that were left out because they are empty.

    Raises
    ------
    InputError
        Frames of several orientations, two frames of one segment on one plane, or one plane alone.
    """
    frames = content.frames
    one_shape(frames, leave_out=False)
    groups = plane_of_frames(frames, normal_of(frames[0].axes))
    if len(groups) < 2:
        raise InputError("one slice makes no body", where=str(path), found="segments on one plane")
    owners = []
    for group in groups:
        own = {content.owners[k]: k for k in group}
        if len(own) < len(group):
            raise InputError(
                "two frames of one segment lie on one plane",
                where=str(path),
                found=", ".join(f"frame {k + 1}" for k in group[:4]),
                expected="one frame of each segment on each plane",
            )
        owners.append(own)
    points = np.array([frames[group[0]].position for group in groups])
    points, kept = _with_empty(points, normal_of(frames[0].axes), path)
    names = [f"{path.name}[{k + 1}]" for k in range(len(points))]
    slab = frames[0].thickness
    thickness = None if slab is None else np.full(len(points), slab)
    placed = place_slices(points, frames[0].axes, names, thickness, min(frames[0].spacing), allow_gaps=True)
    own_frames: list[dict[int, int]] = [{} for _ in points]
    for place, own in zip(kept, owners, strict=True):
        own_frames[place] = own
    return SegmentPlanes(path, content, FramePixels(path, frames[0].shape), placed, tuple(own_frames), slab)


def _with_empty(points: FloatArray, normal: FloatArray, path: Path) -> tuple[FloatArray, list[int]]:
    """Return the planes' places with those of empty planes between them, and where the given ones are.

    A gap that is a whole number of usual gaps holds planes that were left out.

    Raises
    ------
    InputError
        A plane lies impossibly far from the others.
    """
    gaps = np.diff(points @ normal)
    usual = float(np.quantile(gaps, 0.25))
    if not gaps.sum() < _MOST_PLANES * usual:
        raise InputError(
            "is damaged: a plane lies impossibly far from the others",
            where=str(path),
            found=f"{gaps.max():.4g} mm",
            expected=f"{usual:.4g} mm as between others",
        )
    steps = np.round(gaps / usual)
    steps = np.where(np.abs(gaps / usual - steps) <= _WHOLE, np.maximum(steps, 1), 1).astype(int)
    filled = [points[:1]]
    for k, count in enumerate(steps):
        shares = np.arange(1, count + 1)[:, None] / count
        filled.append(points[k] + shares * (points[k + 1] - points[k]))
    return np.concatenate(filled), [0, *np.cumsum(steps).tolist()]
