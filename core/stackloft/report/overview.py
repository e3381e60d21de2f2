"""The overview: every section's contour over its photograph, in one picture.

::

    +--------+ +--------+ +--------+
    |  (  )  | | (    ) | |  (  )  |     contour as measured, thin and coloured
    | --     | | --     | | --     |     scale bar
    +--------+ +--------+ +--------+
     1 cut_01   2 cut_02   3 cut_03      number and file
     z 0 mm     z 5.6 mm   z 11.1 mm     position

All slices are drawn at one scale, so that the body's taper is seen.
Whoever looks at it sees within seconds whether a threshold took the plate for the body.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import BinaryIO

import cv2
import numpy as np
from PIL import Image, ImageDraw

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.slice_stack import turn_matrix
from stackloft.report.sheet import INK, MOUNT, PAPER, draw_scale_bar, font, line_height, shortened
from stackloft.report.thumbnails import Rgb, Thumbnail, side_for
from stackloft.sectioning.loop_numbers import by_size
from stackloft.sectioning.loop_runs import loop_runs

COLOURS = {
    "magenta": (255, 0, 220),
    "cyan": (0, 225, 255),
    "yellow": (255, 230, 0),
    "green": (0, 220, 60),
    "blue": (20, 60, 255),
}
"""The contour's colour is the one of these that stands out best from what lies under the contours."""
RUNS = (
    (255, 0, 220), (0, 200, 255), (255, 215, 0), (0, 210, 70), (255, 120, 0), (150, 90, 255), (255, 60, 60),
    (0, 170, 140),
)  # fmt: skip
"""Where sections have several loops, those that go on as each other have one colour; the colours repeat."""

_GAP = 12
BAR = 0.3
"""Part of a cell's width that the scale bar takes at most; it is the same in all."""
_FRACTION_BITS = 4  # cv2 draws at a sixteenth of a pixel
_ASPECT = 1.5


def write_overview(contours: ContourStack, thumbnails: Sequence[Thumbnail], stream: BinaryIO) -> None:
    """Write the overview of `contours` as PNG.

    Parameters
    ----------
    contours : ContourStack
        The loops that were measured.
    thumbnails : sequence of Thumbnail
        The slices they were traced on; empty for a source of contours alone, which are then drawn on
        white, all at one scale, x to the right and y downwards as in a photograph.
    stream : BinaryIO
        Open for writing.
    """
    cells = _over_photographs(contours, thumbnails) if thumbnails else _on_paper(contours)
    _grid(cells).save(stream, format="PNG", compress_level=4)


@dataclass(frozen=True, slots=True, eq=False)
class _Cell:
    picture: Rgb
    lines: tuple[str, str]
    per_mm: float
    light: bool
    """Drawn on paper."""


def _over_photographs(contours: ContourStack, thumbnails: Sequence[Thumbnail]) -> list[_Cell]:
    sections = {(section.name, round(section.z, 9)): section for section in contours.sections}
    side = max(max(small.picture.shape) for small in thumbnails)
    per_mm = side / max(max(small.extent) for small in thumbnails)
    pairs = [(small.scaled(per_mm), sections.get((small.name, round(small.z, 9)))) for small in thumbnails]
    colour = _standing_out([(small, section) for small, section in pairs if section is not None])
    colours = _by_run(contours, colour)
    return [_cell(small, section, colours, number) for number, (small, section) in enumerate(pairs, start=1)]


def _on_paper(contours: ContourStack) -> list[_Cell]:
    points = np.concatenate([loop.points for section in contours.sections for loop in section.loops])
    low, high = points.min(axis=0), points.max(axis=0)
    side = side_for(len(contours))
    per_mm = 0.9 * side / float((high - low).max())
    width, height = (math.ceil(extent * per_mm + 0.1 * side) for extent in high - low)
    origin = tuple(0.05 * side - low * per_mm)
    paper = np.full((height, width, 3), 255, dtype=np.uint8)
    small = [
        Thumbnail(section.name, section.z, paper, (per_mm, per_mm), origin) for section in contours.sections
    ]
    pairs = zip(small, contours.sections, strict=True)
    colours = _by_run(contours, COLOURS["blue"])
    return [
        _cell(one, section, colours, number, light=True)
        for number, (one, section) in enumerate(pairs, start=1)
    ]


Colour = tuple[int, int, int]


def _by_run(contours: ContourStack, single: Colour) -> dict[float, list[Colour]]:
    """Return the colour of each loop by its section's z: `single` unless a section has several loops."""
    sections = contours.sections
    runs = loop_runs(contours) if any(len(section.loops) > 1 for section in sections) else []
    if not runs:
        return {section.z: [single] * len(section.loops) for section in sections}
    return {
        section.z: [RUNS[k % len(RUNS)] for k in own] for section, own in zip(sections, runs, strict=True)
    }


