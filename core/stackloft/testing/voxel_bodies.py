"""Ellipsoids as voxels, in any pose and at any spacing, for methods that count."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from stackloft.model.arrays import BoolArray, FloatArray, frozen_floats
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack


def ellipsoid_mask(
    axes: ArrayLike, rotation: FloatArray, spacing: ArrayLike, phase: ArrayLike = (0.0, 0.0, 0.0)
) -> BoolArray:
    """Return which voxel centres lie in an ellipsoid, (slices, rows, columns).

    Parameters
    ----------
    axes : (3,)
        Semi-axes, mm.
    rotation : (3, 3) array
        Body to grid.
    spacing : (3,)
        Column, row and slice step, mm.
    phase : (3,)
        Where the body's centre lies between grid points, in steps.

    Examples
    --------
    >>> mask = ellipsoid_mask((10, 10, 10), np.eye(3), (0.5, 0.5, 2.0))
    >>> mask.shape, bool(abs(mask.sum() * 0.5 / (4000 / 3 * np.pi) - 1) < 0.03)
    ((13, 43, 43), True)
    """
    steps = np.asarray(spacing, dtype=float)
    form = rotation @ np.diag(1.0 / np.square(np.asarray(axes, dtype=float))) @ rotation.T
    half = np.sqrt(np.diag(np.linalg.inv(form)))
    counts = np.ceil(half / steps).astype(int) + 1
    x, y, z = (
        (np.arange(-n, n + 1) + p) * s
        for n, p, s in zip(counts, np.asarray(phase, float), steps, strict=True)
    )
    across = (
        form[0, 0] * x[None, :] ** 2 + form[1, 1] * y[:, None] ** 2 + 2 * form[0, 1] * x[None, :] * y[:, None]
    )
    lean = 2.0 * (form[0, 2] * x[None, :] + form[1, 2] * y[:, None])
    return np.stack([across + height * lean + form[2, 2] * height**2 < 1.0 for height in z])


def ellipsoid_coverage(
    axes: ArrayLike,
    rotation: FloatArray,
    spacing: ArrayLike,
    phase: ArrayLike = (0.0, 0.0, 0.0),
    fine: int = 5,
) -> FloatArray:
    """Return how much of each voxel the ellipsoid fills, 0 to 1, sampled at ``fine³`` places inside it.

    Examples
    --------
    >>> covered = ellipsoid_coverage((5, 5, 5), np.eye(3), (1.0, 1.0, 1.0))
    >>> bool(abs(covered.sum() / (500 / 3 * np.pi) - 1) < 1e-2)
    True
    """
    steps = np.asarray(spacing, dtype=float)
    # the fine grid has a node at the middle of every voxel when `fine` is odd
    mask = ellipsoid_mask(axes, rotation, steps / fine, np.asarray(phase, dtype=float) * fine)
    wide = [(-((n // 2) - fine // 2) % fine, -((n // 2) - fine // 2) % fine) for n in mask.shape]
    whole = np.pad(mask, wide)
    m, rows, columns = (n // fine for n in whole.shape)
    return np.asarray(whole.reshape(m, fine, rows, fine, columns, fine).mean(axis=(1, 3, 5)))


def voxel_body(
    values: FloatArray | BoolArray, spacing: ArrayLike, *, labels: bool, kind: SectionKind = SectionKind.SLAB
) -> Segmentation:
    """Return voxels as a Segmentation with its level half-way between 0 and 1.

    Parameters
    ----------
    values : (slices, rows, columns) array
        Coverage, or a mask.
    spacing : (3,)
        Column, row and slice step, mm.
    labels : bool
        True for a label map.
    """
    column, row, pitch = (float(step) for step in np.asarray(spacing, dtype=float))
    m = len(values)
    grey = np.pad(100.0 * values, ((0, 0), (4, 4), (4, 4)))
    stack = SliceStack(
        lambda k: grey[k].copy(),
        tuple(f"slice {k + 1}" for k in range(m)),
        (grey.shape[1], grey.shape[2]),
        frozen_floats(pitch * np.arange(m) + 17.0),
        frozen_floats(np.tile([row, column], (m, 1))),
        kind,
        frozen_floats(np.full(m, pitch)),
    )
    return Segmentation(stack, lambda _, picture: SectionField(picture, 50.0), binary=labels)
