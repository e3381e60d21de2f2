"""The curves of a loft at its sections: what lies between the points that were measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.lofted_solid import LoftedSolid, Shell

STEPS = 24
"""Samples of one Bézier segment."""


@dataclass(frozen=True, slots=True, eq=False)
class LoftLine:
    """One closed B-spline of a section."""

    curve: FloatArray
    """(k, 3) mm in stack coordinates: the curve, finely"""
    points: FloatArray
    """(N, 3) mm: the points it goes through"""


def lines_at(solid: LoftedSolid, z: float) -> tuple[LoftLine, ...]:
    """Return the loft's curves in the plane at `z`, one for each loop; none where no section lies."""
    found = [line for shell in solid.shells for line in _of_shell(shell, z)]
    return tuple(found)


def _of_shell(shell: Shell, z: float) -> list[LoftLine]:
    rows = [row[:, 0] for row in shell.patches] + [shell.patches[-1][:, 3]]
    tolerance = 1e-6 * max(1.0, float(np.ptp(shell.patches[..., 2])))
    found = []
    for row in rows:
        flat = np.abs(row[..., 2] - z).max() <= tolerance
        if flat and float(np.ptp(row[..., :2].reshape(-1, 2), axis=0).max()) > tolerance:
            found.append(LoftLine(_sampled(row), row[:, 0]))
            break  # a joint's rim and its neighbour are the same curve
    return found


def _sampled(row: FloatArray) -> FloatArray:
    """Return points along (columns, 4, 3) Bézier segments that close on themselves."""
    t = np.arange(STEPS) / STEPS
    basis = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    points: FloatArray = np.einsum("tk,ckx->ctx", basis, row).reshape(-1, 3)
    return points


def to_bench(points: FloatArray, affine: FloatArray) -> FloatArray:
    """Return stack millimetres as bench millimetres."""
    placed: FloatArray = points @ affine[:3, :3].T + affine[:3, 3]
    return placed
