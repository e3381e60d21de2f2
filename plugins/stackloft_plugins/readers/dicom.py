"""DICOM series: CT, MR and the like, from any scanner.

::

    folder/                     n = normal of the slices      z_k = n · Image Position (Patient)
      IM0007   z = 35.0              ^    ____
      IM0001   z =  5.0              |   /___/  z_2           order, pitch and tilt come from the
      IM0004   z = 20.0              |  /___/   z_1           positions alone; file names, instance
      sub/…                          | /___/    z_0           numbers and spacing tags place nothing

Only the elements that place and scale the pixels are read; what is private stays in the files.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft_plugins.readers.dicom_codecs import check_decoder
from stackloft_plugins.readers.dicom_files import dicom_files, seems_dicom
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_frames import read_frames
from stackloft_plugins.readers.dicom_location import check_locations
from stackloft_plugins.readers.dicom_objects import without_objects
from stackloft_plugins.readers.dicom_pixels import decode_frame
from stackloft_plugins.readers.dicom_series import (
    Series,
    choose_series,
    label,
    one_shape,
    one_volume,
    series_of,
)
from stackloft_plugins.readers.dicom_together import plain_pictures
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.slab_notices import slab_notices
from stackloft_plugins.readers.slice_geometry import Placed, place_slices

_CONFIDENCE = 0.9


@dataclass(frozen=True, slots=True)
class DicomReader:
    """Reads a DICOM series into a `SliceStack` of slabs; slices are decoded on demand.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> folder = Path(tempfile.mkdtemp())
    >>> ball = phantoms.make("ellipsoid", a=20, b=20, c=20)
    >>> _ = phantoms.Scans(form="dicom", sections=5, pixel_size=2.0).write(ball, folder)
    >>> stack = DicomReader().read(folder)
    >>> len(stack), stack.kind.value, stack.decode(2).dtype.kind
    (7, 'slab', 'i')
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)

    series: str = option(
        "", "which series: its number, #N for the Nth listed, or its UID; the largest when empty"
    )
    volume: int | None = option(
        None, "which of several volumes at the same places (echoes, time points), from 1", ge=1
    )
    allow_gaps: bool = option(False, "keep a gap that looks like a missing slice")
    leave_out: bool = option(
        False, "leave out localizers and slices whose orientation, size or spacing differs from most"
    )
    keep_identifiers: bool = option(
        False, "keep patient's name and number and the descriptions in what is written"
    )
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.9 when the file, or one of the first below the folder, begins as DICOM; 0 otherwise."""
        try:
            return _CONFIDENCE if seems_dicom(path) else 0.0
        except (OSError, ValueError):
            return 0.0

    def read(self, path: Path) -> SliceStack:
        """Return the stack; headers are read here, pixels when a slice is asked for.

        Parameters
        ----------
        path : Path
            A folder (with what is below it), a file of many frames, a pattern, or a DICOMDIR.

        Raises
        ------
        InputError
            Damaged files; no position; missing, duplicate or mixed slices; several volumes at the same
            places; a mosaic; no decoder. Files, what was found and what was expected are named.
        """
        pictures, drawn = without_objects(dicom_files(path))
        every = series_of(list(read_frames(pictures, keep_identifiers=self.keep_identifiers)))
        chosen, several = choose_series(every, self.series, str(path))
        shaped, left_out = one_shape(chosen, leave_out=self.leave_out)
        frames, one = one_volume(shaped, self.volume)
        check_locations(frames)
        thickness = _thickness(frames)
        placed = _placed(frames, thickness, path, allow_gaps=self.allow_gaps)
        ordered = tuple(frames[k] for k in placed.order)
        for syntax, frame in {frame.syntax: frame for frame in ordered}.items():
            check_decoder(syntax, frame.path)
        slabs = None if thickness is None else frozen_floats(thickness[placed.order])
        notices = (*drawn, *several, *left_out, *one, *placed.notices, *slab_notices(placed.positions, slabs))
        stack = self._stack(ordered, placed, slabs, notices, label(every, chosen), path)
        return with_scale(stack, self.scale_uncertainty, path)

    def _stack(
        self,
        frames: Series,
        placed: Placed,
        slabs: FloatArray | None,
        notices: tuple[Notice, ...],
        series: str,
        path: Path,
    ) -> SliceStack:
        folder = path if path.is_dir() else path.parent
        return SliceStack(
            decode=_Decoder(frames),
            names=tuple(frame.name for frame in frames),
            shape=frames[0].shape,
            positions=placed.positions,
            pixel_spacing=frozen_floats([frame.spacing for frame in frames]),
            kind=SectionKind.SLAB,
            thickness=slabs,
            affine=placed.affine,
            hints=load_stack_file(folder).hints(folder, {k: k for k in range(1, len(frames) + 1)}),
            notices=notices,
            provenance={
                "positions": "Image Position (Patient) along the normal",
                "pixel size": "Pixel Spacing",
                "series": f"{series} ({frames[0].modality})" if frames[0].modality else series,
                "grey scale": _scale(frames[0]),
                **dict(frames[0].private),
            },
        )


class _Decoder:
    """Decodes one frame, or gets some ready together."""

    def __init__(self, frames: Series) -> None:
        self.frames = frames
        self._ready: dict[int, Picture] = {}

    def __call__(self, number: int) -> Picture:
        ready = self._ready.pop(number, None)
        return decode_frame(self.frames[number]) if ready is None else ready

    @property
    def slow(self) -> bool:
        """Whether some pixels are compressed."""
        return any(frame.samples_at is None for frame in self.frames)

    def prefetch(self, numbers: Sequence[int]) -> None:
        """Read together those whose pixels lie in the files as they are."""
        self._ready = plain_pictures({number: self.frames[number] for number in numbers})

    @property
    def at_hand(self) -> bool:
        """Whether all pixels lie in the files as they are."""
        return all(frame.samples_at is not None for frame in self.frames)


def _thickness(frames: Series) -> FloatArray | None:
    known = [frame.thickness for frame in frames if frame.thickness is not None]
    return np.array(known) if len(known) == len(frames) else None


def _placed(frames: Series, thickness: FloatArray | None, path: Path, *, allow_gaps: bool) -> Placed:
    if len(frames) < 2:
        raise InputError(
            "one slice makes no body",
            where=str(path),
            found=frames[0].name,
            expected="at least 2 slices, better 12 or more",
            fix="give the folder of the whole series" if path.is_file() else "",
        )
    return place_slices(
        np.array([frame.position for frame in frames]),
        frames[0].axes,
        [frame.name for frame in frames],
        thickness,
        min(frames[0].spacing),
        allow_gaps=allow_gaps,
    )


def _scale(frame: Frame) -> str:
    if frame.lookup:
        return "Modality LUT"
    if frame.rescaled:
        return "HU" if frame.modality == "CT" else "rescaled, slice by slice"
    return "stored values, MONOCHROME1 turned over" if frame.inverted else "stored values"
