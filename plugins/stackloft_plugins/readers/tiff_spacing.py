"""The voxel spacing that a TIFF carries: ImageJ's or OME's words, never the printer's resolution."""

from __future__ import annotations

import re
from typing import Any
from xml.etree.ElementTree import ParseError

from stackloft.model.lengths import MILLIMETRES
from stackloft_plugins.readers.block_spacing import FileSpacing

UNITS = {
    **MILLIMETRES,
    "micron": 1e-3,
    "microns": 1e-3,
    "inch": 25.4,
    "nm": 1e-6,
    "\\u00b5m": 1e-3,
    "pm": 1e-9,
}
"""Millimetres in one of ImageJ's and OME's units."""


def tiff_spacing(tiff: Any) -> FileSpacing:
    """Return what an open `tifffile.TiffFile` says of its voxels' size; nothing where it is silent.

    A resolution in dots per inch or centimetre is a printer's, and 72 by default; it is not read.
    """
    if tiff.is_imagej:
        return _imagej(tiff)
    return _ome(tiff.ome_metadata) if tiff.is_ome else FileSpacing()


def _imagej(tiff: Any) -> FileSpacing:
    said = tiff.imagej_metadata or {}
    factor = UNITS.get(str(said.get("unit", "")).strip().lower())
    if factor is None:
        return FileSpacing()
    tags = tiff.pages[0].tags
    sides = [_per_unit(tags.get(name)) for name in ("YResolution", "XResolution")]
    row, column = sides
    pixel = (row * factor, column * factor) if row and column else None
    pitch = said.get("spacing", 0)
    return FileSpacing(pixel, float(pitch) * factor if _positive(pitch) else None, "ImageJ")


def _per_unit(tag: Any) -> float | None:
    """Return the length of a pixel from pixels per unit, written as a fraction."""
    if tag is None:
        return None
    above, below = tag.value
    return float(below) / float(above) if above > 0 and below > 0 else None


def _ome(xml: str) -> FileSpacing:
    from xml.etree import ElementTree as ET  # noqa: PLC0415 - for OME files alone

    if re.search(r"<!(DOCTYPE|ENTITY)", xml):
        return FileSpacing()
    try:
        pixels = next((x for x in ET.fromstring(xml).iter() if x.tag.endswith("}Pixels")), None)
    except ParseError:
        return FileSpacing()
    if pixels is None:
        return FileSpacing()
    sides: list[float | None] = []
    for axis in "YXZ":
        size = pixels.get(f"PhysicalSize{axis}")
        factor = UNITS.get(pixels.get(f"PhysicalSize{axis}Unit", "um").replace("µ", "u").replace("μ", "u"))
        sides.append(float(size) * factor if size and factor and _positive(size) else None)
    row, column, pitch = sides
    return FileSpacing((row, column) if row and column else None, pitch, "OME")


def _positive(value: Any) -> bool:
    try:
        return 0 < float(value) < float("inf")
    except (TypeError, ValueError):
        return False
