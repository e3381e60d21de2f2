"""A scan's body as a DICOM segmentation: binary from a label map, else fractional; written by highdicom."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stackloft.testing.phantoms.files import write_whole
from stackloft.testing.phantoms.scan_volume import ScanVolume

if TYPE_CHECKING:
    from pydicom import Dataset

_ROOT = "1.2.826.0.1.3680043.8.498.20072"
_MOST = 200
"""What stands for a whole pixel in a fractional segmentation."""


def write_dicom_seg(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``SEG0001`` with one segment, called as the phantom is; return it in a list.

    A label map gives a binary segmentation; grey levels give a fractional one (occupancy), clipped between
    those of air and body. Slices on which the segment is empty are left out, as is usual.
    """
    values = np.stack(volume.slices)
    if volume.label:
        return [write_whole(folder / "SEG0001", segmentation(volume, (values > 0)[..., None], [volume.name]))]
    air, body = volume.levels
    share = np.clip((values - air) / (body - air), 0.0, 1.0)
    return [
        write_whole(folder / "SEG0001", segmentation(volume, share[..., None], [volume.name], "FRACTIONAL"))
    ]


def segmentation(
    volume: ScanVolume, masks: Any, names: list[str], kind: str = "BINARY", **more: Any
) -> bytes:
    """Return a segmentation as the content of a DICOM file.

    Parameters
    ----------
    volume : ScanVolume
        Where the slices lie.
    masks : ndarray, (slices, rows, columns, segments)
        Of bool, or of 0 … 1 for a fractional one.
    names : list of str
        Segment labels.
    kind : {"BINARY", "FRACTIONAL", "LABELMAP"}
    **more
        As `highdicom.seg.Segmentation` takes it, for example ``omit_empty_frames=False``.
    """
    from highdicom.seg import Segmentation  # noqa: PLC0415 - slow to import, only where scans are written

    own: dict[str, Any] = {"fractional_type": "OCCUPANCY", "max_fractional_value": _MOST}
    data = Segmentation(
        source_images=[_source(volume, k) for k in range(len(volume.slices))],
        pixel_array=np.ascontiguousarray(masks, dtype=np.float32 if kind == "FRACTIONAL" else np.uint8),
        segmentation_type=kind,
        segment_descriptions=[_description(number, name) for number, name in enumerate(names, start=1)],
        series_instance_uid=f"{_ROOT}.3",
        series_number=2,
        sop_instance_uid=f"{_ROOT}.1",
        instance_number=1,
        manufacturer="stackloft",
        manufacturer_model_name="phantom",
        software_versions="1",
        device_serial_number="1",
        **(own if kind == "FRACTIONAL" else {}),
        **more,
    )
    stream = io.BytesIO()
    data.save_as(stream, enforce_file_format=True)
    return stream.getvalue()


def _source(volume: ScanVolume, k: int) -> Dataset:
    """Return slice `k` as the picture that the segmentation was made on."""
    from pydicom.uid import ExplicitVRLittleEndian  # noqa: PLC0415

    from stackloft.testing.phantoms.scan_dicom import classic  # noqa: PLC0415 - as highdicom above

    data = classic(volume, k)
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    for keyword in (
        "StudyID",
        "AccessionNumber",
        "StudyDate",
        "StudyTime",
        "PatientSex",
        "ReferringPhysicianName",
    ):
        setattr(data, keyword, "")
    return data


def _description(number: int, name: str) -> Any:
    from highdicom import AlgorithmIdentificationSequence  # noqa: PLC0415 - slow to import
    from highdicom.seg import SegmentDescription  # noqa: PLC0415
    from pydicom.sr.codedict import codes  # noqa: PLC0415

    return SegmentDescription(
        segment_number=number,
        segment_label=name,
        segmented_property_category=codes.SCT.MorphologicallyAbnormalStructure,
        segmented_property_type=codes.SCT.Neoplasm,
        algorithm_type="AUTOMATIC",
        algorithm_identification=AlgorithmIdentificationSequence(
            "exact", codes.DCM.ArtificialIntelligence, "1"
        ),
    )