def _cell(
    small: Thumbnail,
    section: Section | None,
    colours: dict[float, list[Colour]],
    number: int,
    *,
    light: bool = False,
) -> _Cell:
    picture = small.picture.copy()
    loops = section.loops if section is not None else ()
    own = colours[section.z] if section is not None else []
    for loop, colour in zip(loops, own, strict=True):
        at = np.round(_pixels(loop, small) * (1 << _FRACTION_BITS)).astype(np.int32)
        cv2.polylines(picture, [at.reshape(-1, 1, 2)], True, colour, 1, cv2.LINE_AA, _FRACTION_BITS)
    if len(loops) > 1:
        _number_loops(
            picture, [_pixels(loop, small) for loop in loops], colours[section.z] if section else []
        )
    unused = "" if section is not None else "  (not used)"
    position = f"{small.z:.2f}".rstrip("0").rstrip(".")
    lines = (f"{number}  {small.name}", f"z {position} mm{unused}")
    return _Cell(picture, lines, small.per_mm[0], light)


def _number_loops(picture: Rgb, outlines: list[FloatArray], colours: list[Colour]) -> None:
    """Write each loop's number, the largest first, at its top: what links in stack.toml are said by."""
    size = max(0.3, picture.shape[1] / 700)
    for number, k in enumerate(by_size(outlines), start=1):
        column, row = outlines[k][int(np.argmin(outlines[k][:, 1]))]
        at = round(column) - 4, max(round(row) - 3, 10)
        cv2.putText(picture, str(number), at, cv2.FONT_HERSHEY_SIMPLEX, size, colours[k], 1, cv2.LINE_AA)


def _pixels(loop: Loop, small: Thumbnail) -> FloatArray:
    """Return the loop's vertices as (column, row) of the thumbnail."""
    pixels: FloatArray = loop.points @ turn_matrix(small.turn) * np.array(small.per_mm) + np.array(
        small.origin
    )
    return pixels


def _standing_out(pairs: Sequence[tuple[Thumbnail, Section]]) -> tuple[int, int, int]:
    """Return the colour whose distance from the pictures along the contours is greatest on the whole."""
    under = [_under(loop, small) for small, section in pairs for loop in section.loops]
    if not under:
        return COLOURS["magenta"]
    pixels = np.concatenate(under).astype(np.float64)
    return max(COLOURS.values(), key=lambda colour: float(np.linalg.norm(pixels - colour, axis=1).mean()))


def _under(loop: Loop, small: Thumbnail) -> Rgb:
    rows, columns = small.picture.shape[:2]
    at = np.round(_pixels(loop, small)).astype(int)
    under: Rgb = small.picture[at[:, 1].clip(0, rows - 1), at[:, 0].clip(0, columns - 1)]
    return under


def _grid(cells: Sequence[_Cell]) -> Image.Image:
    """Return the cells side by side on a sheet about half as wide again as high, each with its label."""
    width = max(cell.picture.shape[1] for cell in cells)
    height = max(cell.picture.shape[0] for cell in cells)
    face = font(max(11, width // 24))
    line = line_height(face)
    bar = min(BAR * width, 0.7 * min(cell.picture.shape[1] for cell in cells))
    pitch = width + _GAP, height + 2 * line + _GAP
    columns = max(1, min(len(cells), round(math.sqrt(_ASPECT * len(cells) * pitch[1] / pitch[0]))))
    rows = math.ceil(len(cells) / columns)
    sheet = Image.new("RGB", (columns * pitch[0] + _GAP, rows * pitch[1] + _GAP), PAPER)
    draw = ImageDraw.Draw(sheet)
    for number, cell in enumerate(cells):
        left, top = _GAP + number % columns * pitch[0], _GAP + number // columns * pitch[1]
        aside, down = (width - cell.picture.shape[1]) // 2, (height - cell.picture.shape[0]) // 2
        draw.rectangle((left, top, left + width - 1, top + height - 1), fill=MOUNT)
        sheet.paste(Image.fromarray(cell.picture), (left + aside, top + down))
        foot = left + aside + 6, top + down + cell.picture.shape[0] - 6
        draw_scale_bar(draw, foot, cell.per_mm, bar, face, dark=cell.light)
        for row, text in enumerate(cell.lines):
            at = left, top + height + row * line
            draw.text(at, shortened(text, face, width), fill=INK, font=face)
    return sheet
