"""From a DICOM file's elements to its frames: classic, or with shared and per-frame functional groups."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_lookup import Lookup
from stackloft_plugins.readers.dicom_plain import PlainHeader
from stackloft_plugins.readers.dicom_values import number_of, positive_of, word_of, words_of

if TYPE_CHECKING:
    from pydicom import Dataset

IMPLICIT_LITTLE = "1.2.840.10008.1.2"
MOST_SAMPLES = 1 << 27
"""Samples of one frame; more is taken for damage."""
PRIVATE = ("PatientName", "PatientID", "StudyDescription", "SeriesDescription")
"""Read with the option ``keep_identifiers`` alone."""
KEYWORDS = (
    *("ImageType", "Modality", "SOPClassUID", "SeriesInstanceUID", "SeriesNumber", "AcquisitionNumber"),
    *("InstanceNumber", "TemporalPositionIdentifier", "ImagePositionPatient", "ImageOrientationPatient"),
    *("SliceLocation", "SliceThickness", "PixelSpacing", "SamplesPerPixel", "PhotometricInterpretation"),
    *("PlanarConfiguration", "NumberOfFrames", "Rows", "Columns", "BitsAllocated", "BitsStored", "HighBit"),
    *("PixelRepresentation", "PixelPaddingValue", "PixelPaddingRangeLimit", "RescaleIntercept"),
    *("RescaleSlope", "RescaleType", "ModalityLUTSequence", "SharedFunctionalGroupsSequence"),
    "PerFrameFunctionalGroupsSequence",
)
"""The elements that are read; names, birth dates and free text are not among them."""


def frames_of(
    data: Dataset | PlainHeader, path: Path, *, keep_identifiers: bool = False
) -> tuple[Frame, ...]:
    """Return the frames that a file's header describes.

    Raises
    ------
    InputError
        It has no pixels, is a mosaic, or lacks position, orientation or pixel spacing.
    """
    _check_image(data, path)
    count = int(data.get("NumberOfFrames") or 1)
    groups = data.get("PerFrameFunctionalGroupsSequence")
    if count > 1 and (groups is None or len(groups) != count):
        raise _lacking(path, "a position for each of its frames", "functional groups of all frames")
    common = _common(data, path, keep_identifiers=keep_identifiers)
    if not groups:
        return (_placed(common, Lookup(data, ()), 0, path.name),)
    shared = tuple(data.get("SharedFunctionalGroupsSequence") or ())[:1]
    name = f"{path.name}[{{}}]" if count > 1 else path.name
    return tuple(
        _placed(common, Lookup(data, (own, *shared)), k, name.format(k + 1)) for k, own in enumerate(groups)
    )


def _common(data: Dataset | PlainHeader, path: Path, *, keep_identifiers: bool) -> Frame:
    """Return what all frames of a file share; the place is filled in by `_placed`."""
    bits, signed = int(data.get("BitsStored")), bool(data.get("PixelRepresentation", 0))
    number = data.get("SeriesNumber")
    kept = [(key, str(data.get(key))) for key in PRIVATE if data.get(key)] if keep_identifiers else []
    return Frame(
        path=path,
        name=path.name,
        number=0,
        series=str(data.get("SeriesInstanceUID", "")),
        series_number=None if number in {None, ""} else int(number),
        modality=word_of(data.get("Modality")),
        order=(),
        shape=(int(data.get("Rows")), int(data.get("Columns"))),
        samples=int(data.get("SamplesPerPixel", 1)),
        position=np.zeros(3),
        axes=np.zeros((2, 3)),
        spacing=(0.0, 0.0),
        thickness=None,
        location=None,
        slope=1.0,
        intercept=0.0,
        rescaled=False,
        inverted=data.get("PhotometricInterpretation") == "MONOCHROME1",
        padding=_padding(data),
        stored=(-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1),
        lookup=bool(data.get("ModalityLUTSequence")),
        syntax=str(data.file_meta.get("TransferSyntaxUID", IMPLICIT_LITTLE)),
        localizer="LOCALIZER" in words_of(data.get("ImageType")),
        private=tuple(kept),
    )


def _placed(common: Frame, lookup: Lookup, number: int, name: str) -> Frame:
    """Return frame `number` with its own place and scale.

    Raises
    ------
    InputError
        Position, orientation or pixel spacing is missing or impossible.
    """
    position = lookup.floats("PlanePositionSequence", "ImagePositionPatient", 3)
    cosines = lookup.floats("PlaneOrientationSequence", "ImageOrientationPatient", 6)
    spacing = lookup.floats("PixelMeasuresSequence", "PixelSpacing", 2)
    for value, what in (
        (position, "Image Position (Patient)"),
        (cosines, "Image Orientation (Patient)"),
        (spacing, "Pixel Spacing"),
    ):
        if value is None:
            raise _lacking(common.path, what, f"{what}, without which nothing can be measured")
    assert position is not None and cosines is not None and spacing is not None  # noqa: PT018
    if not ((spacing > 1e-6) & (spacing < 1e4)).all():
        raise InputError("impossible Pixel Spacing", where=str(common.path), found=f"{spacing} mm")
    slope = lookup.floats("PixelValueTransformationSequence", "RescaleSlope", 1)
    intercept = lookup.floats("PixelValueTransformationSequence", "RescaleIntercept", 1)
    if slope is not None and slope[0] == 0:
        raise InputError("Rescale Slope is 0", where=str(common.path), expected="a number other than 0")
    return replace(
        common,
        name=name,
        number=number,
        order=(*order_of(lookup), number),
        position=frozen_floats(position),
        axes=_axes(cosines, common.path),
        spacing=(float(spacing[0]), float(spacing[1])),
        thickness=positive_of(lookup.get("PixelMeasuresSequence", "SliceThickness")),
        location=location_of(lookup),
        slope=1.0 if slope is None else float(slope[0]),
        intercept=0.0 if intercept is None else float(intercept[0]),
        rescaled=slope is not None or intercept is not None,
    )


def _axes(cosines: FloatArray, path: Path) -> FloatArray:
    """Return the two unit vectors, made exactly perpendicular."""
    axes = _perpendicular(tuple(cosines.tolist()))
    if axes is None:
        raise InputError(
            "Image Orientation (Patient) is no pair of perpendicular unit vectors",
            where=str(path),
            found=", ".join(f"{value:g}" for value in cosines),
        )
    return axes


@lru_cache
def _perpendicular(cosines: tuple[float, ...]) -> FloatArray | None:
    """Return two unit vectors near the given ones; None when those are far from being such."""
    row, column = np.array(cosines).reshape(2, 3)
    lengths = np.linalg.norm(row), np.linalg.norm(column)
    if not np.allclose(lengths, 1.0, atol=0.02) or abs(row @ column) > 0.02:
        return None
    row = row / lengths[0]
    column = column - (column @ row) * row
    return frozen_floats([row, column / np.linalg.norm(column)])


def _check_image(data: Dataset | PlainHeader, path: Path) -> None:
    missing = [key for key in ("Rows", "Columns", "BitsAllocated", "BitsStored") if not data.get(key)]
    if missing:
        raise _lacking(path, f"{missing[0]}: it holds no picture", "image files alone")
    if "MOSAIC" in words_of(data.get("ImageType")):
        raise InputError(
            "is a Siemens mosaic: many slices tiled in one picture, whose places are in private elements",
            where=str(path),
            found="MOSAIC in Image Type",
            fix="convert it with dcm2niix and read the NIfTI file, or export as enhanced multi-frame",
        )
    rows, columns, stored, allocated = (
        int(data.get(key)) for key in ("Rows", "Columns", "BitsStored", "BitsAllocated")
    )
    samples = rows * columns * int(data.get("SamplesPerPixel") or 1)
    if samples > MOST_SAMPLES or stored > allocated or allocated > 64:
        raise InputError(
            "is damaged: its header claims an impossible picture",
            where=str(path),
            found=f"{columns} × {rows} pixels, {stored} of {allocated} bits",
        )


def _padding(data: Dataset | PlainHeader) -> tuple[int, int] | None:
    value = data.get("PixelPaddingValue")
    if value is None or value == "":
        return None
    limit = data.get("PixelPaddingRangeLimit")
    ends = [int(value), int(value if limit in {None, ""} else limit)]
    if data.get("PixelRepresentation"):  # often written as if unsigned
        half = 1 << int(data.get("BitsAllocated")) - 1
        ends = [end - 2 * half if end >= half else end for end in ends]
    return min(ends), max(ends)


def location_of(lookup: Lookup) -> float | None:
    """Return a frame's Slice Location, mm."""
    return number_of(lookup.get("PixelMeasuresSequence", "SliceLocation"))


def order_of(lookup: Lookup) -> tuple[int, ...]:
    """Return what tells which of several volumes a frame belongs to, but for its number in the file."""
    values = (
        lookup.get("FrameContentSequence", "FrameAcquisitionNumber") or lookup.get("", "AcquisitionNumber"),
        lookup.get("FrameContentSequence", "TemporalPositionIndex")
        or lookup.get("", "TemporalPositionIdentifier"),
        lookup.get("", "InstanceNumber"),
    )
    return tuple(int(value or 0) for value in values)


def _lacking(path: Path, what: str, expected: str) -> InputError:
    return InputError(f"has no {what}", where=str(path), expected=expected)
