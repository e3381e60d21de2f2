"""PLY: a header that declares elements and their properties, then their records, as text or binary."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.readers.surface_polygons import triangles

_TYPES = {
    name: kind
    for names, kind in (
        (("char", "int8"), "i1"),
        (("uchar", "uint8"), "u1"),
        (("short", "int16"), "i2"),
        (("ushort", "uint16"), "u2"),
        (("int", "int32"), "i4"),
        (("uint", "uint32"), "u4"),
        (("float", "float32"), "f4"),
        (("double", "float64"), "f8"),
    )
    for name in names
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")


@dataclass(slots=True)
class _Property:
    name: str
    kind: str
    """NumPy type of a value."""
    length: str = ""
    """NumPy type of a list's length; empty: one value."""


@dataclass(slots=True)
class _Element:
    name: str
    count: int
    properties: list[_Property] = field(default_factory=list)


def is_ply(head: bytes) -> bool:
    r"""Return whether a file that begins with `head` is PLY.

    Examples
    --------
    >>> is_ply(b"ply\nformat ascii 1.0\n"), is_ply(b"plywood")
    (True, False)
    """
    return head.split(maxsplit=2)[:2] == [b"ply", b"format"]


def read_ply(content: bytes) -> tuple[FloatArray, IntArray]:
    """Return vertices (n, 3) and triangles (t, 3); polygons are cut into triangles.

    Raises
    ------
    ValueError
        Cut off, or not such a file: in words.
    """
    order, elements, start = _header(content)
    source = _Text(content[start:]) if order == "" else _Binary(content, start, order)
    vertices = np.zeros((0, 3))
    loops: Any = ()
    for element in elements:
        columns = source.take(element)
        if element.name == "vertex":
            if not {"x", "y", "z"} <= columns.keys():
                raise ValueError("vertices without x, y and z")
            vertices = np.column_stack([columns[axis] for axis in "xyz"]).astype(np.float64)
        if element.name == "face":
            named = [columns[name] for name in _CORNERS if name in columns]
            if not named:
                raise ValueError("faces without vertex_indices")
            loops = named[0]
    return vertices, triangles(vertices, loops)


def _header(content: bytes) -> tuple[str, list[_Element], int]:
    """Return the byte order (empty: text), the elements, and where their records begin."""
    end = content.find(b"end_header")
    line_end = content.find(b"\n", end)
    if end < 0 or line_end < 0 or end > 1 << 20:
        raise ValueError("a PLY file without the end of its header")
    lines = content[:end].decode("latin-1").splitlines()[1:]
    order = next((line.split()[1] for line in lines if line.split()[:1] == ["format"]), "none")
    if order not in _ORDERS:
        raise ValueError(f"a PLY file of another format: {order[:60]!r}")
    elements: list[_Element] = []
    for line in lines:
        try:
            _declare(line.split(), elements)
        except (KeyError, IndexError, ValueError):
            raise ValueError(f"a header line that PLY does not know: {line[:60]!r}") from None
    return _ORDERS[order], elements, line_end + 1


def _declare(words: list[str], elements: list[_Element]) -> None:
    """Add what a header line declares to `elements`."""
    match words:
        case ["element", name, count]:
            elements.append(_Element(name, int(count) if count.isdecimal() else -1))
            if elements[-1].count < 0:
                raise ValueError
        case ["property", "list", length, kind, name]:
            elements[-1].properties.append(_Property(name, _TYPES[kind], _whole(length)))
        case ["property", kind, name]:
            elements[-1].properties.append(_Property(name, _TYPES[kind]))
        case [] | ["format" | "comment" | "obj_info", *_]:
            pass
        case _:
            raise ValueError


def _whole(name: str) -> str:
    kind = _TYPES[name]
    if kind[0] == "f":
        raise KeyError
    return kind


