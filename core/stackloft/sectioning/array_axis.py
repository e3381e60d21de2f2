r"""Sections along another axis of a scan's array.

::

      slices k                 axis 1: pictures (slice, column) at every row
        |   rows r                     o------> columns c
        |  /                           |
        | /                            v slices k
        o------> columns c     axis 2: pictures (slice, row) at every column

Right-handed again: u, v in the new plane, n = u × v, and w = step / (step·n), so that shear stays in the
affine. The whole scan is in memory as its readers give it; nothing is resampled.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, frozen_floats, read_only
from stackloft.model.errors import InputError, UsageError
from stackloft.model.scale import scale_of_slices
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack

AXES = ("0", "1", "2", "auto")
"""What ``--axis`` may be: slices as they are, sections at every row, at every column, or the best of them."""
MEMORY = 2000.0
"""MB that a whole scan may take."""
EVEN = 1e-3
"""Relative difference up to which distances between slices are equal."""
OBLIQUE = 1e-3
"""Cosine between the new pictures' axes up to which they are perpendicular."""
_NAMES = {1: "row", 2: "column"}


def along_axis(stack: SliceStack, axis: int, memory: float = MEMORY) -> SliceStack:
    """Return a scan as sections across another axis of its array; all slices are decoded here.

    Parameters
    ----------
    stack : SliceStack
        Slabs at equal distances.
    axis : {0, 1, 2}
        0: the slices as they are.
    memory : float
        MB that the whole scan may take.

    Raises
    ------
    InputError
        A scan above `memory`, slices at unequal distances, or a shear that would make the pictures oblique.
    UsageError
        No scan, or one with remarks on single slices.

    Examples
    --------
    >>> volume = np.arange(24).reshape(2, 3, 4)
    >>> stack = SliceStack(lambda k: volume[k], ("a", "b"), (3, 4), np.array([0.0, 5.0]),
    ...                    np.full((2, 2), 0.5), SectionKind.SLAB)
    >>> rows = along_axis(stack, 1)
    >>> len(rows), rows.shape, rows.pixel_spacing[0].tolist()
    (3, (2, 4), [5.0, 0.5])
    >>> corner = rows.affine @ [0.0, 0.0, rows.positions[0], 1.0]
    >>> corner[:3].tolist(), rows.decode(0).tolist()
    ([0.0, 1.0, 0.0], [[8, 9, 10, 11], [20, 21, 22, 23]])
    """
    if axis == 0:
        return stack
    _check(stack, axis)
    turned = _turned(stack, axis)
    volume = _gathered(stack, memory)
    count = volume.shape[axis]
    order = np.argsort(turned.positions)
    z = frozen_floats(turned.positions[order])
    rows, columns = (side for k, side in enumerate(volume.shape) if k != axis)
    return replace(
        stack,
        decode=_Section(volume, axis, tuple(order.tolist())),
        names=tuple(f"{_NAMES[axis]} {k + 1}" for k in order),
        shape=(rows, columns),
        positions=z,
        pixel_spacing=frozen_floats(np.tile(turned.spacing, (count, 1))),
        thickness=frozen_floats(np.full(count, abs(turned.step))),
        affine=turned.affine,
        scale_uncertainty=scale_of_slices(stack.scale_uncertainty, np.zeros(count, dtype=np.int64)),
        provenance={**stack.provenance, "axis": f"{axis}: sections at every {_NAMES[axis]}"},
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Turned:
    """The new stack's geometry."""

    positions: FloatArray
    """(n) mm of the sections by array index; may run downwards"""
    step: float
    spacing: tuple[float, float]
    affine: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class _Section:
    """A decoder that cuts the volume."""

    volume: NDArray[Any]
    axis: int
    order: tuple[int, ...]

    def __call__(self, number: int) -> Picture:
        return read_only(np.ascontiguousarray(self.volume.take(self.order[number], axis=self.axis)))


def _check(stack: SliceStack, axis: int) -> None:
    if stack.kind is not SectionKind.SLAB or stack.origins is not None:
        raise UsageError("only scans have more than one axis", where="--axis", found=f"{axis}", expected="0")
    if stack.hints.slices:
        raise UsageError(
            "stack.toml tells of single slices, which another axis does not have",
            where="--axis",
            found=f"slice {min(stack.hints.slices)}",
            fix="take [slice.…] out of stack.toml, or use --axis 0",
        )
    gaps = np.diff(stack.positions)
    if len(gaps) < 1 or np.ptp(gaps) > EVEN * float(gaps.mean()):
        raise InputError(
            "slices lie at unequal distances, so that sections along another axis have no one pixel size",
            where="--axis",
            found=f"{gaps.min():.4g} to {gaps.max():.4g} mm" if len(gaps) else "one slice",
            fix="use --axis 0",
        )


def _turned(stack: SliceStack, axis: int) -> _Turned:
    """Return where the sections lie.

    Raises
    ------
    InputError
        The pictures' axes would not be perpendicular.
    """
    row, column = stack.pixel_spacing.mean(axis=0)
    pitch = float(np.diff(stack.positions).mean())
    steps = stack.affine[:3, :3] * np.array([column, row, pitch])  # columns: along columns, rows, slices
    across, along = (steps[:, 0], steps[:, 1]) if axis == 1 else (steps[:, 1], steps[:, 0])
    down = steps[:, 2]
    sides = float(np.linalg.norm(down)), float(np.linalg.norm(across))
    u, v = across / sides[1], down / sides[0]
    if abs(float(u @ v)) > OBLIQUE:
        raise InputError(
            "the slices are sheared along this axis (gantry tilt), so that its sections would be oblique",
            where=f"--axis {axis}",
            found=f"{np.degrees(np.arccos(u @ v)):.2f}° between the pictures' axes",
            expected="90°",
            fix=f"use --axis 0 or {3 - axis}",
        )
    normal = np.cross(u, v)
    step = float(along @ normal)
    affine = np.eye(4)
    affine[:3, 0], affine[:3, 1], affine[:3, 2] = u, v, along / step
    affine[:3, 3] = (stack.affine @ [0.0, 0.0, float(stack.positions[0]), 1.0])[:3]
    count = stack.shape[0] if axis == 1 else stack.shape[1]
    return _Turned(frozen_floats(step * np.arange(count)), step, sides, frozen_floats(affine))


def _gathered(stack: SliceStack, memory: float) -> NDArray[Any]:
    """Return the whole scan, (slices, rows, columns).

    Raises
    ------
    InputError
        It is larger than `memory`.
    """
    first = stack.decode(0)
    size = len(stack) * first.size * first.dtype.itemsize / 1e6
    if size > memory:
        raise InputError(
            "sections along another axis need the whole scan in memory",
            where="--axis",
            found=f"{size:.0f} MB",
            expected=f"at most {memory:g} MB",
            fix="raise the option memory (--set segmenter.memory=…), or use --axis 0",
        )
    volume = np.empty((len(stack), *first.shape), dtype=first.dtype)
    for k in range(len(stack)):
        picture = stack.decode(k)
        if not np.can_cast(picture.dtype, volume.dtype, "safe"):
            volume = volume.astype(np.result_type(volume.dtype, picture.dtype))
        volume[k] = picture
    return volume
