"""A posed body's inequalities on one plane z = const, and Newton's method on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.testing.phantoms.body import Field, deciding
from stackloft.testing.phantoms.dual import STEP

_ROUNDS = 60
_CONVERGED = 1e-9
_LEVEL = 1e-30
"""Keeps a field that is constant on the plane from dividing by its slope."""


@dataclass(frozen=True, slots=True, eq=False)
class PlaneCut:
    """The fields of a posed body restricted to the plane at height `z`."""

    fields: tuple[Field, ...]
    rotation: FloatArray
    """(3, 3) body to bench"""
    offset: FloatArray
    """(3) mm"""
    z: float
    """mm"""
    size: float
    """mm, a length of the order of the section's; steps are limited by it."""
    parts: tuple[tuple[int, ...], ...] = ()
    """`stackloft.testing.phantoms.body.Body.parts`"""

    def values(self, piece: int, p: FloatArray) -> FloatArray:
        """Return field `piece` at plane points (2, n)."""
        found: FloatArray = self.fields[piece](self.rotation.T @ self._lift(p))
        return found

    def values_and_gradients(self, piece: int, p: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return field `piece` (n) and its in-plane gradient (2, n) at plane points (2, n)."""
        X = self.rotation.T @ self._lift(p)
        along = [self.fields[piece](X + 1j * STEP * self.rotation[axis][:, None]) for axis in (0, 1)]
        return along[0].real, np.stack([value.imag / STEP for value in along])

    def worst(self, p: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return the field that decides (n), the largest of its part, and which one it is (n)."""
        values = np.stack([self.values(piece, p) for piece in range(len(self.fields))])
        pieces = deciding(values, self.parts)
        return values[pieces, np.arange(values.shape[1])], pieces

    def nearest(self, p: FloatArray) -> IntArray:
        """Return which field bounds the section near plane points (2, n) that lie close to its boundary.

        Fields come in different units; value over slope is a distance in each.
        """
        distances = []
        for piece in range(len(self.fields)):
            value, gradient = self.values_and_gradients(piece, p)
            distances.append(value / (np.hypot(*gradient) + _LEVEL))
        return deciding(np.stack(distances), self.parts)

    def project(self, p: FloatArray, piece: int | None = None) -> FloatArray:
        """Return the points moved along gradients onto the boundary (or onto one field's zero), (2, n)."""
        p = p.copy()
        active = np.arange(p.shape[1])
        for _ in range(_ROUNDS):
            step = self._newton_steps(p[:, active], piece)
            p[:, active] += step
            moved = np.hypot(*step)
            active = active[moved > _CONVERGED * (self.size + np.abs(p[:, active]).max(axis=0))]
            if not len(active):
                break
        return p

    def _newton_steps(self, p: FloatArray, piece: int | None) -> FloatArray:
        pieces = self.worst(p)[1] if piece is None else np.full(p.shape[1], piece)
        step = np.zeros_like(p)
        for one in np.unique(pieces):
            own = pieces == one
            value, gradient = self.values_and_gradients(int(one), p[:, own])
            squared = (gradient**2).sum(axis=0)
            step[:, own] = -value * gradient / np.where(squared > 0, squared, 1)
        length = np.hypot(*step)
        limit = 0.1 * self.size
        return step * np.where(length > limit, limit / np.where(length > 0, length, 1), 1)

    def meet(self, first: int, second: int, p: FloatArray) -> FloatArray:
        """Return the point near `p` (2) where two fields are both zero, (2) mm."""
        for _ in range(_ROUNDS):
            pairs = [self.values_and_gradients(piece, p[:, None]) for piece in (first, second)]
            jacobian = np.stack([gradient[:, 0] for _, gradient in pairs])
            values = np.array([value[0] for value, _ in pairs])
            step = -np.linalg.lstsq(jacobian, values)[0]
            length = float(np.hypot(*step))
            p = p + step * min(1.0, 0.1 * self.size / length if length else 1.0)
            if length <= _CONVERGED * (self.size + float(np.abs(p).max())):
                break
        return p

    def away(self, piece: int, p: FloatArray) -> float:
        """Return about how far a plane point (2) is from the zero of one field, mm."""
        value, gradient = self.values_and_gradients(piece, p[:, None])
        return float(abs(value[0]) / (np.hypot(*gradient[:, 0]) + _LEVEL))

    def _lift(self, p: FloatArray) -> FloatArray:
        """Return plane points (2, n) as bench points less the offset, (3, n)."""
        return np.stack(
            [p[0] - self.offset[0], p[1] - self.offset[1], np.full(p.shape[1], self.z - self.offset[2])]
        )
