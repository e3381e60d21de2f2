"""A scan as one multi-page TIFF with ImageJ's spacing."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from stackloft.testing.phantoms.files import write_whole
from stackloft.testing.phantoms.scan_volume import ScanVolume

LIFT = 1024
"""Added to HU, because ImageJ's 16 bits have no sign."""


def write_tiff(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``scan.tif``; return it in a list."""
    import tifffile  # noqa: PLC0415 - only where scans are written

    row, column = volume.grid.spacing
    values = np.stack(volume.slices)
    lifted = values.astype(np.uint8) if volume.label else (values.astype(np.int32) + LIFT).astype(np.uint16)
    stream = io.BytesIO()
    tifffile.imwrite(
        stream,
        lifted,
        imagej=True,
        resolution=(1.0 / column, 1.0 / row),
        metadata={"spacing": volume.pitch(), "unit": "mm", "axes": "ZYX"},
    )
    return [write_whole(folder / "scan.tif", stream.getvalue())]
