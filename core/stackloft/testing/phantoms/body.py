"""What a body is, twice over: by inequalities, for its sections, and by patches, for its figures.

::

      fields   body = { X : every field(X) <= 0 }     each smooth; where two are zero is an edge
      patches  boundary = union of X(u, v)            each smooth on its rectangle, outward

Both in the body's own frame, millimetres; a pose moves it. The two descriptions are written down
separately, and tests hold them against each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from stackloft.model.arrays import FloatArray
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
    volume: float
    """mm³, to 1e-9"""
    area: float
    """mm², to 1e-9"""
    tips: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    """(k, 3) mm: the sharp points (an apex, a polyhedron's vertices)."""
    parameters: Mapping[str, float] = field(default_factory=dict)
    """What it was made from, for the record."""

    @property
    def polyhedral(self) -> bool:
        """True when every field is plane: then the body is a convex polyhedron."""
        return all(isinstance(piece, Plane) for piece in self.fields)
