"""How much of the axis each section stands for, and sums over sections that follow."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.bias import Bias
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SliceStack


def slab_lengths(positions: FloatArray, thickness: float | None = None) -> FloatArray:
    """Return each section's length along the axis: half-way to its neighbours on either side.

    The first and the last reach as far outwards as inwards.

    Parameters
    ----------
    positions : (m,) array
        mm, increasing.
    thickness : float, optional
        mm; what a single section is thick.

    Raises
    ------
    InputError
        No section, or one whose thickness nobody gave.

    Examples
    --------
    >>> slab_lengths(np.array([0.0, 2.0, 6.0]))
    array([2., 3., 4.])
    """
    if len(positions) == 0 or (len(positions) == 1 and thickness is None):
        raise InputError("slices have no thickness unless there are at least 2", found=str(len(positions)))
    if len(positions) == 1:
        return np.array([thickness], dtype=np.float64)
    gaps = np.diff(positions)
    return np.asarray(0.5 * (np.append(gaps[:1], gaps) + np.append(gaps, gaps[-1:])))


def slab_sum(areas: FloatArray, stack: SliceStack) -> tuple[float, Bias]:
    """Return Σ area × slab length, mm³ on the bench, and how far the outermost slabs may have led it astray.

    Parameters
    ----------
    areas : (m,) array
        Area of the body on each slice, mm².
    stack : SliceStack

    Raises
    ------
    InputError
        No slice has any area.
    """
    return slab_sum_at(areas, stack.positions, stack)


def slab_sum_at(areas: FloatArray, positions: FloatArray, stack: SliceStack) -> tuple[float, Bias]:
    """Return the same of areas at other positions along the stack's axis, mm."""
    thickness = None if stack.thickness is None else float(stack.thickness.mean())
    amounts = areas * slab_lengths(positions, thickness)
    if not amounts.sum() > 0.0:
        raise InputError("nothing in the slices is above the level: there is no body")
    jacobian = abs(float(np.linalg.det(stack.affine[:3, :3])))
    return jacobian * float(amounts.sum()), outer_bias(amounts)


def outer_bias(amounts: FloatArray) -> Bias:
    """Return the error that the outer halves of the first and last slab can make: no section sees them.

    Either they are not filled (the outermost sections are the body's end faces), or the body goes on for as
    much again.

    Examples
    --------
    >>> bias = outer_bias(np.array([1.0, 2.0, 1.0]))
    >>> bias.low, bias.high
    (-25.0, 25.0)
    """
    share = max(_LEAST, 50.0 * float(amounts[0] + amounts[-1]) / float(amounts.sum()))
    reason = (
        f"the outer halves of the end slabs hold {share:.1f} % of the volume,"
        " and no section tells how full they are"
    )
    return Bias(-share, share, reason)


_LEAST = 0.5
"""%: the least error that is allowed for."""
