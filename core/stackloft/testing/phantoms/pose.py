"""Rigid poses: X = R·X_body + offset."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError


def euler(x: float, y: float, z: float) -> FloatArray:
    """Return the rotation by `x`, then `y`, then `z` degrees about the fixed axes, (3, 3).

    Examples
    --------
    >>> (euler(0, 0, 90) @ [1.0, 0.0, 0.0]).round(12).tolist()
    [0.0, 1.0, 0.0]
    """
    result = np.eye(3)
    for axis, degrees in enumerate((x, y, z)):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[i, i] = turn[j, j] = c
        turn[i, j], turn[j, i] = -s, s
        result = turn @ result
    return result


def random_rotation(seed: int) -> FloatArray:
    """Return a rotation drawn uniformly (Shoemake 1992: a normalised Gaussian quaternion), (3, 3).

    Examples
    --------
    >>> R = random_rotation(3)
    >>> bool(np.allclose(R @ R.T, np.eye(3))), round(float(np.linalg.det(R)), 12)
    (True, 1.0)
    """
    w, x, y, z = (q := np.random.default_rng(seed).normal(size=4)) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def rotation_matrix(rotation: ArrayLike | int | None) -> FloatArray:
    """Return the rotation meant by a (3, 3) matrix, three Euler angles in degrees, a seed, or None.

    Raises
    ------
    UsageError
        Neither of these, or a matrix that is no rotation.

    Examples
    --------
    >>> bool(np.allclose(rotation_matrix((0, 90, 0)), euler(0, 90, 0)))
    True
    """
    if rotation is None:
        return np.eye(3)
    if isinstance(rotation, int) and not isinstance(rotation, bool):
        return random_rotation(rotation)
    values = np.asarray(rotation, dtype=float)
    if values.shape == (3,) and np.isfinite(values).all():
        return euler(*values)
    if values.shape == (3, 3) and np.allclose(values @ values.T, np.eye(3), atol=1e-12):
        if np.linalg.det(values) > 0:
            return values
        raise UsageError("a mirror image, not a rotation", where="rotation", found="determinant -1")
    raise UsageError(
        "not a rotation",
        where="rotation",
        found=f"shape {values.shape}",
        expected="a (3, 3) rotation matrix, three Euler angles in degrees, or a seed",
    )
