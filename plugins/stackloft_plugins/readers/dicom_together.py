"""Frames whose pixels lie in their files as they are, read together by the compiled kernels."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from stackloft.compiled.reading import Part, read_parts
from stackloft.model.arrays import read_only
from stackloft.model.reused_memory import SLICE, empty
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_pixels import fits_short


def plain_pictures(frames: Mapping[int, Frame]) -> dict[int, Picture]:
    """Return the pictures of those frames that are plain, by number, as `decode_frame` gives them.

    Others, and what is damaged, are left to it; all of them, without compiled kernels.
    """
    shifts = {number: _shift(frame) for number, frame in frames.items()}
    parts = {number: _part(frames[number], shift) for number, shift in shifts.items() if shift is not None}
    ends = read_parts(list(parts.values()))
    if ends is None:
        return {}
    found: dict[int, Picture] = {}
    for (number, part), read in zip(parts.items(), ends, strict=True):
        if read is None or (part.shift and not fits_short(*read, part.shift)):
            continue
        found[number] = read_only(part.to.view(np.int16) if part.shift else part.to)
    return found


def _shift(frame: Frame) -> int | None:
    """Return what is to be added to a frame's stored values; None where more has to be done."""
    samples = frame.samples_at
    plain = (
        samples is not None
        and not samples.spare
        and frame.samples == 1
        and frame.padding is None
        and not frame.lookup
        and (frame.rescaled or not frame.inverted)
        and frame.slope == 1.0
        and frame.intercept == round(frame.intercept)
        and abs(frame.intercept) < 2**15
    )
    if not plain or samples is None:
        return None
    kind = np.dtype(samples.dtype)
    shift = round(frame.intercept)
    return shift if kind.isnative and (not shift or kind.itemsize == 2) else None


def _part(frame: Frame, shift: int) -> Part:
    samples = frame.samples_at
    if samples is None:
        raise TypeError(frame.name)
    return Part(Path(frame.path), samples.at, empty(frame.shape, samples.dtype, SLICE), shift)
