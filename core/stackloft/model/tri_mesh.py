"""A triangle surface."""

from __future__ import annotations

from dataclasses import dataclass

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.bias import Bias
from stackloft.model.notices import Notice


@dataclass(frozen=True, slots=True, eq=False)
class TriMesh:
    """Triangles, outward (counter-clockwise seen from outside)."""

    vertices: FloatArray
    """(n, 3) mm"""
    faces: IntArray
    """(t, 3) indices into `vertices`"""
    biased: str | None = None
    """Why its area is known to be biased (for example a binary label map); None when it is not."""
    volume_bias: Bias | None = None
    area_bias: Bias | None = None
    """How far off volume and area may be, when this surface's maker knows."""
    notices: tuple[Notice, ...] = ()
