"""Slice Location as a witness: it places nothing, but where it contradicts one slice alone, one is wrong."""

from __future__ import annotations

import numpy as np

from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.slice_geometry import normal_of

_AGREE = 0.02
"""mm by which Slice Location may differ from the position, once it agrees elsewhere."""
_MOST_AGREE = 0.7


def check_locations(frames: tuple[Frame, ...]) -> None:
    """Refuse a slice whose position contradicts its Slice Location where those of the others agree.

    Slice Location places nothing; but where one slice alone disagrees with it, one of the two is damaged.

    Raises
    ------
    InputError
        The slice is named.
    """
    said = [(frame, frame.location) for frame in frames if frame.location is not None]
    if len(said) < 4 or len(said) < len(frames):
        return
    normal = normal_of(frames[0].axes)
    along = np.array([frame.position for frame, _ in said]) @ normal
    told = np.array([location for _, location in said])
    for sign in (1.0, -1.0):
        off = told - sign * along
        off -= np.median(off)
        agree = np.abs(off) <= _AGREE
        if _MOST_AGREE <= agree.mean() < 1:
            worst = int(np.argmax(np.abs(off)))
            raise InputError(
                "position and Slice Location contradict each other",
                where=str(said[worst][0].path),
                found=f"{abs(off[worst]):.3g} mm apart",
                expected="agreement, as in the other slices",
                fix="the file is damaged: copy it again from the scanner",
            )
