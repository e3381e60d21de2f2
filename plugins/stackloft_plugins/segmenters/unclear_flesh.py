r"""Flesh that is neither as its edge nor as the plate: the level runs through it, and the outline with it.

::

    grey   skin
           |\   flesh, pale           Half-way between a dark skin and the plate lies the pale flesh itself:
       - - | \.-´`-._.- - - level     parts of it are body and parts are not, by chance. A hole is as the
           |                          plate is, and flesh that is seen well lies beyond the level.
    plate _|
           outline → inwards

Only a belt along the outline is looked at: organs and bones deep within a body are no matter of its outline.
"""

from __future__ import annotations

import cv2
import numpy as np

from stackloft.model.notices import Notice
from stackloft_plugins.segmenters.grey import Levels
from stackloft_plugins.segmenters.half_way import Edge

UNCLEAR = 0.15
"""Share of the belt above which the outline is in doubt. Rendered foods that are seen well stay below 0.006,
the Visible Human's 57 cryosections below 0.08; a pale apple on a white plate has 0.27 and more."""
_AS_PLATE = 0.25
"""Of the step from plate to edge: what is nearer to the plate is plate, such as seen through a hole."""
_EDGE = 4
"""Pixels: so far the edge's blur and skin reach."""
_BELT = 20
"""Pixels of the coarse look, in which the body's window is no narrower than `_COARSE`."""
_COARSE = 250


def unclear_share(grey: Levels, edge: Edge, level: float) -> float:
    """Return the share of the belt along the outline that lies between plate and level.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background.
    edge : Edge
        What the bands beside the boundary say, and the outline, holes filled.
    level : float
        Of the boundary.

    Examples
    --------
    >>> from stackloft_plugins.segmenters.half_way import half_way_edge
    >>> plate = np.full((90, 90), 20, dtype=np.float32)
    >>> plate[20:70, 20:70] = 120                            # skin
    >>> plate[22:68, 22:68] = 60                             # flesh
    >>> plate[30:36, 30:36] = 20                             # hole
    >>> round(unclear_share(plate, half_way_edge(plate, 65.0), 70.0), 2)
    0.98
    >>> unclear_share(plate, half_way_edge(plate, 40.0), 40.0)
    0.0
    """
    step = max(1, min(grey.shape) // _COARSE)
    inside = cv2.copyMakeBorder(edge.mask[::step, ::step], 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    outer = cv2.erode(inside, _square(-(-_EDGE // step)))
    belt = (cv2.subtract(outer, cv2.erode(outer, _square(_BELT - _EDGE)))[1:-1, 1:-1]) > 0
    if not belt.any():
        return 0.0
    values = grey[::step, ::step][belt]
    plate = edge.background + _AS_PLATE * edge.contrast
    return float(np.mean((values > plate) & (values < level)))


def unclear_notice(share: float, name: str) -> tuple[Notice, ...]:
    """Return what to say of a share of the belt, unless it is too small to matter."""
    if share <= UNCLEAR:
        return ()
    message = (
        f"{name}: {100 * share:.0f} % of the flesh beside the outline is neither as its edge nor as the "
        "plate, and the level lies within it; look at its contour. Where flesh and plate differ by colour, "
        "--segmenter colour tells them apart"
    )
    return (Notice("flesh-unsure", message),)


def _square(reach: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    return np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
