r"""Slices that do not lie on each other, as slices photographed one by one without marks do not.

::

    jitter of the middles          The middles of a body's sections wander smoothly along the axis, or, where
    -----------------------        a cut passes a corner, with a kink that the widths have too. What is
    what the body may show         neither (`geometry.convex_wander`) comes from laying the slices down.

The mean over the stack decides, so that neither one displaced slice nor one hollow of the body does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.geometry.convex_wander import unexplained_wander
from stackloft.geometry.roughness import NOISE, third_differences
from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.model.arrays import FloatArray
from stackloft.model.notices import Notice

LIMIT = 0.0075
"""Of the mean diameter: unexplained jitter above which slices are said not to lie on each other. Of 594
sound phantoms of 15 kinds all but 1 stay below; slices laid down to ±3 mm and ±5° exceed it in 98 of 100
(`docs/proof/stack-hazards.md`, `misaligned.md`)."""


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
    jitter = float(unexplained_wander(z, outlines).mean())
    if jitter <= LIMIT * diameter:
        return None
    off = _scatter(z, middles)
    slope = off / float(np.median(np.diff(z)))
    message = (
        f"{names[0]} … {names[-1]}: the sections' middles scatter by {off:.2g} mm "
        f"({100 * off / diameter:.1f} % of the body's width) from slice to slice, of which its own corners "
        f"explain all but {jitter:.2g} mm; that may make the area {_excess(slope):.0f} % high; were the "
        "slices photographed one by one without marks? --align rigid lays them on each other"
    )
    return Notice("misaligned", message)


def _scatter(z: FloatArray, middles: FloatArray) -> float:
    """Return the standard deviation of the jitter that makes third differences such as the middles'."""
    return float(np.sqrt((third_differences(z, middles) ** 2).sum(axis=1).mean())) / NOISE


def _excess(slope: float) -> float:
    """Return how much a wall's area grows, %, when neighbours are displaced by √2 · slope of their distance.

    A wall element is stretched by √(1 + t²), t being the displacement across it: half the square on the mean.
    """
    across = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    return float(100 * (np.sqrt(1 + 2 * (slope * np.cos(across)) ** 2).mean() - 1))
