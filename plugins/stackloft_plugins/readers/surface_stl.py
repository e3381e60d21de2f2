"""STL: binary (80 bytes, a count, 50 bytes per triangle) or text (``facet … vertex x y z … endfacet``)."""

from __future__ import annotations

import re

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", re.IGNORECASE)
_FACET = re.compile(rb"\bfacet\b", re.IGNORECASE)
_END = re.compile(rb"\bendsolid\b", re.IGNORECASE)


def is_stl(head: bytes, size: int) -> bool:
    r"""Return whether a file of `size` bytes that begins with `head` is STL, by its layout.

    Examples
    --------
    >>> is_stl(b"solid cube\n facet normal 0 0 1", 900), is_stl(bytes(80) + bytes([2, 0, 0, 0]), 184)
    (True, True)
    """
    return _is_text(head) or _announced(head) == size


def read_stl(content: bytes) -> tuple[FloatArray, IntArray]:
    """Return vertices (n, 3) and triangles (t, 3); equal corners are one vertex.

    Raises
    ------
    ValueError
        Cut off, or not STL: in words.
    """
    corners = (
        _text(content)
        if _is_text(content[:4096]) and _announced(content) != len(content)
        else _binary(content)
    )
    flat = corners.reshape(-1, 3) + 0.0  # no −0, which would be a corner of its own
    vertices, index = np.unique(flat, axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3)


def _is_text(head: bytes) -> bool:
    return head.lstrip()[:5].lower() == b"solid" and b"\0" not in head


def _announced(content: bytes) -> int:
    """Return the size that the count after the title announces; −1 when there is no count."""
    return 84 + 50 * int.from_bytes(content[80:84], "little") if len(content) >= 84 else -1


def _binary(content: bytes) -> FloatArray:
    announced = _announced(content)
    if announced < 0 or announced > len(content):
        count = max(0, (len(content) - 84) // 50)
        said = (
            f"{(announced - 84) // 50} triangles are announced, {count} are there"
            if announced > 0
            else "too short"
        )
        raise ValueError(f"a binary STL file that is cut off or damaged: {said}")
    if len(content) > announced + 2:
        raise ValueError(f"{len(content) - announced} bytes follow the last announced triangle")
    records = np.frombuffer(content, dtype=_RECORD, offset=84, count=(announced - 84) // 50)
    return records["corners"].astype(np.float64)


def _text(content: bytes) -> FloatArray:
    found, facets = _VERTEX.findall(content), len(_FACET.findall(content))
    if not _END.search(content):
        raise ValueError("a text STL file that is cut off: endsolid is missing")
    if len(found) != 3 * facets:
        raise ValueError(f"{len(found)} corners for {facets} facets; three are expected for each")
    return np.array(found, dtype=bytes).astype(np.float64).reshape(-1, 3, 3)
