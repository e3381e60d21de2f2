r"""One slice step by step, as Figure 3 of Goñi, Purlis & Salvadori (2007) shows it.

::

    +-------------+-------------+-------------+
    | photograph  | grey        | histogram   |
    +-------------+-------------+-------------+
    | binary      | B-spline    | overlay     |
    +-------------+-------------+-------------+
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import BinaryIO

import cv2
import numpy as np
from PIL import Image, ImageDraw

from stackloft.model.arrays import FloatArray
from stackloft.model.slice_stack import turn_matrix
from stackloft.report.figure_sink import SIDE, SliceFigure
from stackloft.report.loft_lines import LoftLine
from stackloft.report.sheet import FAINT, INK, MOUNT, PAPER, draw_scale_bar, font, line_height, shortened
from stackloft.report.thumbnails import Rgb

_GAP = 16
_CURVE = (200, 30, 40)
_POINT = (20, 60, 200)
_BARS = (96, 125, 152)
_FINE = 4  # cv2 draws at a sixteenth of a pixel


def write_slice_figure(figure: SliceFigure, lines: Sequence[LoftLine], stream: BinaryIO) -> None:
    """Write the figure as PNG.

    Parameters
    ----------
    figure : SliceFigure
    lines : sequence of LoftLine
        The slice's curves as they were measured, with the points that they go through.
    stream : BinaryIO
        Open for writing.
    """
    count = sum(len(line.points) for line in lines)
    paper = np.full_like(figure.picture, 255)
    through = f"B-spline through {count} points" if count else "contour"
    panels = [
        ("photograph" if figure.colour else "slice as it was read", figure.picture),
        ("grey levels, filtered", figure.grey),
        (f"histogram, threshold {figure.threshold:.4g}", None),
        ("binary", figure.binary),
        (through, _drawn(paper, figure, lines)),
        ("overlay", _drawn(figure.picture.copy(), figure, lines)),
    ]
    _sheet(figure, panels).save(stream, format="PNG", compress_level=4)


def _drawn(picture: Rgb, figure: SliceFigure, lines: Sequence[LoftLine]) -> Rgb:
    """Draw curves and points on `picture` and return it."""
    for line in lines:
        at = np.round(_pixels(line.curve, figure) * (1 << _FINE)).astype(np.int32)
        cv2.polylines(picture, [at.reshape(-1, 1, 2)], True, _CURVE, 2, cv2.LINE_AA, _FINE)
    for line in lines:
        for x, y in np.round(_pixels(line.points, figure) * (1 << _FINE)).astype(int).tolist():
            cv2.circle(picture, (x, y), 4 << _FINE, (255, 255, 255), -1, cv2.LINE_AA, _FINE)
            cv2.circle(picture, (x, y), 3 << _FINE, _POINT, -1, cv2.LINE_AA, _FINE)
    return picture


def _pixels(points: FloatArray, figure: SliceFigure) -> FloatArray:
    pixels: FloatArray = points[:, :2] @ turn_matrix(figure.turn) * np.array(figure.per_mm) + np.array(
        figure.origin
    )
    return pixels


def _sheet(figure: SliceFigure, panels: Sequence[tuple[str, Rgb | None]]) -> Image.Image:
    face, head = font(19), font(22)
    line, top = line_height(face), line_height(head) + 2 * _GAP
    height, width = figure.picture.shape[:2]
    width = max(width, SIDE * 2 // 3)
    size = 3 * (width + _GAP) + _GAP, top + 2 * (height + line + _GAP)
    sheet = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(sheet)
    title = f"slice {figure.number}: {figure.name}, z {figure.z:.2f} mm"
    draw.text((_GAP, _GAP), shortened(title, head, size[0] - 2 * _GAP), fill=INK, font=head)
    for number, (label, picture) in enumerate(panels):
        left = _GAP + number % 3 * (width + _GAP)
        down = top + number // 3 * (height + line + _GAP)
        draw.rectangle((left, down, left + width - 1, down + height - 1), fill=MOUNT)
        if picture is None:
            _histogram(draw, figure, (left, down, width, height))
        else:
            aside = (width - picture.shape[1]) // 2
            sheet.paste(Image.fromarray(picture), (left + aside, down))
            if number in {0, 5}:
                at = (left + aside + 12, down + height - 12)
                draw_scale_bar(draw, at, figure.per_mm[0], 0.28 * picture.shape[1], face)
        draw.text((left + 2, down + height + 1), shortened(label, face, width), fill=INK, font=face)
    return sheet


def _histogram(draw: ImageDraw.ImageDraw, figure: SliceFigure, box: tuple[int, int, int, int]) -> None:
    """Draw pixels by grey level, on a square root's scale so that the valley is seen, and the threshold."""
    left, top, width, height = box
    face = font(15)
    foot, room = top + height - line_height(face) - 10, height - line_height(face) - 40
    inner = width - 40
    draw.rectangle((left, top, left + width - 1, top + height - 1), fill=(255, 255, 255))
    counts = np.sqrt(figure.histogram.astype(np.float64))
    tall = counts / max(counts.max(), 1.0) * room
    edges = left + 20 + np.round(np.arange(len(counts) + 1) * inner / len(counts)).astype(int)
    for k, bar in enumerate(tall):
        draw.rectangle((int(edges[k]), foot - round(bar), int(edges[k + 1]) - 1, foot), fill=_BARS)
    draw.line((left + 20, foot + 1, left + 20 + inner, foot + 1), fill=INK)
    low, high = figure.levels
    place = left + 20 + round((figure.threshold - low) / max(high - low, 1e-12) * inner)
    draw.line((place, foot - room - 16, place, foot), fill=_CURVE, width=3)
    draw.text((left + 20, foot + 4), f"{low:.4g}", fill=INK, font=face)
    right = f"{high:.4g}"
    draw.text((left + 20 + inner - face.getbbox(right)[2], foot + 4), right, fill=INK, font=face)
    told = "pixels (square root) by grey level"
    draw.text((left + 20 + (inner - face.getbbox(told)[2]) // 2, foot + 4), told, fill=FAINT, font=face)
