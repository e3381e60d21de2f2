r"""What a section looks like, in numbers that change smoothly from slice to slice.

::

            ___ h(t)             The support function h: how far the section reaches from its centroid
         __/   \__|_             in direction t. On an ellipsoid, whichever way it is cut, h² and the area
        (    +----)  \           are quadratic in z, ends and all, whereas h itself falls like a square root.
         \___   __/
             \_/
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.shoelace import polygon_area, polygon_centroid

FloatArray = NDArray[np.float64]

DIRECTIONS = 24


def support_features(polygon: FloatArray) -> FloatArray:
    """Return area / π and the squared support function in `DIRECTIONS` directions, (1 + DIRECTIONS) mm².

    Parameters
    ----------
    polygon : array (k, 2)
        mm

    Examples
    --------
    >>> t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    >>> found = support_features(5 + 3 * np.column_stack([np.cos(t), np.sin(t)]))
    >>> bool(np.allclose(found, 9, rtol=1e-3))
    True
    """
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    away = polygon - polygon_centroid(polygon)
    reach = (away @ np.array([np.cos(angle), np.sin(angle)])).max(axis=0)
    return np.concatenate([[abs(polygon_area(polygon)) / np.pi], reach**2])
