"""One frame of a DICOM file: where it lies, how its numbers are stored; nothing about the patient."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from stackloft.model.arrays import FloatArray
from stackloft_plugins.readers.dicom_plain import PlainSamples


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One slice as its header describes it."""

    path: Path
    name: str
    """File name, with ``[k]`` after it for frame k of several."""
    number: int
    """Frame number in the file, from 0."""
    series: str
    """Series Instance UID; tells series apart, is never shown."""
    series_number: int | None
    modality: str
    order: tuple[int, ...]
    """Acquisition, temporal position, instance and frame number: which of several volumes is the first."""
    shape: tuple[int, int]
    samples: int
    position: FloatArray
    """(3) mm: Image Position (Patient), pixel (0, 0)'s centre."""
    axes: FloatArray
    """(2, 3) unit vectors of increasing column and of increasing row."""
    spacing: tuple[float, float]
    """(row, column) mm"""
    thickness: float | None
    """mm"""
    location: float | None
    """Slice Location, mm; only ever compared with the position."""
    slope: float
    intercept: float
    rescaled: bool
    """Whether the file gives slope and intercept."""
    inverted: bool
    """MONOCHROME1: low values are shown bright."""
    padding: tuple[int, int] | None
    """Stored values from … to … that stand for no measurement."""
    stored: tuple[int, int]
    """Least and greatest value that can be stored."""
    lookup: bool
    """A Modality LUT takes the place of slope and intercept."""
    syntax: str
    """Transfer Syntax UID."""
    localizer: bool
    private: tuple[tuple[str, str], ...] = ()
    """What is kept of the patient, where a person asked for it."""
    samples_at: PlainSamples | None = None
    """Where the stored values of a plain file lie; None: pydicom finds them."""
