r"""A block of voxels as a stack of slabs: the slowest array axis is the stack's, right-handed in space.

::

    array (slice, row, column)      index ---(origin, direction, spacing)---> patient millimetres
    first slice may be the last one along column × row: then the stack runs through the array backwards
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, native
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft_plugins.readers.slice_geometry import place_slices


@dataclass(frozen=True, slots=True, eq=False)
class VoxelGrid:
    """Where the voxels of an array lie."""

    shape: tuple[int, int, int]
    """(slices, rows, columns)"""
    spacing: tuple[float, float]
    """(row, column) mm"""
    positions: FloatArray
    """(slices) mm along the slice direction, increasing with the index"""
    origin: FloatArray = field(default_factory=lambda: np.zeros(3))
    """(3) mm: the first voxel's centre"""
    direction: FloatArray = field(default_factory=lambda: np.eye(3))
    """(3, 3) unit vectors of increasing column, row and slice, as columns"""


def volume_stack(
    grid: VoxelGrid,
    picture: Callable[[int], Picture],
    path: Path,
    provenance: Mapping[str, str],
    notices: tuple[Notice, ...] = (),
    names: Sequence[str] | None = None,
) -> SliceStack:
    """Return the stack of an array's slices.

    Parameters
    ----------
    grid : VoxelGrid
    picture : callable
        Array index of a slice to its picture; safe to call from several threads.
    path : Path
        The file or folder, for names, messages and ``stack.toml``.
    provenance : mapping
        Who said the spacing.
    names : sequence of str, optional
        Of the slices, by array index; else the file's name with a number.

    Raises
    ------
    InputError
        Fewer than two slices, or a spacing that is not positive and finite.

    Examples
    --------
    >>> grid = VoxelGrid((3, 4, 5), (0.5, 0.5), np.array([0.0, 2.0, 4.0]), direction=np.diag([1.0, -1, 1]))
    >>> stack = volume_stack(grid, lambda k: np.full((4, 5), k), Path("a.nii"), {})
    >>> int(stack.decode(0)[0, 0]), stack.positions, stack.affine[:3, 2]
    (2, array([-4., -2.,  0.]), array([ 0.,  0., -1.]))
    """
    count = grid.shape[0]
    if count < 2:
        raise InputError(
            "one slice makes no body", where=str(path), found=f"{count} slice", expected="at least 2"
        )
    steps = np.diff(grid.positions)
    sides = np.array([*grid.spacing, *steps])
    if not (np.isfinite(sides).all() and (sides > 0).all()):
        raise InputError("impossible voxel spacing", where=str(path), found=f"{sides.min():g} mm")
    labels = list(names) if names is not None else [f"{path.name}[{k + 1}]" for k in range(count)]
    corners = grid.origin + np.outer(grid.positions - grid.positions[0], grid.direction[:, 2])
    placed = place_slices(corners, grid.direction[:, :2].T, labels, None, min(grid.spacing), allow_gaps=True)
    order = placed.order
    folder = path if path.is_dir() else path.parent
    return SliceStack(
        decode=_Decoder(picture, order),
        names=tuple(labels[k] for k in order),
        shape=(grid.shape[1], grid.shape[2]),
        positions=placed.positions,
        pixel_spacing=frozen_floats(np.tile(grid.spacing, (count, 1))),
        kind=SectionKind.SLAB,
        thickness=frozen_floats(_slabs(placed.positions)),
        affine=placed.affine,
        hints=load_stack_file(folder).hints(folder, {k: k for k in range(1, count + 1)}),
        notices=(*notices, *placed.notices),
        provenance=dict(provenance),
    )


class _Decoder:
    """Array slice by stack slice."""

    def __init__(self, picture: Callable[[int], Picture], order: IntArray) -> None:
        self._picture = picture
        self._order = tuple(int(k) for k in order)

    def __call__(self, number: int) -> Picture:
        return native(self._picture(self._order[number]))


def _slabs(z: FloatArray) -> FloatArray:
    """Return each voxel's own length along the axis: half-way to its neighbours."""
    gaps = np.diff(z)
    return np.asarray(0.5 * (np.concatenate([gaps[:1], gaps]) + np.concatenate([gaps, gaps[-1:]])))
