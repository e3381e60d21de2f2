"""Wavefront OBJ: ``v x y z`` and ``f a b c …``, counted from 1, or from the last vertex backwards."""

from __future__ import annotations

import re

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.readers.surface_polygons import triangles

_LINE = re.compile(rb"^[ \t]*(v[ \t]|vn[ \t]|vt[ \t]|f[ \t]|#|mtllib|o[ \t]|g[ \t]|s[ \t]|usemtl)")


def is_obj(head: bytes) -> bool:
    r"""Return whether a file that begins with `head` is OBJ: it has vertices, and lines of no other sort.

    Examples
    --------
    >>> is_obj(b"# cube\nv 0 0 0\nv 1 0 0\n"), is_obj(b"a letter\n")
    (True, False)
    """
    lines = [line for line in head.splitlines()[:-1] if line.strip()]
    return any(line.lstrip()[:2] in {b"v ", b"v\t"} for line in lines) and all(map(_LINE.match, lines))


def read_obj(content: bytes) -> tuple[FloatArray, IntArray]:
    """Return vertices (n, 3) and triangles (t, 3); polygons are cut into triangles.

    Raises
    ------
    ValueError
        A number that is none, or a face that names no vertex: with its line.
    """
    points: list[list[float]] = []
    loops: list[list[int]] = []
    for number, line in enumerate(content.replace(b"\\n", b" ").splitlines(), 1):
        words = line.split()
        if not words or words[0] not in {b"v", b"f"}:
            continue
        try:
            if words[0] == b"v":
                points.append(_point(words))
            else:
                loops.append([_corner(word, len(points)) for word in words[1:]])
        except (ValueError, IndexError):
            raise ValueError(
                f"line {number} cannot be read: {line[:60].decode(errors='replace')!r}"
            ) from None
    vertices = np.array(points, dtype=np.float64).reshape(-1, 3)
    return vertices, triangles(vertices, loops)


def _point(words: list[bytes]) -> list[float]:
    """Return x, y, z of ``v x y z``, after which a weight or a colour may follow."""
    if len(words) < 4:
        raise ValueError
    return [float(word) for word in words[1:4]]


def _corner(word: bytes, count: int) -> int:
    """Return the vertex that ``7``, ``7/1``, ``7//3`` or ``-1`` names, counted from 0."""
    number = int(word.split(b"/")[0])
    if number == 0:
        raise ValueError
    return number - 1 if number > 0 else count + number
