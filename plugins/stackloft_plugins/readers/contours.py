"""Exact loops from a table, one vertex per row.

::

    # apple 4, digitised by hand
    section,z,loop,x,y,corner        mm; corner and hole (0 or 1) may be left out
    1,0.0,1,10.0,0.0,0
    1,0.0,1,9.8,1.9,0
    ...
    2,5.6,1,14.0,0.0,0

Sections may come in any order and are put in the order of z; a loop's vertices are in order around it,
in either direction, its first vertex repeated at the end or not. ``stack.toml`` beside the table tells
ends, height and specimen.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SectionKind
from stackloft.sectioning.corners import polygon_corners
from stackloft.sectioning.loop_numbers import said_links
from stackloft.sectioning.nesting import nesting_depths
from stackloft_plugins.readers.contour_rows import (
    LoopRows,
    SectionRows,
    looks_like_contours,
    parse_contours,
)
from stackloft_plugins.readers.picture_kinds import natural_key

_HEAD = 4096  # bytes read to recognise a table
_PROBED = 20  # tables of a folder that are looked at
_FILE_CONFIDENCE, _FOLDER_CONFIDENCE = 0.9, 0.7


@dataclass(frozen=True, slots=True)
class ContoursReader:
    r"""Reads a table of loops into a `ContourStack` of exact faces.

    Examples
    --------
    >>> import tempfile
    >>> rows = [f"{k},{5 * k},1,{x},{y}" for k in (1, 2) for x, y in ((0, 0), (4, 0), (4, 3), (0, 3))]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = Path(folder) / "box.csv"
    ...     _ = table.write_text("\n".join(["section,z,loop,x,y", *rows]))
    ...     stack = ContoursReader().read(table)
    >>> stack.positions, stack.sections[0].loops[0].signed_area, stack.sections[0].loops[0].corners
    (array([ 5., 10.]), 12.0, array([0, 1, 2, 3]))
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (ContourStack,)

    def probe(self, path: Path) -> float:
        """Return 0.9 for a contour table, 0.7 for a folder with just one, 0 otherwise."""
        try:
            if path.is_dir():
                return _FOLDER_CONFIDENCE if len(_tables(path)) == 1 else 0.0
            return _FILE_CONFIDENCE if path.is_file() and _is_table(path) else 0.0
        except OSError:
            return 0.0

    def read(self, path: Path) -> ContourStack:
        """Return the sections in the order of their z.

        Parameters
        ----------
        path : Path
            The table, or a folder with one table in it.

        Raises
        ------
        InputError
            A row cannot be read (file and line are named), a loop is no closed curve or has no area, two
            sections share a z, or there are fewer than two.
        """
        table_path = _table_of(path)
        table = parse_contours(_lines(table_path), table_path.name)
        if len(table.sections) < 2:
            raise InputError(
                "one section makes no body", where=str(table_path), expected="at least 2, better 7"
            )
        sections = [
            _section(label, rows, table.has_corners, table_path.name)
            for label, rows in table.sections.items()
        ]
        sections = sorted(sections, key=lambda section: section.z)
        said = load_stack_file(table_path.parent)
        hints = said.hints(table_path.parent, {k: k for k in range(1, len(sections) + 1)})
        names = [section.name for section in sections]
        return ContourStack(
            sections=tuple(sections),
            kind=SectionKind.FACE if said.kind is None else said.kind,
            exact=True,
            hints=replace(hints, slices={}, links=said_links(hints.slices, names)),
            provenance={"positions": table_path.name},
        )


def _table_of(path: Path) -> Path:
    if not path.is_dir():
        return path
    tables = _tables(path)
    if len(tables) != 1:
        raise InputError(
            "is no folder with one contour table",
            where=str(path),
            found=", ".join(table.name for table in tables) or "none",
            expected="one CSV file with the header section,z,loop,x,y",
        )
    return tables[0]


def _tables(folder: Path) -> list[Path]:
    named = (item for item in folder.iterdir() if item.suffix.lower() in {".csv", ".txt"})
    likely = sorted((item for item in named if item.is_file()), key=lambda item: natural_key(item.name))
    return [item for item in likely[:_PROBED] if _is_table(item)]


def _is_table(path: Path) -> bool:
    with path.open("rb") as stream:
        return looks_like_contours(stream.read(_HEAD).decode("utf-8", errors="replace"))


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8-sig").splitlines()
    except FileNotFoundError as error:
        raise InputError("does not exist", where=str(path)) from error
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("cannot be read as text", where=str(path), found=str(error)) from error


def _section(label: str, rows: SectionRows, has_corners: bool, where: str) -> Section:
    name = f"{where}, section {label}"
    cleaned = [_closed(loop, where) for loop in rows.loops.values()]
    depths = nesting_depths([points for points, _ in cleaned], name)
    loops = []
    for (points, corners), said, depth in zip(cleaned, rows.loops.values(), depths, strict=True):
        hole = depth % 2 == 1
        if said.hole not in {None, hole}:
            raise InputError(
                "the hole column contradicts the nesting",
                where=f"{where}, line {said.first_line}",
                found=f"hole = {int(not hole)} for a loop inside {depth} others",
            )
        loops.append(_oriented(points, corners if has_corners else None, hole))
    return Section(rows.z, tuple(sorted(loops, key=lambda loop: -loop.signed_area)), name)


def _closed(loop: LoopRows, where: str) -> tuple[FloatArray, list[bool]]:
    """Return the vertices without repeated ones, a corner mark kept with the vertex it is on."""
    points: list[tuple[float, float]] = []
    corners: list[bool] = []
    for point, corner in zip(loop.points, loop.corners, strict=True):
        if points and point == points[-1]:
            corners[-1] |= corner
        else:
            points.append(point)
            corners.append(corner)
    if len(points) > 1 and points[0] == points[-1]:
        corners[0] |= corners.pop()
        points.pop()
    at = f"{where}, line {loop.first_line}"
    if len(points) < 3:
        raise InputError(
            "a loop needs at least 3 points",
            where=at,
            found=str(len(points)),
            expected="points around the outline",
        )
    array = np.array(points)
    if not abs(Loop(array).signed_area) > 1e-12 * float(np.ptp(array, axis=0).max()) ** 2:
        raise InputError(
            "a loop encloses no area", where=at, fix="list its points in order around the outline"
        )
    return array, corners


def _oriented(points: FloatArray, corners: list[bool] | None, hole: bool) -> Loop:
    """Return a loop that runs counter-clockwise, a hole clockwise."""
    backwards = (Loop(points).signed_area < 0) is not hole
    if backwards:
        points = points[::-1]
        corners = None if corners is None else corners[::-1]
    marked = polygon_corners(points) if corners is None else frozen_ints(np.flatnonzero(corners))
    return Loop(frozen_floats(points), marked, hole)
