"""NRRD, MetaImage (MHA, MHD) and NIfTI volumes, by SimpleITK, with their affines."""

from __future__ import annotations

import gzip
import threading
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.array_axis import AXES, MEMORY
from stackloft.sectioning.object_choice import LARGEST
from stackloft_plugins.readers.itk_header import ItkHeader, form_of, read_header
from stackloft_plugins.readers.label_map import CHOICES, as_labels
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack

_CONFIDENCE = 0.9
_BLOCK = 1 << 20
_SUFFIXES = {"NRRD": "NrrdImageIO", "MetaImage": "MetaImageIO", "NIfTI": "NiftiImageIO"}


@dataclass(frozen=True, slots=True)
class ItkReader:
    """Reads one volume file into a `SliceStack`, or a `Segmentation` where it is a label map.

    Uncompressed NRRD and MetaImage are read slice by slice; the others when the first slice is asked for.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> cone = phantoms.make("cone")
    >>> scanner = phantoms.Scans(form="nrrd", sections=5, pixel_size=2.0)
    >>> len(ItkReader().read(scanner.write(cone, Path(tempfile.mkdtemp()))[0]))
    7
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack, Segmentation)

    labels: str = option("auto", "whether the values are labels of bodies", choices=CHOICES)
    object: str = option(LARGEST, "label maps: which body, largest or its label")
    axis: str = option("0", "label maps: the array's axis that sections are taken across", choices=AXES)
    memory: float = option(MEMORY, "what another axis than 0 may take for the whole map", unit="MB", gt=0)
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.9 for a file that begins as NRRD, MetaImage or NIfTI, packed by gzip or not."""
        try:
            return _CONFIDENCE if path.is_file() and form_of(path) else 0.0
        except OSError:
            return 0.0

    def read(self, path: Path) -> SliceStack | Segmentation:
        """Return the stack, or the segmentation of a label map.

        Raises
        ------
        InputError
            Damaged, not three-dimensional, without a spacing, or of a unit that is not known.
        """
        header = read_header(path)
        if not header.spaced:
            raise InputError(
                "says no voxel spacing",
                where=str(path),
                expected="spacings in the header",
                fix="write them there, or read the array with --reader numpy and its spacing options",
            )
        volume = _Volume(path, header)
        told = {"positions": f"{header.form} header", "pixel size": f"{header.form} header"}
        stack = volume_stack(volume.grid(), volume, path, told, _unit_notice(header, path))
        known = with_scale(stack, self.scale_uncertainty, path)
        return as_labels(known, self.labels, self.object, self.axis, self.memory)


class _Volume:
    """A file's slices: each read alone where the format allows, else all at the first call."""

    def __init__(self, path: Path, header: ItkHeader) -> None:
        self._path = path
        self._header = header
        self._lock = threading.Lock()
        self._whole: Any = None
        self._reader = self._informed()

    def grid(self) -> VoxelGrid:
        """Return where the voxels lie."""
        reader = self._reader
        columns, rows, slices = reader.GetSize()[:3]
        column, row, pitch = (side * self._header.factor for side in reader.GetSpacing()[:3])
        dimension = reader.GetDimension()
        direction = np.array(reader.GetDirection()).reshape(dimension, dimension)[:3, :3]
        return VoxelGrid(
            shape=(slices, rows, columns),
            spacing=(row, column),
            positions=pitch * np.arange(slices),
            origin=self._header.factor * np.array(reader.GetOrigin()[:3]),
            direction=direction,
        )

    def __call__(self, number: int) -> Picture:
        """Return one slice; safe to call from several threads."""
        if self._header.streamed:
            return read_only(self._extracted(number))
        with self._lock:
            if self._whole is None:
                self._check_packing()
                self._whole = self._array(self._informed())
                self._whole = self._whole.reshape(self._whole.shape[-3:])
        return read_only(self._whole[number])

    def _check_packing(self) -> None:
        """Refuse a gzip file that is cut off: ITK's NIfTI reader would fill in what is missing."""
        with self._path.open("rb") as stream:
            packed = stream.read(2) == b"\x1f\x8b"
        if not packed:
            return
        try:
            with gzip.open(self._path) as stream:
                while stream.read(_BLOCK):
                    pass
        except (OSError, EOFError, zlib.error) as error:
            raise self._damaged("its voxels") from error

    def _extracted(self, number: int) -> Picture:
        reader = self._informed()
        columns, rows, *_ = reader.GetSize()
        reader.SetExtractIndex([0, 0, number, *[0] * (reader.GetDimension() - 3)])
        reader.SetExtractSize([columns, rows, 1, *[1] * (reader.GetDimension() - 3)])
        picture: Picture = self._array(reader).reshape(rows, columns)
        return picture

    def _array(self, reader: Any) -> Any:
        try:
            return _sitk().GetArrayFromImage(reader.Execute())
        except (RuntimeError, MemoryError) as error:
            raise self._damaged("its voxels") from error

    def _informed(self) -> Any:
        """Return a reader that has read the header.

        Raises
        ------
        InputError
            Damaged, or no volume of single numbers.
        """
        reader = _sitk().ImageFileReader()
        reader.SetFileName(str(self._path))
        reader.SetImageIO(_SUFFIXES[self._header.form])
        try:
            reader.ReadImageInformation()
        except RuntimeError as error:
            raise self._damaged("its header") from error
        size = reader.GetSize()
        if len(size) < 3 or any(side != 1 for side in size[3:]) or reader.GetNumberOfComponents() != 1:
            found = f"{' × '.join(map(str, size))}, {reader.GetNumberOfComponents()} numbers per voxel"
            raise InputError(
                "is no volume of grey levels", where=str(self._path), found=found, expected="three dimensions"
            )
        return reader

    def _damaged(self, what: str) -> InputError:
        return InputError(
            f"is damaged: {what} cannot be read", where=str(self._path), fix="copy it again from its source"
        )


def _sitk() -> Any:
    """Return SimpleITK, its warnings kept off the terminal."""
    import SimpleITK  # noqa: PLC0415 - slow to import, needed where volumes are read

    SimpleITK.ProcessObject.GlobalWarningDisplayOff()  # type: ignore[no-untyped-call]
    return SimpleITK


def _unit_notice(header: ItkHeader, path: Path) -> tuple[Notice, ...]:
    if header.form != "NIfTI" or header.unit is not None:
        return ()
    return (Notice("unit-unknown", f"{path.name} names no unit of length; its numbers are taken for mm"),)
