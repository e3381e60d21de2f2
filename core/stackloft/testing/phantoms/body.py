"""What a body is, twice over: by inequalities, for its sections, and by patches, for its figures.

::

      fields   body = { X : every field(X) <= 0 }     each smooth; where two are zero is an edge;
               or a union of such parts               (a blind hole, a limb grown on to a ring)
      patches  boundary = union of X(u, v)            each smooth on its rectangle, outward

Both in the body's own frame, millimetres; a pose moves it. The two descriptions are written down
separately, and tests hold them against each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.testing.phantoms.dual import Array

Field = Callable[[Array], Array]
"""(3, n) mm to (n); negative inside; real or complex (`stackloft.testing.phantoms.dual`)."""
Rule = Literal["gauss", "periodic", "graded"]
"""``gauss`` for smooth, ``periodic`` for closed, ``graded`` (tanh-sinh) for algebraic singularities at the
ends of the interval."""


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """One smooth piece of a boundary."""

    surface: Callable[[Array, Array], Array]
    """u (n), v (n) to (3, n) mm; X_u × X_v points out of the body."""
    u: tuple[float, float]
    v: tuple[float, float]
    rules: tuple[Rule, Rule] = ("gauss", "gauss")


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """A field that is plane: normal·X ≤ distance."""

    normal: FloatArray
    """(3) unit vector out of the body"""
    distance: float
    """mm"""

    def __call__(self, X: Array) -> Array:
        """Return the signed distance of points (3, n), mm; negative inside."""
        value: Array = self.normal @ X - self.distance
        return value


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A solid in its own frame."""

    fields: tuple[Field, ...]
    patches: tuple[Patch, ...]
    """Those of the boundary alone: what lies inside another part is left out."""
    volume: float
    """mm³, to 1e-9"""
    area: float
    """mm², to 1e-9"""
    tips: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    """(k, 3) mm: the sharp points (an apex, a polyhedron's vertices)."""
    parameters: Mapping[str, float] = field(default_factory=dict)
    """What it was made from, for the record."""
    parts: tuple[tuple[int, ...], ...] = ()
    """The body is the union of parts, each the points where all its fields (indices) are ≤ 0; none given: one
    part with every field."""
    detail: int = 121
    """Steps of the grid across a section that finds its loops; more for loops that are thin or close."""

    @property
    def polyhedral(self) -> bool:
        """True when every field is plane: then the body is a convex polyhedron."""
        return all(isinstance(piece, Plane) for piece in self.fields) and len(self.parts) < 2


def deciding(values: FloatArray, parts: Sequence[Sequence[int]]) -> IntArray:
    """Return which field decides about each point, (n): the largest in a part, the least of parts.

    Parameters
    ----------
    values : (fields, n) array
        The fields at n points, or distances in their stead.
    parts : sequence of sequences of int
        `Body.parts`.

    Examples
    --------
    >>> values = np.array([[1.0, -2.0], [2.0, -3.0], [-1.0, 5.0]])
    >>> deciding(values, ()).tolist(), deciding(values, ((0, 1), (2,))).tolist()
    ([1, 2], [2, 0])
    """
    if len(parts) < 2:
        return np.asarray(values.argmax(axis=0))
    pick = [np.asarray(part)[values[list(part)].argmax(axis=0)] for part in parts]
    picked = np.stack(pick)
    least = np.take_along_axis(values, picked, axis=0).argmin(axis=0)
    return np.asarray(picked[least, np.arange(values.shape[1])])
