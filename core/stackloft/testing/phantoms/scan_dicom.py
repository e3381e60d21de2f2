"""A scan as DICOM CT: one file for each slice, or one enhanced multi-frame file."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.files import write_whole
from stackloft.testing.phantoms.scan_volume import ScanVolume
from stackloft.testing.phantoms.structure_set import decimals

if TYPE_CHECKING:
    from pydicom import Dataset

SYNTAXES = {
    "explicit": "1.2.840.10008.1.2.1",
    "implicit": "1.2.840.10008.1.2",
    "big-endian": "1.2.840.10008.1.2.2",
    "deflated": "1.2.840.10008.1.2.1.99",
    "rle": "1.2.840.10008.1.2.5",
    "jpeg-ls": "1.2.840.10008.1.2.4.80",
    "jpeg-2000": "1.2.840.10008.1.2.4.90",
}
"""Name to Transfer Syntax UID."""
_ROOT = "1.2.826.0.1.3680043.8.498.20070"
_CT, _ENHANCED_CT = "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.5.1.4.1.1.2.1"
_INTERCEPT = -1024


def write_dicom(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``IM0001`` … (or ``IM0001`` alone, enhanced) without suffix; return the files.

    The files are numbered against the order of their positions, and the patient is called Phantom^Grey.

    Raises
    ------
    UsageError
        An unknown transfer syntax.
    """
    if volume.syntax not in SYNTAXES:
        raise UsageError(
            "unknown transfer syntax", where="syntax", found=volume.syntax, expected=", ".join(SYNTAXES)
        )
    if volume.multiframe:
        return [write_whole(folder / "IM0001", encoded(enhanced(volume), volume.syntax))]
    count = len(volume.slices)
    return [
        write_whole(folder / f"IM{count - k:04d}", encoded(classic(volume, k), volume.syntax))
        for k in range(count)
    ]


def classic(volume: ScanVolume, k: int) -> Dataset:
    """Return slice `k` as a CT image."""
    data = _image(volume, _CT, len(volume.slices) - k)
    data.ImagePositionPatient = decimals(volume.corner(k))
    data.ImageOrientationPatient = decimals(volume.turn.T[:2].ravel())
    data.PixelSpacing = decimals(np.array(volume.grid.spacing))
    data.SliceThickness = decimals(np.array([volume.grid.thickness]))[0]
    data.RescaleSlope, data.RescaleIntercept, data.RescaleType = "1", str(_INTERCEPT), "HU"
    data.PixelData = _stored(volume.slices[k]).tobytes()
    return data


def enhanced(volume: ScanVolume) -> Dataset:
    """Return the volume as one enhanced CT: orientation, spacing and scale shared, positions per frame."""
    from pydicom import Dataset, Sequence  # noqa: PLC0415 - slow to import, only where scans are written

    data = _image(volume, _ENHANCED_CT, 1)
    data.NumberOfFrames = len(volume.slices)
    shared, measures, plane, scale = Dataset(), Dataset(), Dataset(), Dataset()
    measures.PixelSpacing = decimals(np.array(volume.grid.spacing))
    measures.SliceThickness = decimals(np.array([volume.grid.thickness]))[0]
    plane.ImageOrientationPatient = decimals(volume.turn.T[:2].ravel())
    scale.RescaleSlope, scale.RescaleIntercept, scale.RescaleType = "1", str(_INTERCEPT), "HU"
    shared.PixelMeasuresSequence = Sequence([measures])
    shared.PlaneOrientationSequence = Sequence([plane])
    shared.PixelValueTransformationSequence = Sequence([scale])
    data.SharedFunctionalGroupsSequence = Sequence([shared])
    frames = []
    for k in range(len(volume.slices)):
        own, place = Dataset(), Dataset()
        place.ImagePositionPatient = decimals(volume.corner(k))
        own.PlanePositionSequence = Sequence([place])
        frames.append(own)
    data.PerFrameFunctionalGroupsSequence = Sequence(frames)
    data.PixelData = _stored(np.stack(volume.slices)).tobytes()
    return data


def encoded(data: Dataset, syntax: str = "explicit") -> bytes:
    """Return a data set as the content of a DICOM file in a transfer syntax named in `SYNTAXES`."""
    from pydicom.uid import UID  # noqa: PLC0415 - slow to import, only where scans are written

    uid = UID(SYNTAXES[syntax])
    data.file_meta.TransferSyntaxUID = UID(SYNTAXES["explicit"]) if uid.is_compressed else uid
    if uid.is_encapsulated:
        data.compress(uid, generate_instance_uid=False)
    elif syntax == "deflated":
        data.file_meta.TransferSyntaxUID = uid
    elif syntax == "big-endian":
        data.PixelData = np.frombuffer(data.PixelData, "<u2").astype(">u2").tobytes()
    stream = io.BytesIO()
    data.save_as(stream, enforce_file_format=True)
    return stream.getvalue()


def _image(volume: ScanVolume, sop_class: str, instance: int) -> Dataset:
    from pydicom import Dataset  # noqa: PLC0415 - slow to import, only where scans are written
    from pydicom.dataset import FileMetaDataset  # noqa: PLC0415
    from pydicom.uid import UID  # noqa: PLC0415

    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.SOPClassUID = data.file_meta.MediaStorageSOPClassUID = UID(sop_class)
    data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID = UID(f"{_ROOT}.1.{instance}")
    data.StudyInstanceUID, data.SeriesInstanceUID = f"{_ROOT}.2", f"{_ROOT}.3"
    data.FrameOfReferenceUID = f"{_ROOT}.4"
    data.PatientName, data.PatientID, data.PatientBirthDate = "Phantom^Grey", "PH-2007", "20070101"
    data.SeriesDescription = f"{volume.name} slabs"
    data.Modality, data.ImageType = "CT", ["ORIGINAL", "PRIMARY", "AXIAL"]
    data.SeriesNumber, data.InstanceNumber = 1, instance
    data.Rows, data.Columns = volume.grid.shape
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = 16, 16, 15, 0
    return data


def _stored(values: np.ndarray) -> np.ndarray:
    return np.clip(values.astype(np.int32) - _INTERCEPT, 0, 65535).astype("<u2")
