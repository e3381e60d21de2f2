"""One frame's pixels: decoded alone, checked for completeness, padding taken out, in rescaled units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import native, read_only
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.dicom_codestream import RLE, check_codestream
from stackloft_plugins.readers.dicom_file import DEFLATED, ClampedFile, safely
from stackloft_plugins.readers.dicom_frame import Frame

if TYPE_CHECKING:
    from pydicom import Dataset


def decode_frame(frame: Frame) -> Picture:
    """Return one frame's grey levels (rows, columns), or RGB (rows, columns, 3); read-only.

    Stored values that stand for padding become the least value measured in the slice; MONOCHROME1 is
    turned over within the stored range where the file gives no physical scale; then
    slope · stored + intercept, as whole numbers where that loses nothing. No other frame is decoded.

    Raises
    ------
    InputError
        The pixels are damaged, cut off, or not of the size that the header claims.
    """
    plain = frame.samples_at.read(frame.path, frame.shape) if frame.samples_at is not None else None
    stored, data = _stored(frame) if plain is None else (plain, None)
    if stored.shape[:2] != frame.shape or stored.ndim != (2 if frame.samples == 1 else 3):
        raise InputError(
            "is damaged: the picture is not of the size that its header claims",
            where=str(frame.path),
            found=" × ".join(map(str, stored.shape)),
            expected=" × ".join(map(str, frame.shape)),
        )
    if frame.samples > 1:
        return read_only(stored)
    grey = without_padding(native(stored), frame.padding)
    if frame.lookup and data is not None:
        return read_only(_looked_up(grey, data, frame))
    if frame.inverted and not frame.rescaled:
        grey = (sum(frame.stored) - grey.astype(np.int64)).astype(grey.dtype)
    return read_only(rescaled(grey, frame.slope, frame.intercept, own=plain is not None))


def without_padding(stored: NDArray[Any], padding: tuple[int, int] | None) -> NDArray[Any]:
    """Return the picture with values from `padding[0]` to `padding[1]` at the least other value.

    Examples
    --------
    >>> without_padding(np.array([[-2000, 5, 40]]), (-2000, -2000)).tolist()
    [[5, 5, 40]]
    """
    if padding is None:
        return stored
    padded = (stored >= padding[0]) & (stored <= padding[1])
    if not padded.any() or padded.all():
        return stored
    return np.where(padded, stored[~padded].min(), stored)


def rescaled(stored: NDArray[Any], slope: float, intercept: float, *, own: bool = False) -> NDArray[Any]:
    """Return slope · stored + intercept; whole numbers stay whole (16 bit where they fit), others float.

    `own`: nobody else needs `stored`, so that it may be changed.

    Examples
    --------
    >>> rescaled(np.array([[0, 4095]], dtype=np.uint16), 1.0, -1024.0)
    array([[-1024,  3071]], dtype=int16)
    >>> rescaled(np.array([[2]], dtype=np.int16), 0.5, 0.25)
    array([[1.25]], dtype=float32)
    """
    if slope == 1.0 and intercept == 0.0:
        return stored
    if (
        slope == 1.0
        and intercept == round(intercept)
        and stored.dtype.itemsize <= 2
        and abs(intercept) < 2**30
    ):
        return _shifted(stored, round(intercept), own=own)
    wide = np.float32 if stored.dtype.itemsize <= 2 else np.float64
    values = stored.astype(np.float64) * slope + intercept
    return values.astype(wide)


def _shifted(stored: NDArray[Any], shift: int, *, own: bool) -> NDArray[Any]:
    """Return whole numbers of at most 16 bits and `shift`, as int16 where that holds them."""
    low, high = int(stored.min(initial=0)), int(stored.max(initial=0))
    if not fits_short(low, high, shift):
        return stored.astype(np.int32) + np.int32(shift)
    short = stored.view(np.int16) if stored.dtype.itemsize == 2 else stored.astype(np.int16)
    # uint16 that wraps round comes back by the shift
    return np.asarray(np.add(short, np.int16(shift), out=short if own else None))


def fits_short(low: int, high: int, shift: int) -> bool:
    """Return whether int16 holds values from `low` to `high`, and 0, with `shift` added."""
    return min(low, 0) + shift >= -(2**15) and max(high, 0) + shift < 2**15


def _stored(frame: Frame) -> tuple[NDArray[Any], Dataset | None]:
    """Return the stored values and the elements of the image group."""
    from pydicom import Dataset, dcmread  # noqa: PLC0415 - slow to import
    from pydicom.pixels.utils import pixel_array  # noqa: PLC0415

    data = Dataset()
    with safely(frame.path, f"the picture of {frame.name}"), ClampedFile(frame.path) as stream:
        check_codestream(stream, frame)
        if frame.syntax == DEFLATED:
            whole = dcmread(stream, force=True)
            return np.asarray(pixel_array(whole, index=frame.number)), whole
        extra: dict[str, Any] = {} if _has_meta(stream) else {"transfer_syntax_uid": frame.syntax}
        if frame.syntax == RLE:  # the quicker pylibjpeg-rle ends in a Rust panic on damaged segments
            extra["decoding_plugin"] = "pydicom"
        values = pixel_array(stream, ds_out=data, index=frame.number, **extra)
        return np.asarray(values), data


def _has_meta(stream: ClampedFile) -> bool:
    """Return whether the file says its transfer syntax."""
    stream.seek(0)
    head = stream.read(134)
    stream.seek(0)
    return head[128:134] == b"DICM\x02\x00" or head[:2] == b"\x02\x00"


def _looked_up(stored: NDArray[Any], data: Dataset, frame: Frame) -> NDArray[Any]:
    from pydicom.pixels.processing import apply_modality_lut  # noqa: PLC0415 - slow to import

    with safely(frame.path, "its Modality LUT"):
        return np.asarray(apply_modality_lut(stored, data))
