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
PLACES = ((0.37, -0.21, 0.11), (-0.08, 0.44, -0.27), (0.19, 0.03, 0.46))
"""Voxels from the grid's middle back to the body's, each another case of where a body may lie."""
_FINE = (np.arange(5) - 2) / 5
"""Places across a voxel's row and slice at which it is asked how far the body fills it along x."""


def scan(axes: tuple[float, float, float], centre: FloatArray, fineness: int, place: int = 0) -> Segmentation:
    """Return an ellipsoid with semi-axes along x, y, z (mm) on about ``8·fineness`` slabs.

    Pixels are 0.6 and 0.5 of the pitch wide and high, and the body lies at odd fractions of them, those of
    ``PLACES[place]``.
    """
    pitch = 2.0 * axes[2] / (8 * fineness)
    spacing = np.array([0.6 * pitch, 0.5 * pitch, pitch])
    half = [int(np.ceil(a / s)) + m for a, s, m in zip(axes, spacing, (MARGIN, MARGIN, 2), strict=True)]
    shift = PLACES[place]
    volume = _coverage(axes, tuple(spacing), tuple(half), shift)
    m, rows, columns = volume.shape
    affine = np.eye(4)
    affine[:3, 3] = centre + spacing * (np.array(shift) - half)
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
    axes: tuple[float, float, float],
    spacing: tuple[float, ...],
    half: tuple[int, ...],
    shift: tuple[float, ...],
) -> FloatArray:
    """Return the slabs' grey levels, (slices, rows, columns); lines along x are measured exactly."""
    y, z = (
        ((np.arange(-n, n + 1)[:, None] + o + _FINE) * s / a) ** 2
        for n, o, s, a in zip(half[1:], shift[1:], spacing[1:], axes[1:], strict=True)
    )
    edges = np.arange(-half[0], half[0] + 2) + shift[0] - 0.5
    covered = np.empty((len(z), len(y), len(edges) - 1))
    for k, heights in enumerate(z):
        chord = np.sqrt(np.maximum(1.0 - y[:, :, None] - heights, 0.0)).reshape(len(y), -1, 1) * axes[0]
        covered[k] = np.diff(np.clip(edges, -chord / spacing[0], chord / spacing[0])).mean(axis=1)
    return frozen_floats(BACKGROUND + (BODY - BACKGROUND) * covered)
