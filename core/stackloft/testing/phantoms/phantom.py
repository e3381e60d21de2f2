"""A posed body whose volume, area and sections are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import UsageError
from stackloft.model.slice_stack import Hints, SectionKind
from stackloft.testing.phantoms.body import Body, Plane
from stackloft.testing.phantoms.extent import furthest, sample
from stackloft.testing.phantoms.placing import Placing, section_positions
from stackloft.testing.phantoms.plane_cut import PlaneCut
from stackloft.testing.phantoms.polygon_cut import polygon_section
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.phantoms.tracing import trace

EndName = Literal["face", "round", "point", "auto"]
_FLUSH = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Phantom:
    """A body in a pose: X = rotation·X_body + offset, millimetres.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> ball = phantoms.make("ellipsoid", a=30, b=30, c=30)
    >>> round(ball.volume, 6), [round(z, 9) for z in ball.extent()]
    (113097.335529, [-30.0, 30.0])
    >>> loop, = ball.section(18.0, points=100)
    >>> bool(np.allclose(np.hypot(*loop.points.T), 24.0, rtol=1e-12))
    True
    """

    name: str
    body: Body
    rotation: FloatArray = field(default_factory=lambda: np.eye(3))
    """(3, 3) body to bench"""
    offset: FloatArray = field(default_factory=lambda: np.zeros(3))
    """(3) mm"""
    _cache: dict[str, FloatArray] = field(default_factory=dict, repr=False)

    @property
    def volume(self) -> float:
        """Exact volume, mm³ (relative error below 1e-9)."""
        return self.body.volume

    @property
    def area(self) -> float:
        """Exact surface area, mm² (relative error below 1e-9)."""
        return self.body.area

    @property
    def height(self) -> float:
        """Length along z, mm."""
        low, high = self.extent()
        return high - low

    def posed(self, rotation: ArrayLike | int | None = None, offset: ArrayLike = (0.0, 0.0, 0.0)) -> Phantom:
        """Return the body turned further by `rotation` about the origin, then moved by `offset` mm.

        `rotation` is a (3, 3) matrix, three Euler angles in degrees (about x, then y, then z), or a
        seed for a random one.
        """
        turn = rotation_matrix(rotation)
        move = np.asarray(offset, dtype=float)
        return Phantom(
            self.name,
            self.body,
            frozen_floats(turn @ self.rotation),
            frozen_floats(turn @ self.offset + move),
        )

    def extent(self) -> tuple[float, float]:
        """Return the least and greatest z of the body, mm."""
        low, high = self._poles()[:, 2]
        return float(low), float(high)

    @property
    def plane_ends(self) -> tuple[bool, bool]:
        """Whether the body ends in a plane face across z, below and above."""
        return self.end_kinds[0] == "face", self.end_kinds[1] == "face"

    @property
    def end_kinds(self) -> tuple[EndName, EndName]:
        """How the body ends below and above: a plane ``face``, a sharp ``point``, a smooth ``round`` pole,
        or ``auto`` where an edge comes first (a tilted cylinder) and no word fits."""  # noqa: D205, D209
        return self._end_kind(0), self._end_kind(1)

    def section(self, z: float, points: int = 400) -> tuple[Loop, ...]:
        """Return the loops in which the plane at `z` cuts the body.

        Points lie on the boundary to rounding, about equally far apart along the loop; true corners
        are among them and listed. Outer loops run counter-clockwise in (x, y), holes clockwise. A
        convex polyhedron's loop is its exact vertices and nothing else. At a plane end the section is
        the face itself.

        Parameters
        ----------
        z : float
            mm, within the body's extent.
        points : int
            About how many points a loop gets.

        Raises
        ------
        UsageError
            The plane misses the body or touches it in a point.
        """
        low, high = self.extent()
        slack = _FLUSH * (high - low)
        if not (low - slack <= z <= high + slack) or points < 8:
            raise UsageError("no such section", where=self.name, found=f"z = {z:g} mm, {points} points",
                             expected=f"z in {low:g} to {high:g} mm and at least 8 points")  # fmt: skip
        kept = [i for i, piece in enumerate(self.body.fields) if not self._is_flush(piece, z)]
        fields = [self.body.fields[i] for i in kept]
        if self.body.polyhedral:
            planes = [piece for piece in fields if isinstance(piece, Plane)]
            loops = polygon_section(planes, self.rotation, self.offset, z)
        else:
            box = self._box(z)
            size = float((box[1] - box[0]).max())
            parts = tuple(tuple(kept.index(i) for i in part if i in kept) for part in self.body.parts)
            cut = PlaneCut(tuple(fields), self.rotation, self.offset, z, size, parts)
            loops = trace(cut, box, points, self.body.detail) if size else ()
        if not loops:
            raise UsageError("the plane only touches the body", where=self.name, found=f"z = {z:g} mm")
        return loops

    def contour_stack(
        self, sections: int = 11, placing: Placing | Sequence[float] = "mid", points: int = 400
    ) -> ContourStack:
        """Return exact sections as a stack.

        Parameters
        ----------
        sections : int
            How many; not used when positions are given.
        placing : {"mid", "faces"} or positions in mm
            ``mid``: slices of equal thickness over the body's height, each cut at mid-thickness.
            ``faces``: the body cut into slices from its plane end, each seen on its face, so that a
            plane end is itself a section (`stackloft.testing.phantoms.placing`).
        points : int
            About how many points a loop gets.
        """
        z = self.positions(sections, placing)
        cuts = [
            Section(float(height), self.section(float(height), points), f"section_{i:02d}")
            for i, height in enumerate(z, start=1)
        ]
        return ContourStack(
            tuple(cuts),
            kind=SectionKind.FACE,
            exact=True,
            hints=Hints(specimen=self.name),
            provenance={"phantom": self.name},
        )

    def positions(self, sections: int = 11, placing: Placing | Sequence[float] = "mid") -> FloatArray:
        """Return where the sections lie, mm, increasing."""
        return section_positions(self.extent(), self.plane_ends, sections, placing)

    def _poles(self) -> FloatArray:
        """Return the lowest and the highest point, (2, 3) mm."""
        if "poles" not in self._cache:
            up = self.rotation[2]
            ends = []
            for direction in (-up, up):
                points = np.column_stack([furthest(patch, direction) for patch in self.body.patches])
                ends.append(self.rotation @ points[:, np.argmax(direction @ points)] + self.offset)
            self._cache["poles"] = np.array(ends)
        return self._cache["poles"]

    def _end_kind(self, end: int) -> EndName:
        pole = self._poles()[end]
        if any(self._is_flush(piece, float(pole[2])) for piece in self.body.fields):
            return "face"
        own = self.rotation.T @ (pole - self.offset)
        if len(self.body.tips) and np.linalg.norm(self.body.tips - own, axis=1).min() < 1e-6 * self.height:
            return "point"
        values = np.array([piece(own[:, None])[0] for piece in self.body.fields])
        return (
            "round"
            if np.count_nonzero(np.abs(values) < 1e-7 * max(1.0, float(np.abs(values).max()))) == 1
            else "auto"
        )

    def _is_flush(self, piece: object, z: float) -> bool:
        """Tell whether `piece` is a plane across z that lies at `z`."""
        if not isinstance(piece, Plane):
            return False
        normal = self.rotation @ piece.normal
        if abs(abs(normal[2]) - 1) > _FLUSH**2 and np.hypot(normal[0], normal[1]) > _FLUSH:
            return False
        level = piece.distance * np.sign(normal[2]) + self.offset[2]
        return bool(abs(level - z) <= _FLUSH * (1 + abs(z)))

    def _box(self, z: float) -> tuple[FloatArray, FloatArray]:
        """Return a rectangle about the section, from the sampled boundary."""
        crossings = np.concatenate(
            [_crossings(self._mesh(i), z) for i in range(len(self.body.patches))], axis=1
        )
        if not crossings.shape[1]:  # a cap too shallow for the samples: of the order of √(height · cap)
            poles = self._poles()
            cap = np.abs(poles[:, 2] - z)
            x, y, _ = poles[np.argmin(cap)]
            half = np.sqrt(cap.min() * np.ptp(poles[:, 2]))
            return np.array([x - half, y - half]), np.array([x + half, y + half])
        low, high = crossings.min(axis=1), crossings.max(axis=1)
        margin = 0.06 * (high - low).max()
        return low - margin, high + margin

    def _mesh(self, i: int) -> FloatArray:
        """Return patch `i` sampled on the bench, (3, rows, columns) mm."""
        key = f"mesh{i}"
        if key not in self._cache:
            points = np.tensordot(self.rotation, sample(self.body.patches[i]), axes=1)
            self._cache[key] = points + self.offset[:, None, None]
        return self._cache[key]


def _crossings(mesh: FloatArray, z: float) -> FloatArray:
    """Return where the mesh's lines cross the plane, and nodes that lie on it, (2, k) mm."""
    height = mesh[2] - z
    on = np.abs(height) <= _FLUSH * (1 + np.ptp(mesh[2]))
    found = [mesh[:2, on]]
    for axis in (1, 2):
        a = mesh.take(range(mesh.shape[axis] - 1), axis=axis).reshape(3, -1)
        b = mesh.take(range(1, mesh.shape[axis]), axis=axis).reshape(3, -1)
        across = (a[2] - z) * (b[2] - z) < 0
        a, b = a[:, across], b[:, across]
        t = (z - a[2]) / (b[2] - a[2])
        found.append((a + t * (b - a))[:2])
    return np.concatenate(found, axis=1)
