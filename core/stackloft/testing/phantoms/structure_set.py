"""Exact sections as a DICOM structure set (RTSTRUCT), anywhere in patient space."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Section
from stackloft.testing.phantoms.answer import answer
from stackloft.testing.phantoms.files import made_folder, write_json, write_whole
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.placing import Placing
from stackloft.testing.phantoms.pose import rotation_matrix

if TYPE_CHECKING:
    from pydicom import Dataset

_RTSTRUCT = "1.2.840.10008.5.1.4.1.1.481.3"
_ROOT = "1.2.826.0.1.3680043.8.498.20071"


@dataclass(frozen=True, slots=True)
class StructureSet:
    """How a phantom's exact sections are written as a structure set.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> files = StructureSet(sections=3).write(phantoms.make("box"), Path(tempfile.mkdtemp()))
    >>> [file.name for file in files]
    ['RS0001', 'answer.json']
    """

    sections: int = 11
    placing: Placing | tuple[float, ...] = "mid"
    points: int = 400
    """About how many points a loop gets."""
    cosines: int | None = None
    """A seed of the planes' orientation in patient space; None: axial."""
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """mm: where the bench's origin lies in patient space."""

    def write(self, phantom: Phantom, folder: Path) -> list[Path]:
        """Write ``RS0001`` and ``answer.json`` into `folder`; return them.

        The region is called as the phantom is; the patient is called Phantom^Grey.

        Raises
        ------
        UsageError
            An option that does not suit the body.
        OutputError
            The system refuses; no half-written file is left.
        """
        stack = phantom.contour_stack(self.sections, self.placing, self.points)
        turn = np.eye(3) if self.cosines is None else rotation_matrix(self.cosines)
        data = structure_set()
        add_region(data, 1, phantom.name, space_curves(stack.sections, turn, np.array(self.origin)))
        made_folder(folder)
        return [
            write_whole(folder / "RS0001", structure_bytes(data)),
            write_json(folder / "answer.json", answer(phantom, stack.positions)),
        ]


def space_curves(sections: tuple[Section, ...], turn: FloatArray, origin: FloatArray) -> list[FloatArray]:
    """Return every loop's points in patient millimetres, (k, 3) each."""
    return [
        np.column_stack([loop.points, np.full(len(loop.points), section.z)]) @ turn.T + origin
        for section in sections
        for loop in section.loops
    ]


def structure_set() -> Dataset:
    """Return a structure set without regions."""
    from pydicom import Dataset, Sequence  # noqa: PLC0415 - slow to import, only where scans are written
    from pydicom.dataset import FileMetaDataset  # noqa: PLC0415
    from pydicom.uid import UID, ExplicitVRLittleEndian  # noqa: PLC0415

    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data.SOPClassUID = data.file_meta.MediaStorageSOPClassUID = UID(_RTSTRUCT)
    data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID = UID(f"{_ROOT}.1")
    data.StudyInstanceUID, data.SeriesInstanceUID = f"{_ROOT}.2", f"{_ROOT}.3"
    data.Modality, data.StructureSetLabel = "RTSTRUCT", "sections"
    data.PatientName, data.PatientID, data.PatientBirthDate = "Phantom^Grey", "PH-2007", "20070101"
    data.StructureSetROISequence, data.ROIContourSequence = Sequence(), Sequence()
    return data


def add_region(
    data: Dataset, number: int, name: str, curves: list[FloatArray], kind: str = "CLOSED_PLANAR"
) -> None:
    """Add a region to a structure set; `curves` are (k, 3) in patient millimetres."""
    from pydicom import Dataset, Sequence  # noqa: PLC0415 - slow to import, only where scans are written

    listed, drawn = Dataset(), Dataset()
    listed.ROINumber, listed.ROIName, listed.ROIGenerationAlgorithm = number, name, "MANUAL"
    listed.ReferencedFrameOfReferenceUID = f"{_ROOT}.4"
    drawn.ReferencedROINumber, drawn.ContourSequence = number, Sequence()
    for points in curves:
        contour = Dataset()
        contour.ContourGeometricType, contour.NumberOfContourPoints = kind, len(points)
        contour.ContourData = decimals(points.ravel())
        drawn.ContourSequence.append(contour)
    data.StructureSetROISequence.append(listed)
    data.ROIContourSequence.append(drawn)


def structure_bytes(data: Dataset) -> bytes:
    """Return a structure set as the content of a DICOM file."""
    stream = io.BytesIO()
    data.save_as(stream, enforce_file_format=True)
    return stream.getvalue()


def decimals(values: FloatArray) -> list[str]:
    """Return the numbers as DICOM's decimal strings of at most 16 characters."""
    from pydicom.valuerep import format_number_as_ds  # noqa: PLC0415 - slow to import

    return [format_number_as_ds(float(value)) for value in values]
