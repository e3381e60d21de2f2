r"""Slices that do not lie on each other, as slices photographed one by one without marks do not.

::

    jitter of the middles          The middles of a body's sections wander smoothly along the axis. Where a
    -----------------------        body has kinks (a tilted end cut, a flange) they do not, but there the
    kinks of the shape + width     sections' lengths and widths, which no laying-down changes, have kinks too.

Both are third differences (`geometry.roughness`); the jitter is their geometric mean of root mean square and
median, so that neither one displaced slice nor one kink decides.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.geometry.roughness import NOISE, third_differences
from stackloft.geometry.second_moments import half_axes
from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.model.arrays import FloatArray
from stackloft.model.notices import Notice

LIMIT = 0.5
"""Jitter by kinks and width, above which slices are said not to lie on each other. Sound phantoms of 15 kinds
stay below 0.45 in 97 of 100 (foods below 0.26), the Visible Human's cryosections below 0.3; slices laid down
to ±3 mm and ±5° reach 0.65 in 99 of 100 (`docs/proof/stack-hazards.md`, `misaligned.md`)."""
_OF_WIDTH = 0.01
"""Of the mean diameter: jitter of this size by itself is no reason to doubt."""


def misaligned(names: Sequence[str], z: FloatArray, outlines: Sequence[FloatArray]) -> Notice | None:
    """Return a notice when the sections jitter as only slices laid down one by one do.

    Parameters
    ----------
    names : sequence of m str
    z : array (m)
        mm
    outlines : sequence of m arrays (k, 2)
        mm

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> cuts = phantoms.make("apple").contour_stack(14)
    >>> names = [cut.name for cut in cuts.sections]
    >>> outlines = [cut.loops[0].points for cut in cuts.sections]
    >>> misaligned(names, cuts.positions, outlines) is None
    True
    >>> rng = np.random.default_rng(1)
    >>> shaken = [outline + rng.uniform(-3, 3, 2) for outline in outlines]
    >>> misaligned(names, cuts.positions, shaken).code
    'misaligned'
    """
    diameter = float(np.sqrt(4 / np.pi * np.mean([abs(polygon_area(outline)) for outline in outlines])))
    middles = np.array([polygon_centroid(outline) for outline in outlines])
    off = _lengths(z, middles)
    rough = _lengths(z, np.array([half_axes(outline) for outline in outlines]))
    jitter = float(np.sqrt(_rms(off) * np.median(off)))
    if jitter <= LIMIT * (_rms(rough) + _OF_WIDTH * diameter):
        return None
    slope = _rms(off) / float(np.median(np.diff(z)))
    message = (
        f"{names[0]} … {names[-1]}: the sections' middles scatter by {_rms(off):.2g} mm "
        f"({100 * _rms(off) / diameter:.1f} % of the body's width) from slice to slice, which may make the "
        f"area {_excess(slope):.0f} % high; were the slices photographed one by one without marks? "
        "--align rigid lays them on each other"
    )
    return Notice("misaligned", message)


def _lengths(z: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(third_differences(z, values), axis=1) / NOISE)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt((values**2).mean()))


def _excess(slope: float) -> float:
    """Return how much a wall's area grows, %, when neighbours are displaced by √2 · slope of their distance.

    A wall element is stretched by √(1 + t²), t being the displacement across it: half the square on the mean.
    """
    across = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    return float(100 * (np.sqrt(1 + 2 * (slope * np.cos(across)) ** 2).mean() - 1))
