"""Slowly varying brightness divided out of a scan (MR surface coils), by N4.

The field is estimated on a coarse copy of the scan (at most 64 pixels and 32 slices a side), in which it is
as smooth as in the scan itself, and interpolated where a slice is decoded; the whole scan is never in memory.

Source: Tustison et al. (2010), N4ITK: improved N3 bias correction, IEEE Trans. Med. Imaging 29:1310.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, read_only
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft_plugins.segmenters.grey import Grey, grey_levels
from stackloft_plugins.segmenters.slab_level import frame_of

_SIDE, _SLICES = 64, 32
_RIM, _LEAST = 2, 0.2
_ITERATIONS = (50, 50, 40, 30)


def bias_corrected(stack: SliceStack, channel: str) -> SliceStack:
    """Return the stack with its brightness evened out; grey levels count from the air's.

    Raises
    ------
    InputError
        There is nothing brighter than the air, or N4 finds no field.
    """
    import SimpleITK as sitk  # noqa: N813, PLC0415 - slow to import, used on request

    numbers = np.unique(np.linspace(0, len(stack) - 1, min(len(stack), _SLICES)).astype(int))
    pictures = [grey_levels(stack.decode(int(k)), channel) for k in numbers]
    air = float(np.median(np.concatenate([frame_of(grey) for grey in pictures])))
    coarse = np.stack([_shrunk(grey) for grey in pictures]) - np.float32(air)
    if not (coarse > 0).any():
        raise InputError(
            "has nothing brighter than its air to correct", where=f"{stack.names[0]} … {stack.names[-1]}"
        )
    image = sitk.GetImageFromArray(np.maximum(coarse, 0.0))
    mask = _inside(sitk.OtsuThreshold(image, 0, 1, 200))  # type: ignore[no-untyped-call]
    field = np.exp(_log_field(image, mask, stack))
    field /= float(np.median(field[sitk.GetArrayFromImage(mask) > 0]))
    low, high = (float(np.quantile(field, share)) for share in (0.01, 0.99))
    text = f"brightness that varied from {low:.2g} to {high:.2g} was evened out (N4)"
    positions = frozen_floats(numbers)
    return replace(
        stack,
        decode=_Even(stack.decode, read_only(field.astype(np.float32)), positions, air, channel),
        notices=(*stack.notices, Notice("bias-corrected", text)),
    )


def _inside(mask: Any) -> Any:
    """Return the mask without its rim, whose pixels are filled in part and look dimmer than they are lit."""
    import SimpleITK as sitk  # noqa: N813, PLC0415 - as above

    core = sitk.BinaryErode(mask, (_RIM, _RIM, 0))  # type: ignore[no-untyped-call]
    kept = np.count_nonzero(sitk.GetArrayViewFromImage(core))
    return core if kept > _LEAST * np.count_nonzero(sitk.GetArrayViewFromImage(mask)) else mask


def _log_field(image: Any, mask: Any, stack: SliceStack) -> FloatArray:
    """Return the logarithm of the field, (slices, rows, columns) of the coarse copy."""
    import SimpleITK as sitk  # noqa: N813, PLC0415 - as above

    n4 = sitk.N4BiasFieldCorrectionImageFilter()  # type: ignore[no-untyped-call]
    n4.SetMaximumNumberOfIterations(_ITERATIONS)  # type: ignore[no-untyped-call]
    try:
        n4.Execute(image, mask)  # type: ignore[no-untyped-call]
        found = sitk.GetArrayFromImage(n4.GetLogBiasFieldAsImage(image))  # type: ignore[no-untyped-call]
    except RuntimeError as error:
        where = f"{stack.names[0]} … {stack.names[-1]}"
        raise InputError("no even brightness is found by N4", where=where) from error
    return np.asarray(found, dtype=np.float64)


def _shrunk(grey: Grey) -> Grey:
    rows, columns = (min(_SIDE, side) for side in grey.shape)
    return np.asarray(cv2.resize(grey, (columns, rows), interpolation=cv2.INTER_AREA), dtype=np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class _Even:
    """A decoder that divides the field out of what another gives."""

    decode: Callable[[int], Picture]
    field: Grey
    """(sampled slices, coarse rows, coarse columns)"""
    numbers: FloatArray
    """Slice number of each sampled slice."""
    air: float
    channel: str

    def __call__(self, number: int) -> Picture:
        grey = grey_levels(self.decode(number), self.channel)
        place = float(np.interp(number, self.numbers, np.arange(len(self.numbers))))
        low = min(int(place), len(self.numbers) - 2) if len(self.numbers) > 1 else 0
        high = min(low + 1, len(self.numbers) - 1)
        share = np.float32(place - low)
        coarse = (1 - share) * self.field[low] + share * self.field[high]
        rows, columns = grey.shape
        field = cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_LINEAR)
        return read_only(((grey - np.float32(self.air)) / field + np.float32(self.air)).astype(np.float32))
