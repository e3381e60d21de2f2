r"""From closed planar contours to sections: one normal for all, planes told apart along it.

::

      n ^   ( o )   z_2        n: the mean direction of the contours' vector areas (Newell), largest first;
        |  (  o  )  z_1        a contour that does not lie in a plane across n is refused;
        |   ( o )   z_0        contours of one plane together make the section, by the even–odd rule
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.keyhole import split_keyhole
from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.sectioning.corners import polygon_corners
from stackloft.sectioning.nesting import nesting_depths

SAME_PLANE = 0.05
"""Planes nearer than this fraction of the usual gap are one."""
MISSING = 1.5
"""A gap longer than this many usual ones is told."""
UNEVEN = 0.01
_FLAT = 2e-3
"""How far a contour may leave its plane, as a fraction of its width."""
_CHECKED = 1500
"""Vertices of a loop up to which self-crossing is looked for: it takes memory with their square."""


@dataclass(frozen=True, slots=True, eq=False)
class Planes:
    """Sections of one region."""

    sections: tuple[Section, ...]
    affine: FloatArray
    """(4, 4) from stack to patient millimetres: a rotation."""
    notices: tuple[Notice, ...]


def planar_sections(contours: list[FloatArray], where: str) -> Planes:
    """Return the sections that closed planar contours make.

    Parameters
    ----------
    contours : list of ndarray, (k, 3)
        Closed curves, patient mm, in any order and direction.
    where : str
        File and region, for messages.

    Raises
    ------
    InputError
        Contours that are not planar, lie in planes of several directions, cross themselves or each other,
        or lie in one plane alone.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
    >>> planes = planar_sections([square + [0, 0, 3], square], "a.dcm")
    >>> [section.z for section in planes.sections], planes.sections[0].loops[0].signed_area
    ([0.0, 3.0], 16.0)
    """
    axes = _axes(contours)
    flat = [points @ axes.T for points in contours]
    heights = np.array([_height(points, where) for points in flat])
    groups = _grouped(heights, where)
    sections = tuple(
        _section(float(heights[group].mean()), [flat[k][:, :2] for k in group], f"{where}, plane {number}")
        for number, group in enumerate(groups, start=1)
    )
    affine = np.eye(4)
    affine[:3, :3] = axes.T
    return Planes(sections, frozen_floats(affine), _notices(np.array([one.z for one in sections]), where))


def _axes(contours: list[FloatArray]) -> FloatArray:
    """Return rows x, y and normal of the planes, right-handed."""
    areas = np.array([vector_area(points) for points in contours])
    _, _, rows = np.linalg.svd(areas, full_matrices=False)
    normal = rows[0] * np.sign(rows[0][np.argmax(np.abs(rows[0]))])
    normal = np.where(np.abs(normal) < 1e-9, 0.0, normal)
    normal /= np.linalg.norm(normal)
    towards = np.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
    across = towards - (towards @ normal) * normal
    across /= np.linalg.norm(across)
    return np.array([across, np.cross(normal, across), normal])


def vector_area(points: FloatArray) -> FloatArray:
    """Return the area of a closed curve as a vector along its normal (Newell), mm²."""
    own = points - points.mean(axis=0)
    return np.asarray(0.5 * np.cross(own, np.roll(own, -1, axis=0)).sum(axis=0))


def _height(points: FloatArray, where: str) -> float:
    """Return where a contour's plane lies along the normal.

    Raises
    ------
    InputError
        The contour does not lie in a plane across the normal.
    """
    z = points[:, 2]
    width = float(np.ptp(points, axis=0).max())
    if float(np.ptp(z)) > _FLAT * width:
        raise InputError(
            "a contour leaves the plane in which most lie",
            where=where,
            found=f"{np.ptp(z):.3g} mm along the normal, in a contour {width:.3g} mm wide",
            expected="contours in parallel planes",
            fix="the file is damaged, or the region was drawn in views of several directions: "
            "export it from one view",
        )
    return float(np.median(z))


def _grouped(heights: FloatArray, where: str) -> list[list[int]]:
    """Return the contours of each plane, from below.

    Raises
    ------
    InputError
        All lie in one plane.
    """
    order = np.argsort(heights, kind="stable")
    gaps = np.diff(heights[order])
    real = gaps[gaps > 1e-3 * float(gaps.max(initial=0.0))]
    if not len(real) or not gaps.max() > 0:
        raise InputError(
            "one section makes no body", where=where, found="contours in one plane", expected="at least 2"
        )
    cuts = np.flatnonzero(gaps > SAME_PLANE * float(np.median(real))) + 1
    return [group.tolist() for group in np.split(order, cuts)]


def _section(z: float, contours: list[FloatArray], name: str) -> Section:
    pieces = [piece for points in contours for piece in split_keyhole(_cleaned(points))]
    loops = [piece for piece in pieces if _encloses(piece)]
    if not loops:
        raise InputError("a contour encloses no area", where=name)
    for loop in loops:
        if len(loop) <= _CHECKED and crosses_itself(loop[None])[0]:
            raise InputError(
                "a contour crosses itself",
                where=name,
                fix="the file is damaged, or repair it where it was drawn",
            )
    depths = nesting_depths(loops, name)
    made = [_oriented(loop, hole=depth % 2 == 1) for loop, depth in zip(loops, depths, strict=True)]
    return Section(z, tuple(sorted(made, key=lambda loop: -loop.signed_area)), name)


def _cleaned(points: FloatArray) -> FloatArray:
    """Return the vertices without those that repeat the one before."""
    step = np.abs(points - np.roll(points, 1, axis=0)).max(axis=1)
    kept = points[step > 1e-6 * float(np.ptp(points, axis=0).max())]
    return kept if len(kept) >= 3 else points


def _encloses(points: FloatArray) -> bool:
    return abs(Loop(points).signed_area) > 1e-6 * float(np.ptp(points, axis=0).max()) ** 2


def _oriented(points: FloatArray, *, hole: bool) -> Loop:
    """Return a loop that runs counter-clockwise, a hole clockwise."""
    if (Loop(points).signed_area < 0) is not hole:
        points = points[::-1]
    return Loop(frozen_floats(points), polygon_corners(points), hole)


def _notices(z: FloatArray, where: str) -> tuple[Notice, ...]:
    gaps = np.diff(z)
    usual = float(np.quantile(gaps, 0.25))
    wide = np.flatnonzero(gaps > MISSING * usual)
    if len(wide):
        worst = int(np.argmax(gaps))
        text = (
            f"{where}: {len(wide)} gaps without a contour; the widest is {gaps[worst]:.4g} mm from "
            f"z = {z[worst]:.4g} mm, {usual:.4g} mm between others: what lies there is interpolated"
        )
        return (Notice("gap", text),)
    if np.ptp(gaps) > UNEVEN * usual:
        text = f"{where}: gaps from {gaps.min():.4g} to {gaps.max():.4g} mm are kept as they are"
        return (Notice("uneven-spacing", text),)
    return ()
