"""Packages of parallel slices in a ParaVision scan, and where their frames are stored."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stackloft.model.arrays import IntArray
from stackloft.model.errors import InputError
from stackloft_plugins.readers.bruker_files import VISU
from stackloft_plugins.readers.dicom_series import PARALLEL
from stackloft_plugins.readers.visu_frames import VisuFrames


def packages_of(frames: VisuFrames, chosen: IntArray) -> list[IntArray]:
    """Return the frames of each package: slices that follow each other and are parallel."""
    turns = frames.axes[chosen, :2]
    apart = np.abs(np.diff(turns, axis=0)).max(axis=(1, 2)) > PARALLEL
    return list(np.split(chosen, np.flatnonzero(apart) + 1))


def stored_frames(
    frames: VisuFrames, chosen: IntArray, mine: IntArray, packages: int, folder: Path
) -> IntArray:
    """Return where the frames that are described lie in the file: elsewhere when slices are stored backwards.

    Raises
    ------
    InputError
        Backwards, with several packages: programs differ over what that means.
    """
    if not frames.backwards:
        return mine
    if packages > 1:
        raise InputError(
            "several packages of slices are stored backwards, and it is not settled which frame is which",
            where=str(folder / VISU),
            found="VisuCoreDiskSliceOrder=disk_reverse_slice_order",
            fix="export the scan as DICOM",
        )
    return chosen[::-1]
