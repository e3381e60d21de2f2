r"""Colour without light: how far a colour lies from the plate's, whatever shadow falls on the plate.

::

    G                    A shadow, or uneven light, multiplies the plate's colour: all its shades lie on
    |     . flesh        one ray from black. What is flesh lies off that ray; how far, in L*a*b*, is counted
    |    /  .' plate     from the shade nearest to it. Likewise on the way from plate to flesh only the part
    |   / .' '           across the ray tells how much of a pixel is flesh, in shadow and beside it alike.
    |  .' shades
    +---------- R

Source: the dichromatic reflection model, Shafer (1985), "Using color to separate reflection components",
Color Research & Application 10, 210–218; CIE 1976 L*a*b*.
"""

from __future__ import annotations

import cv2
import numpy as np

from stackloft_plugins.segmenters.body_window import main_body
from stackloft_plugins.segmenters.grey import Grey

DARKEST = 0.35
"""Of the plate's brightness: shadows on it are no deeper; what is darker is no shade of it."""
_BRIGHT = 60.0 / 255.0
_FINEST = 0.5
"""L*a*b*: no plate is more even."""
_OF_NOISE = 8.0
"""Standard deviations of the plate's colour by which flesh of another colour differs at least."""
_OF_SEEN = 0.25
"""Of all that differs from the plate, shadows included: a smaller object is no body, but crumbs."""
_OF_ALL = 0.25
"""Of the difference from the plate, that part of it which is no shade's."""


def lab_difference(colours: Grey, shade: Grey) -> Grey:
    """Return the CIE 1976 difference of every pixel from a colour, or from one colour for each pixel.

    Parameters
    ----------
    colours : array (rows, columns, 3)
        RGB from 0 to 1.
    shade : array (3) or (rows, columns, 3)

    Examples
    --------
    >>> white, grey = np.ones((1, 1, 3), np.float32), np.full(3, 0.5, np.float32)
    >>> round(float(lab_difference(white, grey)[0, 0]))
    47
    """
    own = shade.reshape(1, 1, 3) if shade.ndim == 1 else shade
    apart = cv2.cvtColor(colours, cv2.COLOR_RGB2LAB) - cv2.cvtColor(own, cv2.COLOR_RGB2LAB)
    return np.asarray(np.linalg.norm(apart, axis=2), dtype=np.float32)


def difference_from_shades(colours: Grey, plate: Grey) -> Grey:
    """Return the L*a*b* difference of every pixel from the shade of the plate that is nearest in RGB.

    Examples
    --------
    >>> plate = np.array([0.9, 0.9, 0.8], np.float32)
    >>> row = np.stack([plate, 0.5 * plate, 0.2 * plate, [0.9, 0.8, 0.5]])[None].astype(np.float32)
    >>> (difference_from_shades(row, plate)[0] > 5).tolist()        # plate, shadow, too dark, flesh
    [False, False, True, True]
    """
    light = np.clip(colours @ (plate / float(plate @ plate)), DARKEST, 1.0)
    return lab_difference(colours, np.ascontiguousarray(light[..., None] * plate, dtype=np.float32))


def across_shades(way: Grey, plate: Grey) -> Grey:
    """Return the part of a way in RGB, (3), that no shadow on the plate makes.

    Examples
    --------
    >>> across_shades(np.array([-0.25, -0.25, -1.0], np.float32), np.ones(3, np.float32)).round(3)
    array([ 0.25,  0.25, -0.5 ], dtype=float32)
    """
    ray = plate / np.float32(np.linalg.norm(plate))
    return np.asarray(way - (way @ ray) * ray, dtype=np.float32)


def tells_without_light(apart: Grey, blind: Grey, frame: Grey, plate: Grey) -> bool:
    """Tell whether the flesh has a colour of its own, so that its brightness need not count.

    Parameters
    ----------
    apart, blind : arrays of the same shape
        The differences from the plate and from its nearest shade, of a coarse look.
    frame : array (n)
        `blind` where plate is.
    plate : array (3)
        Only a bright plate shows shadows.
    """
    if float(plate.mean()) < _BRIGHT:
        return False
    usual = float(np.median(frame))
    noise = max(1.4826 * float(np.median(np.abs(frame - usual))), _FINEST)
    coloured = main_body((blind > usual + _OF_NOISE * noise).astype(np.uint8)) > 0
    seen = apart > 0.5 * float(np.quantile(apart, 0.99))  # shadows too, which may be larger than the body
    if not coloured.any() or np.count_nonzero(coloured) < _OF_SEEN * np.count_nonzero(seen):
        return False
    return bool(np.median(blind[coloured]) > _OF_ALL * np.median(apart[coloured]))
