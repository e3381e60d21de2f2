"""From a picture to filtered grey levels."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Grey = NDArray[np.float32]
"""(rows, columns) grey levels on the picture's own scale."""

Levels = NDArray[Any]
"""(rows, columns) float32 grey levels, or int16 parts of them: see `FINE`."""

FINE = 64
"""Parts of a grey level in which the levels of 8-bit pictures are kept, as whole numbers: half the memory of
float32. Under even light they are no whole levels any more; 255 of them, in the darkest light that is
believed, make 27 200 parts."""

CHANNELS: dict[str, tuple[float, float, float]] = {
    "luminance": (0.299, 0.587, 0.114),
    "red": (1.0, 0.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
}
"""Weights of red, green and blue; luminance is ITU-R BT.601, what MATLAB's rgb2gray takes."""

_ROWS = 128
"""Rows of a photograph whose colours are mixed at once."""


def grey_levels(picture: NDArray[Any], channel: str = "luminance") -> Grey:
    """Return the grey levels of a picture, not rounded.

    On a picture of two colours every weighting puts the half-way boundary at the same place, because
    a pixel's mixture of the two is the same in each channel; weights matter for noise and texture only.

    Parameters
    ----------
    picture : ndarray, (rows, columns) or (rows, columns, 3)
        Grey or RGB, any real dtype.
    channel : str
        A key of `CHANNELS`; a grey picture has but one.

    Examples
    --------
    >>> float(grey_levels(np.full((2, 2, 3), (100, 200, 50), dtype=np.uint8))[0, 0])
    153.0
    """
    if picture.ndim == 2:
        return picture.astype(np.float32)
    red, green, blue = CHANNELS[channel]
    if picture.dtype == np.uint8:  # by OpenCV: a third of the time on photographs
        levels = np.empty(picture.shape[:2], dtype=np.float32)
        for top in range(0, len(picture), _ROWS):  # what is in between stays small
            planes = cv2.split(np.ascontiguousarray(picture[top : top + _ROWS]))
            mixed = cv2.addWeighted(planes[0], red, planes[1], green, 0.0, dtype=cv2.CV_32F)
            levels[top : top + _ROWS] = cv2.scaleAdd(planes[2].astype(np.float32), blue, mixed)
        return levels
    parts = [np.ascontiguousarray(picture[..., plane], dtype=np.float32) for plane in range(3)]
    whole: Grey = red * parts[0]
    whole += green * parts[1]
    whole += blue * parts[2]
    return whole


def single(level: float) -> float:
    """Return a level as grey levels in single precision have it, so that all comparisons with it agree.

    Examples
    --------
    >>> bool(np.float32(0.1) > single(0.1))
    False
    """
    return float(np.float32(level))


def filtered(picture: NDArray[Any], channel: str = "luminance") -> NDArray[Any]:
    """Return the `median_filtered` grey levels of a picture; 8-bit grey stays 8-bit, a quarter of the memory.

    Examples
    --------
    >>> speck = np.zeros((5, 5), dtype=np.uint8)
    >>> speck[2, 2] = 255
    >>> filtered(speck).dtype, int(filtered(speck).max())
    (dtype('uint8'), 0)
    """
    if picture.ndim == 2 and picture.dtype == np.uint8:
        return np.asarray(cv2.medianBlur(np.ascontiguousarray(picture), 3))
    return median_filtered(grey_levels(picture, channel))


def median_filtered(grey: Grey) -> Grey:
    """Return the 3×3 median (Tukey 1977; the filter of Goñi et al. 2007), edges replicated.

    It takes single bright or dark pixels away and leaves straight edges exactly where they are:
    across such an edge four of the neighbours lie on either side of the middle value.

    Examples
    --------
    >>> speck = np.zeros((5, 5), dtype=np.float32)
    >>> speck[2, 2] = 255
    >>> float(median_filtered(speck).max())
    0.0
    """
    return np.asarray(cv2.medianBlur(np.ascontiguousarray(grey), 3), dtype=np.float32)
