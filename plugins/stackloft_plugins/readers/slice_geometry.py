r"""Where slices lie in space, from the position and orientation of each.

::

             n = row × column                  z_k = n · P_k: positions are projections on the normal,
             ^                                 neither thickness nor spacing tags
      P_1 ___|___________                      P_k = P_0 + (z_k − z_0)·d: d ≠ n is gantry tilt, which
      P_0 ___|__________/                      goes into the affine as shear, and has no effect on
             |   d = n + tilt                  volumes because d · n = 1

Source: DICOM PS3.3, C.7.6.2.1.1; the reasons are threads of ITK, dcm2niix and SimpleITK, where sorting by
other elements scrambled stacks and tilt was thrown out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice

SAME_PLACE = 1e-3
"""Gaps below this fraction of the usual gap are none: the slices are duplicates."""
MISSING = 1.5
"""A gap longer than this many usual ones misses a slice."""
UNEVEN = 0.01
"""Gaps that differ by more than this fraction are told."""
ASIDE = 0.25
"""Pixels by which a slice may lie beside the line through the others."""
TILT = 0.05
"""Degrees of shear that are worth a word."""


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """Slices in order along their normal."""

    order: IntArray
    """(m) which of the given slices comes first, second, …"""
    positions: FloatArray
    """(m) mm along the normal, increasing"""
    affine: FloatArray
    """(4, 4) from stack millimetres (x, y, z, 1) to patient millimetres; shear is gantry tilt."""
    notices: tuple[Notice, ...]


def normal_of(axes: FloatArray) -> FloatArray:
    """Return the unit normal row × column of the (2, 3) unit vectors of increasing column and row."""
    normal: FloatArray = np.cross(axes[0], axes[1])
    return normal


def place_slices(
    points: FloatArray,
    axes: FloatArray,
    names: Sequence[str],
    thickness: FloatArray | None,
    pixel: float,
    *,
    allow_gaps: bool = False,
) -> Placed:
    """Return order, positions and affine of slices that share one orientation.

    Parameters
    ----------
    points : ndarray, (m, 3)
        Each slice's pixel (0, 0), mm.
    axes : ndarray, (2, 3)
        Unit vectors of increasing column and of increasing row.
    names : sequence of str
        For messages.
    thickness : ndarray, (m), or None
        Slabs' own thickness, mm: it never places a slice, but where it changes the pitch may change too.
    pixel : float
        mm, the smaller side of a pixel.
    allow_gaps : bool
        Keep a gap that is taken for a missing slice.

    Raises
    ------
    InputError
        Fewer than two slices, two at one place, a missing slice, or slices beside the common line.

    Examples
    --------
    >>> points = np.array([[0.0, 0, 8], [0, 0, 0], [0, 0, 4]])
    >>> placed = place_slices(points, np.eye(3)[:2], "abc", None, 1.0)
    >>> placed.order, placed.positions
    (array([1, 2, 0]), array([0., 4., 8.]))
    """
    along = points @ normal_of(axes)
    order = np.argsort(along, kind="stable")
    z, named = along[order], [names[k] for k in order]
    if len(z) < 2:
        raise InputError("one slice makes no body", found=named[0] if named else "none")
    gaps = np.diff(z)
    usual = float(np.median(gaps))
    _refuse_duplicates(gaps, usual, named)
    slab = None if thickness is None else thickness[order]
    notices = list(_gap_notices(gaps, slab, named, allow=allow_gaps))
    direction = _direction(points[order], z, axes, pixel, named)
    notices += _tilt_notice(direction, axes)
    affine = np.eye(4)
    affine[:3, 0], affine[:3, 1], affine[:3, 2] = axes[0], axes[1], direction
    affine[:3, 3] = points[order[0]] - direction * z[0]
    return Placed(order.astype(np.int64), frozen_floats(z), frozen_floats(affine), tuple(notices))


def _refuse_duplicates(gaps: FloatArray, usual: float, names: Sequence[str]) -> None:
    same = np.flatnonzero(gaps <= SAME_PLACE * max(usual, float(gaps.max())))
    if not len(same):
        return
    first = int(same[0])
    more = f", and {len(same) - 1} more pairs" if len(same) > 1 else ""
    raise InputError(
        "slices lie at the same place",
        found=f"{names[first]} and {names[first + 1]}, {gaps[first]:.3g} mm apart{more}",
        expected="one slice at each place",
        fix="move the copy out of the folder; of repeated volumes (echoes, time points) choose one with "
        "--set dicom.volume=1",
    )


def _gap_notices(
    gaps: FloatArray, slab: FloatArray | None, names: Sequence[str], *, allow: bool
) -> list[Notice]:
    """Return what is to be told of the gaps.

    Raises
    ------
    InputError
        A gap is taken for a missing slice, and that is not allowed.
    """
    expected = _expected_gaps(gaps, slab)
    worst = int(np.argmax(gaps / expected))
    between = f"{gaps[worst]:.4g} mm between {names[worst]} and {names[worst + 1]}"
    if gaps[worst] > MISSING * expected[worst]:
        if not allow:
            raise InputError(
                "a slice is missing",
                found=between,
                expected=f"{expected[worst]:.4g} mm as between the others",
                fix="put the missing file back; if the scan was made so, give --set dicom.allow_gaps=true",
            )
        return [Notice("gap", f"{between}, {expected[worst]:.4g} mm between others: kept as allowed")]
    if np.ptp(gaps) > UNEVEN * float(np.median(gaps)):
        text = f"gaps from {gaps.min():.4g} to {gaps.max():.4g} mm are kept as they are; {between}"
        return [Notice("uneven-spacing", text)]
    return []


def _expected_gaps(gaps: FloatArray, slab: FloatArray | None) -> FloatArray:
    """Return the usual gap everywhere, in proportion to the slabs where their thickness changes.

    Usual is the lower quartile: where every other slice of one half is missing, the median misses it.
    """
    mean = np.ones(len(gaps)) if slab is None else 0.5 * (slab[:-1] + slab[1:])
    return np.asarray(float(np.quantile(gaps / mean, 0.25)) * mean)


def _direction(
    points: FloatArray, z: FloatArray, axes: FloatArray, pixel: float, names: Sequence[str]
) -> FloatArray:
    """Return the line on which pixel (0, 0) moves, per mm along the normal.

    Raises
    ------
    InputError
        A slice lies beside that line.
    """
    aside = points @ axes.T
    slope = np.median((aside[1:] - aside[0]) / (z[1:] - z[0])[:, None], axis=0)
    off = np.abs(aside - aside[0] - np.outer(z - z[0], slope)).max(axis=1)
    if off.max() > ASIDE * pixel:
        worst = int(np.argmax(off))
        raise InputError(
            "slices are shifted sideways by unequal steps",
            where=names[worst],
            found=f"{off[worst]:.3g} mm beside the line through the others",
            expected=f"at most {ASIDE * pixel:.3g} mm, a quarter of a pixel",
            fix="resample the series on one grid",
        )
    direction: FloatArray = normal_of(axes) + slope @ axes
    return direction


def _tilt_notice(direction: FloatArray, axes: FloatArray) -> list[Notice]:
    sideways = direction @ axes.T
    degrees = float(np.degrees(np.arctan(np.hypot(*sideways))))
    if degrees < TILT:
        return []
    return [
        Notice("tilt", f"the slices are sheared by {degrees:.2f}° (gantry tilt); put right in the geometry")
    ]
