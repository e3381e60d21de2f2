r"""A camera as a pinhole: the pixel size on a plane grows with its distance from the lens.

::

       lens  o                s = D / f: a plane at distance D is seen with pixels of s, f being the focal
            /|\               length in pixels. A reference object h above the cut face is nearer to the
    ref  --/-|-\--   D - h    lens, so that its pixels are smaller: s_face = s_ref · D / (D - h).
    face  /--|--\    D
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def face_scale(distance: FloatArray, height: FloatArray) -> FloatArray:
    """Return pixel size on the face by pixel size on a plane `height` above it (negative below).

    Parameters
    ----------
    distance : array (m)
        From the lens to the face, mm.
    height : array (m)
        mm

    Examples
    --------
    >>> face_scale(np.array([600.0]), np.array([-16.0])).round(5).tolist()
    [0.97403]
    """
    ratio: FloatArray = distance / (distance - height)
    return ratio


def one_scale_cost(travelled: FloatArray, distance: float) -> float:
    """Return the relative error in volume when receding faces are all given the first one's pixel size.

    Parameters
    ----------
    travelled : array (m)
        How far each face lies beyond the first, mm; faces of about equal area are assumed.
    distance : float
        From the lens to the first face, mm.

    Examples
    --------
    >>> round(one_scale_cost(np.linspace(0, 176, 12), 1000.0), 3)
    -0.149
    """
    return float(np.mean((distance / (distance + travelled)) ** 2) - 1)


def shared_origins(pixel_sizes: FloatArray, principal: tuple[float, float]) -> FloatArray:
    """Return pixel (0, 0)'s place in each picture, (m, 2) mm: the principal point lies alike in all.

    Parameters
    ----------
    pixel_sizes : array (m, 2)
        Row and column spacing of each picture, mm.
    principal : (column, row)
        Pixels.

    Examples
    --------
    >>> shared_origins(np.array([[0.2, 0.2], [0.3, 0.3]]), (100.0, 50.0)).round(9).tolist()
    [[0.0, 0.0], [-10.0, -5.0]]
    """
    spacing = pixel_sizes[:, ::-1]  # x, y
    origins: FloatArray = (spacing[0] - spacing) * np.asarray(principal)
    return origins
