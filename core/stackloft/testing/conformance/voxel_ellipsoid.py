"""The kit's ellipsoid as a scan: slabs whose grey levels are the fraction that the body fills."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack

MARGIN = 9
"""Pixels around the body, enough for a crop to begin elsewhere."""
BACKGROUND, BODY = 30.0, 180.0
_SHIFT = (0.37, -0.21, 0.11)
"""Voxels from the grid's middle back to the body's."""
_FINE = (np.arange(5) - 2) / 5
"""Places inside a voxel at which it is asked whether the body fills it."""


def scan(axes: tuple[float, float, float], centre: FloatArray, fineness: int) -> Segmentation:
    """Return an ellipsoid with semi-axes along x, y, z (mm) on about ``8·fineness`` slabs.

    Pixels are 0.6 and 0.5 of the pitch wide and high, and the body lies at odd fractions of them.
    """
    pitch = 2.0 * axes[2] / (8 * fineness)
    spacing = np.array([0.6 * pitch, 0.5 * pitch, pitch])
    half = [int(np.ceil(a / s)) + m for a, s, m in zip(axes, spacing, (MARGIN, MARGIN, 2), strict=True)]
    volume = _coverage(axes, tuple(spacing), tuple(half))
    m, rows, columns = volume.shape
    affine = np.eye(4)
    affine[:3, 3] = centre + spacing * (np.array(_SHIFT) - half)
    stack = SliceStack(
        lambda k: volume[k].copy(),
        tuple(f"slice {k + 1}" for k in range(m)),
        (rows, columns),
        frozen_floats(pitch * np.arange(m)),
        frozen_floats(np.tile(spacing[1::-1], (m, 1))),
        SectionKind.SLAB,
        frozen_floats(np.full(m, pitch)),
        affine=frozen_floats(affine),
    )
    level = 0.5 * (BACKGROUND + BODY)
    return Segmentation(
        stack, lambda _, picture: SectionField(frozen_floats(picture), level, threshold=level)
    )


@lru_cache(maxsize=4)
def _coverage(
    axes: tuple[float, float, float], spacing: tuple[float, ...], half: tuple[int, ...]
) -> FloatArray:
    """Return the slabs' grey levels, (slices, rows, columns)."""
    x, y, z = (
        ((np.arange(-n, n + 1)[:, None] + o + _FINE) * s / a).ravel() ** 2
        for n, o, s, a in zip(half, _SHIFT, spacing, axes, strict=True)
    )
    covered = np.zeros((2 * half[2] + 1, 2 * half[1] + 1, 2 * half[0] + 1))
    for k, height in enumerate(z):
        inside = (y[:, None] + x[None, :] + height < 1.0).reshape(2 * half[1] + 1, 5, 2 * half[0] + 1, 5)
        covered[k // 5] += inside.mean(axis=(1, 3)) / 5
    return frozen_floats(BACKGROUND + (BODY - BACKGROUND) * covered)
