"""Volume and area enclosed by bicubic patches, by Gauss quadrature and the divergence theorem."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, bernstein_slope, patch_planes

FloatArray = NDArray[np.float64]

AT_ONCE = 1024
"""Patches integrated at once, so that what is in between stays in the processor's cache."""


@lru_cache
def gauss_unit(degree: int) -> tuple[FloatArray, FloatArray]:
    """Return Gauss-Legendre nodes and weights on [0, 1] exact to the given polynomial degree.

    Examples
    --------
    >>> x, w = gauss_unit(5)
    >>> bool(abs(w @ x**5 - 1 / 6) < 1e-15)
    True
    """
    x, w = np.polynomial.legendre.leggauss(degree // 2 + 1)
    return 0.5 * (x + 1.0), 0.5 * w


def volume_and_area(patches: FloatArray, origin: FloatArray, degree: int = 9) -> tuple[float, float]:
    """Return ⅓∮(P − O)·dA and ∮|dA| over patches.

    Parameters
    ----------
    patches : (..., 4, 4, 3) array
        Bézier control points [v, u], mm; dA = P_u × P_v du dv.
    origin : (3,) array
        O; over a closed surface the volume does not depend on it, near the body rounding is least.
    degree : int
        Degree of the Gauss rule in each direction. The volume's integrand has degree 8, so from
        degree 8 on the volume is exact; the area's is a square root and converges.

    Returns
    -------
    volume : float, mm³
    area : float, mm²
    """
    rules, weights = _surface_rule(degree)
    count = len(weights)
    volume, area = 0.0, 0.0
    for planes in _blocks(patches, origin):
        values = rules @ planes
        normal = _cross(values[:, count : 2 * count], values[:, 2 * count :])
        volume += float(weights @ np.einsum("dgn,dgn->g", values[:, :count], normal))
        area += float((weights @ _lengths(normal)).sum())
    return volume / 3.0, area


def patch_areas(patches: FloatArray, degree: int = 9) -> FloatArray:
    """Return the area of each of (..., 4, 4, 3) patches, mm², as `volume_and_area` has their sum."""
    rules, weights = _surface_rule(degree)
    count = len(weights)
    areas = []
    for planes in _blocks(patches, np.zeros(3)):
        slopes = rules[count:] @ planes
        areas.append(weights @ _lengths(_cross(slopes[:, :count], slopes[:, count:])))
    return np.concatenate([np.zeros(0), *areas]).reshape(patches.shape[-4::-1]).T


def _blocks(patches: FloatArray, origin: FloatArray) -> Iterator[FloatArray]:
    """Yield the control points of about `AT_ONCE` patches at a time, (3, 16, patches), from the origin.

    The patches come in the order of the leading axes turned over, as a skin has them in memory.
    """
    planes = np.moveaxis(patch_planes(patches), 2, 0)
    planes = planes.reshape(3, 16, *planes.shape[3:])
    if planes.ndim != 4:
        planes = planes.reshape(3, 16, -1, 1)
    together = max(1, AT_ONCE // max(1, planes.shape[3]))
    for start in range(0, planes.shape[2], together):
        some = planes[:, :, start : start + together]
        yield np.subtract(some, origin[:, None, None, None], out=np.empty(some.shape)).reshape(3, 16, -1)


@lru_cache
def _surface_rule(degree: int) -> tuple[FloatArray, FloatArray]:
    """Return what makes P, P_u, P_v at g² Gauss points of control points, (3·g², 16), and weights (g²)."""
    x, w = gauss_unit(degree)
    value, slope = bernstein(x), bernstein_slope(x)
    parts = [np.kron(value, value), np.kron(value, slope), np.kron(slope, value)]
    return np.asarray(np.concatenate(parts)), np.asarray(np.kron(w, w))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a × b over the first axis."""
    result, back = np.empty(a.shape), np.empty(a.shape[1:])
    for k, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(a[i], b[j], out=result[k])
        np.multiply(a[j], b[i], out=back)
        result[k] -= back
    return result


def _lengths(vectors: FloatArray) -> FloatArray:
    """Return the lengths of vectors over the first axis; they are lost."""
    vectors *= vectors
    x, y, z = vectors
    x += y
    x += z
    return np.asarray(np.sqrt(x, out=x))


def plane_face(rim: FloatArray, origin: FloatArray) -> tuple[float, float]:
    """Return the same two integrals over the plane face inside a rim.

    Parameters
    ----------
    rim : (N, 4, 3) array
        Bézier segments of the closed plane rim, mm, counter-clockwise seen from outside.
    origin : (3,) array

    Returns
    -------
    volume : float, mm³
        ⅓ h·A with h the face's distance from the origin.
    area : float, mm²
    """
    x, w = gauss_unit(5)
    local = rim - origin
    point = np.matmul(bernstein(x), local)
    slope = np.matmul(bernstein_slope(x), local)
    centre = local[:, 0].mean(axis=0)
    vector = 0.5 * np.einsum("g,ngd->d", w, np.cross(point - centre, slope))
    area = float(np.sqrt(vector @ vector))
    return float(centre @ vector) / 3.0, area


def solid_integrals(
    patches: FloatArray, faces: tuple[float | None, float | None], affine: FloatArray, degree: int = 9
) -> tuple[float, float]:
    """Return volume and area of a tube of patches with its plane ends.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points in stack millimetres.
    faces : pair of float or None
        What each end's plane face adds to the area: 1 all of it, 0 nothing (the surface goes on in other
        tubes), -1 an opening in another tube's face; None: the tube ends in a pole.
    affine : (4, 4) array
        From stack to bench millimetres; a mirror or shear is allowed.
    degree : int
        As for `volume_and_area`.

    Returns
    -------
    volume : float, mm³
        Of the tube closed by plane faces; negative for an inward shell.
    area : float, mm²
    """
    linear = affine[:3, :3]
    placed = patches if (linear == np.eye(3)).all() else patches @ linear.T
    origin = placed[:, :, 0, 0].mean(axis=(0, 1))
    volume, area = volume_and_area(placed, origin, degree)
    for sign, rim in zip(faces, (placed[0, ::-1, 0, ::-1], placed[-1, :, -1]), strict=True):
        if sign is not None:
            part = plane_face(rim, origin)
            volume, area = volume + part[0], area + sign * part[1]
    return (volume if np.linalg.det(linear) > 0.0 else -volume), area
