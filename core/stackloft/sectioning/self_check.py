"""Whether the loft is what its sections say: its volume against the spline of their areas.

Two routes from the same sections: the lofted surface, and the integral of the spline through A(z). They err
differently, so a twisted, folded or wrongly linked skin shows as a difference; how far honest sections may
differ is learned from the half-lattices, every other section left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError

SLACK = 0.02
"""Difference always allowed, as a fraction of the volume between the outermost sections."""
DEGREE = 5
"""Of the Gauss rule: exact to far better than `SLACK`, in a third of the time that exact volumes take."""
HALVES = 2.0
"""How many times the half-lattices' disagreement is allowed on top."""


def check_against_areas(
    patches: FloatArray, rows: slice, z: FloatArray, areas: FloatArray, names: tuple[str, ...]
) -> None:
    """Raise InputError when the loft and its sections' areas disagree on the volume.

    Parameters
    ----------
    patches : (n - 1, N, 4, 4, 3) array
        The skin, ends included.
    rows : slice
        The patches between the first and the last section.
    z, areas : (m,) arrays
        Positions, mm, and areas, mm², of the sections.
    names : tuple of str
        Their names, for the message.
    """
    between = patches[rows]
    volume, _ = solid_integrals(between, (1.0, 1.0), np.eye(4), degree=DEGREE)
    expected = _integral(z, areas)
    allowed = SLACK * expected + HALVES * _half_lattices_apart(z, areas)
    if np.isfinite(volume) and abs(volume - expected) <= allowed:
        return
    worst = _worst_interval(between, z, areas)
    raise InputError(
        "the loft and the sections' areas disagree: neighbouring sections differ too much to be joined",
        where=f"{names[worst]} to {names[worst + 1]}",
        found=f"{volume:.4g} mm³ by the loft between the outermost sections",
        expected=f"{expected:.4g} ± {allowed:.2g} mm³ from their areas",
        fix="check the order and alignment of the slices, cut thinner slices, or use --method cavalieri",
    )


def _integral(z: FloatArray, areas: FloatArray) -> float:
    """Return ∫A dz by the spline through all areas (a straight line through two)."""
    if len(z) < 3:
        return float(0.5 * (areas[:-1] + areas[1:]) @ np.diff(z))
    return float(CubicSpline(z, areas).integrate(z[0], z[-1]))


def _half_lattices_apart(z: FloatArray, areas: FloatArray) -> float:
    """Return by how much every other section, first and last kept, changes the integral."""
    if len(z) < 4:
        return float(0.5 * np.abs(np.diff(areas)) @ np.diff(z))
    kept = np.unique(np.concatenate([np.arange(0, len(z), 2), [len(z) - 1]]))
    return abs(_integral(z[kept], areas[kept]) - _integral(z, areas))


def _worst_interval(between: FloatArray, z: FloatArray, areas: FloatArray) -> int:
    """Return the interval in which loft and areas differ most."""
    lofted = np.array(
        [
            solid_integrals(between[k : k + 1], (1.0, 1.0), np.eye(4), degree=DEGREE)[0]
            for k in range(len(z) - 1)
        ]
    )
    straight = 0.5 * (areas[:-1] + areas[1:]) * np.diff(z)
    return int(np.argmax(np.abs(lofted - straight)))


def fold_error(before: str, after: str) -> InputError:
    """Return the refusal of a skin that folds between two sections."""
    return InputError(
        "the loft folds between two sections: they differ too much to be joined",
        where=f"{before} to {after}",
        fix="check the order and alignment of the slices, cut thinner slices, or use --method cavalieri",
    )


@dataclass(frozen=True, slots=True, eq=False)
class TubeVolume:
    """A tube of a branched loft between the outermost sections."""

    patches: FloatArray
    """(rows, columns, 4, 4, 3) mm"""
    sign: float
    """-1 for a hole"""

    def volume(self) -> float:
        """Return the volume, mm³, ends closed by plane faces where they are no poles."""
        return self.sign * solid_integrals(self.patches, (1.0, 1.0), np.eye(4), degree=DEGREE)[0]


def check_tubes_against_areas(
    tubes: list[TubeVolume], courses: list[tuple[FloatArray, FloatArray]], names: tuple[str, ...]
) -> None:
    """Raise InputError when a branched loft and its sections' areas disagree on the volume.

    Parameters
    ----------
    tubes : list of TubeVolume
    courses : list of pairs of (m,) arrays
        Positions, mm, and areas, mm², of the sections: all loops together, less those that begin or end in a
        face between the outermost sections, where the areas jump; these each by themselves, holes negative.
    names : tuple of str
    """
    volume = sum(tube.volume() for tube in tubes)
    expected = sum(_integral(z, areas) for z, areas in courses)
    apart = sum(_half_lattices_apart(z, areas) for z, areas in courses)
    allowed = SLACK * abs(expected) + HALVES * apart
    if np.isfinite(volume) and abs(volume - expected) <= allowed:
        return
    raise InputError(
        "the loft and the sections' areas disagree: neighbouring sections differ too much to be joined",
        where=f"{names[0]} to {names[-1]}",
        found=f"{volume:.4g} mm³ by the loft between the outermost sections",
        expected=f"{expected:.4g} ± {allowed:.2g} mm³ from their areas",
        fix="check the order and alignment of the slices, cut thinner slices, or use --method cavalieri",
    )
