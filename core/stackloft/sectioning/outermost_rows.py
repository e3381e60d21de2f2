"""What a tube's outermost sections say of where it ends."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.second_moments import central_moments, half_axes
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.tube_rows import Row

ARCH = 2
"""Sections too few for a parabola."""
LIMB = 5
"""Outermost sections that tell whether a tube is an even limb."""


def outermost(rows: list[Row], *, at_last: bool) -> list[Row]:
    """Return a tube's outermost sections, outermost first."""
    inward = rows[::-1] if at_last else rows
    real = [row for row in inward if row.section is not None]
    # Rows put in lie too close together for a parabola; over the whole of a short tube they make a line.
    return real[:LIMB] if len(real) >= 2 else [inward[0], inward[-1]] if len(inward) > 1 else inward


def sizes(rows: list[Row]) -> tuple[FloatArray, FloatArray]:
    """Return positions, mm, and areas, mm²."""
    return np.array([row.z for row in rows]), np.array([abs(row.loop.signed_area) for row in rows])


def arch_lengths(rows: list[Row]) -> FloatArray | None:
    """Return the squared lengths of an arch's two sections, mm²; None of more sections and of compact ones.

    Two sections have no parabola. Where a bar is bent over, as a ring's crown is, the square of its length is
    straight over the depth for as long as its large circle is; its thickness and with it its area are not.
    """
    if len(rows) != ARCH:
        return None
    moments = [central_moments(row.loop.points)[0] for row in rows]
    (short, long), axes = np.linalg.eigh(moments[0])
    lengths = np.array([axes[:, 1] @ m @ axes[:, 1] for m in moments])
    return lengths if long > 2.0 * short > 0.0 < lengths.min() else None


def half_widths(rows: list[Row]) -> FloatArray:
    """Return half the smaller width of each, mm."""
    return np.array([half_axes(row.loop.points)[1] for row in rows])
