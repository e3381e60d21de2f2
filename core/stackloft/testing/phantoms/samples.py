"""The stacks in ``sample_stacks/``, made by ``python -m stackloft.testing.phantoms.samples sample_stacks``.

Their sizes follow Table 1 of Goñi, Purlis & Salvadori (2007): an apple in 15 slices, a piece of meat in 11
slices of 16 mm.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.writing import write_phantom

SAMPLES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "apple": {
            "parameters": {"diameter": 85.0, "flatness": 0.97},
            "rotation": (0.0, 0.0, 12.0),
            "sections": 15,
            "pixel_size": 0.21,
            "plate": "black",
            "seed": 4,
            "tell": ("kind", "pixel_size", "thickness", "height", "background", "specimen"),
        },
        "meat": {
            "parameters": {"length": 176.0},
            "rotation": (0.0, 0.0, -8.0),
            "sections": 11,
            "placing": "faces",
            "pixel_size": 0.24,
            "plate": "white",
            "seed": 7,
            "tell": ("kind", "pixel_size", "thickness", "ends", "height", "background", "specimen"),
        },
    }
)
"""Phantom name, which is also the folder's, to the options of `write_phantom`."""


def write_samples(folder: Path) -> list[Path]:
    """Write every sample stack as realistic JPEG photographs into its own folder under `folder`.

    The same version of this package writes the same bodies and exact answers; the JPEG bytes may differ
    between versions of the encoder.

    Examples
    --------
    >>> sorted(SAMPLES)
    ['apple', 'meat']
    """
    files = []
    for name, options in SAMPLES.items():
        files += write_phantom(name, "photos", folder / name, realistic=True, suffix="jpg", **options)
    return files


def main(arguments: list[str]) -> None:
    """Write the samples into the one folder named on the command line."""
    if len(arguments) != 1:
        raise UsageError("one folder is needed", where="samples", found=" ".join(arguments) or "nothing")
    write_samples(Path(arguments[0]))


if __name__ == "__main__":
    main(sys.argv[1:])