class _Text:
    """Records as numbers with blanks between them."""

    def __init__(self, content: bytes) -> None:
        self._lines = io.BytesIO(content)

    def take(self, element: _Element) -> dict[str, Any]:
        rows: list[list[bytes]] = []
        while len(rows) < element.count:
            line = self._lines.readline()
            if not line:
                raise ValueError(
                    f"cut off: {len(rows)} of {element.count} records of {element.name} are there"
                )
            if line.strip():
                rows.append(line.split())
        if not any(item.length for item in element.properties):
            return self._plain(element, rows)
        columns: dict[str, list[list[float]]] = {item.name: [] for item in element.properties}
        for row in rows:
            at = 0
            for item in element.properties:
                size = int(row[at]) if item.length and at < len(row) else 1
                at += bool(item.length)
                values = row[at : at + size]
                if size < 0 or len(values) != size:
                    raise ValueError(f"a record of {element.name} is too short: {b' '.join(row)[:60]!r}")
                columns[item.name].append([_number(value, item.kind) for value in values])
                at += size
        return dict(columns)

    @staticmethod
    def _plain(element: _Element, rows: list[list[bytes]]) -> dict[str, Any]:
        width = len(element.properties)
        if any(len(row) < width for row in rows):
            raise ValueError(f"a record of {element.name} is too short")
        table = np.array([row[:width] for row in rows], dtype=bytes).reshape(-1, width).astype(np.float64)
        return {item.name: table[:, k] for k, item in enumerate(element.properties)}


def _number(value: bytes, kind: str) -> float:
    return float(value) if kind[0] == "f" else int(value)


class _Binary:
    """Records one after the other, bytes in `order`."""

    def __init__(self, content: bytes, start: int, order: str) -> None:
        self._content, self._at, self._order = content, start, order

    def take(self, element: _Element) -> dict[str, Any]:
        """Return the columns; when all lists are as long as the first record's, in one step."""
        if not element.count or not element.properties:
            return {item.name: [] for item in element.properties}
        lengths = self._first_lengths(element)
        parts = [
            part
            for item, size in zip(element.properties, lengths, strict=True)
            for part in ([(f"#{item.name}", self._order + item.length)] if item.length else [])
            + [(item.name, self._order + item.kind, (size,) if item.length else ())]
        ]
        record = np.dtype(parts)
        if self._at + record.itemsize * element.count <= len(self._content):
            table = np.frombuffer(self._content, record, element.count, self._at)
            lists = [
                (item.name, size)
                for item, size in zip(element.properties, lengths, strict=True)
                if item.length
            ]
            if all((table[f"#{name}"] == size).all() for name, size in lists):
                self._at += table.nbytes
                return {item.name: table[item.name] for item in element.properties}
        return self._one_by_one(element)

    def _first_lengths(self, element: _Element) -> list[int]:
        at, lengths = self._at, []
        for item in element.properties:
            size, at = self._length(item, at, element)
            at += size * np.dtype(item.kind).itemsize
            lengths.append(size)
        return lengths

    def _length(self, item: _Property, at: int, element: _Element) -> tuple[int, int]:
        """Return how many values follow at `at`, and where they begin; they must all be there."""
        size = 1
        if item.length:
            kind = np.dtype(self._order + item.length)
            if at + kind.itemsize > len(self._content):
                raise ValueError(f"cut off among the {element.count} records of {element.name}")
            size = int(np.frombuffer(self._content, kind, 1, at)[0])
            at += kind.itemsize
        if size < 0 or at + size * np.dtype(item.kind).itemsize > len(self._content):
            raise ValueError(f"cut off among the {element.count} records of {element.name}")
        return size, at

    def _one_by_one(self, element: _Element) -> dict[str, Any]:
        columns: dict[str, list[list[float]]] = {item.name: [] for item in element.properties}
        for _ in range(element.count):
            for item in element.properties:
                size, at = self._length(item, self._at, element)
                kind = np.dtype(self._order + item.kind)
                columns[item.name].append(np.frombuffer(self._content, kind, size, at).tolist())
                self._at = at + size * kind.itemsize
        return dict(columns)
