"""Thresholds found from a grey-level histogram alone, by their textbook names."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.errors import InputError
from stackloft_plugins.segmenters.grey import Grey

Floats = NDArray[np.float64]

_BINS = 256


def otsu(counts: Floats, centres: Floats) -> float:
    """Return the threshold of greatest variance between classes (Otsu 1979, doi:10.1109/TSMC.1979.4310076).

    Where the histogram is empty between the peaks every threshold there is as good; the middle of
    that stretch is returned.

    Parameters
    ----------
    counts, centres : ndarray, (bins)
        Number of pixels and grey level of each bin.

    Examples
    --------
    >>> otsu(np.array([5.0, 0, 0, 0, 5]), np.arange(5.0))
    2.0
    """
    below = np.cumsum(counts)[:-1]
    above = counts.sum() - below
    moment = np.cumsum(counts * centres)
    with np.errstate(invalid="ignore", divide="ignore"):
        between = below * above * (moment[:-1] / below - (moment[-1] - moment[:-1]) / above) ** 2
    between = np.nan_to_num(between)
    best = np.flatnonzero(between >= between.max() * (1 - 1e-12))
    return float(0.5 * (centres[best[0]] + centres[best[-1] + 1]))


def isodata(counts: Floats, centres: Floats) -> float:
    """Return the threshold half-way between the means of its two classes (Ridler & Calvard 1978)."""
    from skimage.filters import threshold_isodata  # noqa: PLC0415 - slow to import, seldom used

    return float(threshold_isodata(hist=(counts, centres)))  # type: ignore[no-untyped-call]


def triangle(counts: Floats, centres: Floats) -> float:
    """Return the grey level furthest below the line from peak to tail (Zack, Rogers & Latt 1977)."""
    occupied = np.flatnonzero(counts)
    first, last = int(occupied[0]), int(occupied[-1])
    peak = int(np.argmax(counts))
    tail = first if peak - first > last - peak else last
    span = np.arange(min(peak, tail), max(peak, tail) + 1)
    line = np.interp(span, sorted((peak, tail)), counts[sorted((peak, tail))])
    return float(centres[span[int(np.argmax(line - counts[span]))]])


def minimum(counts: Floats, centres: Floats) -> float:
    """Return the valley between the two peaks of the smoothed histogram (Prewitt & Mendelsohn 1966)."""
    from skimage.filters import threshold_minimum  # noqa: PLC0415 - slow to import, seldom used

    return float(threshold_minimum(hist=(counts, centres)))  # type: ignore[no-untyped-call]


METHODS: dict[str, Callable[[Floats, Floats], float]] = {
    "otsu": otsu,
    "isodata": isodata,
    "triangle": triangle,
    "minimum": minimum,
}
"""Method name to function of (counts, bin centres)."""


def histogram_level(grey: Grey, method: str, name: str) -> float:
    """Return the threshold of `method` for one slice, on its own grey scale.

    Raises
    ------
    InputError
        The picture `name` is blank, or its histogram has not the shape that the method needs.

    Examples
    --------
    >>> histogram_level(np.repeat(np.float32([[20, 220]]), 50, axis=1), "otsu", "a.png")
    120.0
    """
    counts, centres = grey_histogram(grey)
    if len(counts) < 2:
        raise InputError(
            "no body found: the picture is blank",
            where=name,
            found=f"grey level {float(grey.flat[0]):g} everywhere",
            fix="move it out of the folder, or set skip = true for it in stack.toml",
        )
    try:
        return METHODS[method](counts, centres)
    except RuntimeError as error:  # skimage: no two maxima
        raise InputError(
            f"the {method} method finds no threshold",
            where=name,
            found=str(error),
            fix="use --set segmenter.method=half-way, or give --set segmenter.threshold=LEVEL",
        ) from error


def grey_histogram(grey: Grey) -> tuple[Floats, Floats]:
    """Return counts and bin centres over the levels that occur; one bin when all are equal.

    At most 256 bins, and on an 8-bit scale none narrower than a grey level, lest the histogram be a comb.
    """
    low, high = float(grey.min()), float(grey.max())
    if not high > low:
        return np.array([float(grey.size)]), np.array([low])
    bins = _BINS if high - low < 16 else min(_BINS, int(high - low) + 1)
    levels = np.ascontiguousarray(grey, dtype=np.float32)
    above = float(np.nextafter(np.float32(high), np.float32(np.inf)))  # OpenCV leaves the upper end out
    counts = cv2.calcHist([levels], [0], None, [bins], [low, above]).ravel()
    edges = np.linspace(low, high, bins + 1)
    return counts.astype(np.float64), 0.5 * (edges[:-1] + edges[1:])
