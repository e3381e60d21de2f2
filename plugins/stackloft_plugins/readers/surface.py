"""Surface: triangles from a mesh file, STL, PLY or OBJ."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.closed_mesh import unmatched_edges
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError
from stackloft.model.lengths import MILLIMETRES
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.readers.surface_obj import is_obj, read_obj
from stackloft_plugins.readers.surface_ply import is_ply, read_ply
from stackloft_plugins.readers.surface_stl import is_stl, read_stl

_HEAD = 4096
_SUFFIXES = (".stl", ".ply", ".obj")
_SURE, _BY_NAME = 0.9, 0.2
_UNIT = re.compile(rb"\bunits?[ :=]+(mm|cm|m|um|in)\b")


@dataclass(frozen=True)
class SurfaceReader:
    """Reads a triangle surface; polygons are cut into triangles, equal corners become one vertex.

    A mesh file has no unit. Files of stackloft say theirs in the title or a comment; others' numbers are
    taken as millimetres, as printers and slicers do, and a notice says so: give ``unit`` otherwise.
    What is open or not manifold is read, so that ``repair`` can mend it; it is refused when it is measured.
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)

    unit: str | None = option(
        None,
        "unit of the file's numbers; what the file says, or mm, when not given",
        choices=tuple(MILLIMETRES),
    )

    def probe(self, path: Path) -> float:
        """Return 0.9 for a layout of STL, PLY or OBJ, a little for their suffixes around something else."""
        try:
            with path.open("rb") as stream:
                head = stream.read(_HEAD)
            size = path.stat().st_size
        except OSError:
            return 0.0
        if not head:
            return 0.0
        if is_ply(head) or is_stl(head, size) or (is_obj(head) and path.suffix.lower() == ".obj"):
            return _SURE
        return _BY_NAME if path.suffix.lower() in _SUFFIXES else 0.0

    def read(self, path: Path) -> TriMesh:
        """Return the surface in millimetres.

        Raises
        ------
        InputError
            No such file; cut off or damaged; no triangle; a vertex that is not finite.
        """
        content = _content(path)
        try:
            vertices, faces = _parsed(content, path.suffix.lower())
        except (ValueError, OverflowError) as error:
            raise InputError(
                "is damaged, or no surface", where=str(path), found=str(error), expected="STL, PLY or OBJ"
            ) from error
        if not len(faces):
            raise InputError("has no triangle", where=str(path), found=f"{len(vertices)} vertices")
        if not np.isfinite(vertices).all():
            bad = int(np.count_nonzero(~np.isfinite(vertices).all(axis=1)))
            raise InputError(
                "has vertices that are not finite", where=str(path), found=f"{bad} of {len(vertices)}"
            )
        vertices, faces = _joined(vertices, faces)
        said = _UNIT.search(content[:_HEAD])
        unit = self.unit or (said[1].decode() if said else "mm")
        return TriMesh(
            frozen_floats(vertices * MILLIMETRES[unit]),
            frozen_ints(faces),
            notices=() if self.unit or said else (_assumed(path),),
        )


def _content(path: Path) -> bytes:
    try:
        content = path.read_bytes()
    except FileNotFoundError as error:
        raise InputError("does not exist", where=str(path)) from error
    except OSError as error:
        raise InputError("cannot be read", where=str(path), found=str(error.strerror or error)) from error
    if not content:
        raise InputError("is empty", where=str(path), expected="STL, PLY or OBJ")
    return content


def _parsed(content: bytes, suffix: str) -> tuple[FloatArray, IntArray]:
    head = content[:_HEAD]
    if is_ply(head):
        return read_ply(content)
    if is_stl(head, len(content)):
        return read_stl(content)
    if suffix == ".obj" or is_obj(head):
        return read_obj(content)
    return read_stl(content)  # which says what is wrong with it


def _joined(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the surface with equal vertices joined when that closes seams (of normals, of textures)."""
    if not unmatched_edges(faces):
        return vertices, faces
    single, index = np.unique(vertices + 0.0, axis=0, return_inverse=True)
    joined = index.reshape(-1)[faces]
    closer = unmatched_edges(joined) < unmatched_edges(faces)
    return (single, joined) if closer else (vertices, faces)


def _assumed(path: Path) -> Notice:
    return Notice(
        "unit-assumed",
        f"{path.name} does not say its unit; its numbers are taken as millimetres"
        " (--set reader.unit=cm, m, um or in otherwise)",
    )
