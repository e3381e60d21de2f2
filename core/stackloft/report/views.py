r"""The solid from three sides, and from a corner: what was measured, as an eye would see it.

::

    +-----------+-----------+
    | as photo- | from the  |     all at one scale; thin lines: the sections that were measured
    | graphed   | right     |
    +-----------+-----------+
    | from      | from a    |
    | above     | corner    |
    +-----------+-----------+
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import BinaryIO

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from stackloft.model.arrays import FloatArray
from stackloft.model.tri_mesh import TriMesh
from stackloft.report.sheet import FAINT, INK, PAPER, draw_scale_bar, font, line_height
from stackloft.report.z_buffer import Drawn, draw_triangles

SIDE = 500
"""Pixels of one view."""
FINER = 2
"""Samples per pixel, along each axis."""
FILL = 0.86
"""Part of a view that the body fills at most."""
_GAP = 14
_CORNER = np.array([[0.80, 0.0, 0.60], [0.26, 0.90, -0.35], [-0.54, 0.44, 0.72]])

VIEWS: dict[str, FloatArray] = {
    "as photographed": np.eye(3),
    "from the right": np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    "from above": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "from a corner": _CORNER,
}
"""Rows: right, down and away, in the pictures' own directions (x right, y down, z away)."""

_CLAY = np.array([228.0, 186.0, 140.0])
_KEY = np.array([-0.48, -0.62, -0.62])
_FILL_LIGHT = np.array([0.80, -0.10, -0.59])


def write_views(mesh: TriMesh, sections: Sequence[FloatArray], stream: BinaryIO) -> None:
    """Write the four views of a closed surface as PNG.

    Parameters
    ----------
    mesh : TriMesh
    sections : sequence of (k, 3) arrays
        Closed lines on the surface, mm, drawn thin.
    stream : BinaryIO
        Open for writing.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    centre = (low + high) / 2
    around = mesh.vertices - centre
    turned = {name: _right_handed(matrix) for name, matrix in VIEWS.items()}
    reach = max(float(np.ptp(around @ matrix.T, axis=0)[:2].max()) for matrix in turned.values())
    per_mm = FILL * SIDE / reach
    panels = [
        (name, _panel(around, mesh, [line - centre for line in sections], matrix, per_mm))
        for name, matrix in turned.items()
    ]
    _sheet(panels, per_mm, high - low).save(stream, format="PNG", compress_level=4)


def _right_handed(matrix: FloatArray) -> FloatArray:
    """Return the nearest rotation, so that nothing is mirrored or stretched."""
    u, _, v = np.linalg.svd(matrix)
    rotation: FloatArray = u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
    return rotation


def _panel(
    around: FloatArray, mesh: TriMesh, lines: Sequence[FloatArray], matrix: FloatArray, per_mm: float
) -> NDArray[np.uint8]:
    scale, middle = per_mm * FINER, np.array([SIDE * FINER / 2, SIDE * FINER / 2, 0.0])

    def seen(points: FloatArray) -> FloatArray:
        placed: FloatArray = points @ matrix.T * scale + middle
        return placed

    drawn = draw_triangles(seen(around), mesh.faces, (SIDE * FINER, SIDE * FINER))
    picture = _shaded(drawn)
    for line in lines:
        _draw_line(picture, drawn, seen(line))
    small = cv2.resize(picture.astype(np.float32), (SIDE, SIDE), interpolation=cv2.INTER_AREA)
    shown: NDArray[np.uint8] = small.round().clip(0, 255).astype(np.uint8)
    return shown


def _shaded(drawn: Drawn) -> FloatArray:
    """Return (rows, columns, 3) colours: clay under a key light, a weaker one, and a sky."""
    normal = drawn.normals.astype(np.float64)
    key = np.clip(normal @ _KEY, 0, 1)
    other = np.clip(normal @ _FILL_LIGHT, 0, 1)
    sky = 0.5 - 0.5 * normal[..., 1]
    facing = np.clip(-normal[..., 2], 0, 1)
    light = (0.34 + 0.56 * key + 0.18 * other + 0.14 * sky) * (0.72 + 0.28 * facing)
    half = _KEY + np.array([0.0, 0.0, -1.0])
    gloss = np.clip(normal @ (half / np.linalg.norm(half)), 0, 1) ** 42
    clay = light[..., None] * _CLAY + 40.0 * gloss[..., None]
    rows = np.linspace(253.0, 236.0, len(normal))[:, None, None]
    return np.where(drawn.seen[..., None], clay, np.broadcast_to(rows, normal.shape))


def _draw_line(picture: FloatArray, drawn: Drawn, line: FloatArray) -> None:
    """Darken the pixels of a closed line where it is not hidden."""
    steps = np.diff(line, axis=0, append=line[:1])
    counts = np.maximum(np.ceil(np.abs(steps[:, :2]).max(axis=1) * 1.5).astype(int), 1)
    which = np.repeat(np.arange(len(line)), counts)
    part = np.concatenate([np.arange(count) / count for count in counts])
    points = line[which] + part[:, None] * steps[which]
    column, row = np.floor(points[:, :2]).astype(int).T
    rows, columns = drawn.depth.shape
    within = (row >= 1) & (row < rows - 1) & (column >= 1) & (column < columns - 1)
    row, column, away = row[within], column[within], points[within, 2]
    visible = away <= drawn.depth[row, column] + 2.0 * FINER
    visible &= drawn.seen[row, column]
    at = np.unique(row[visible] * columns + column[visible])
    for shift in (0, 1):
        picture.reshape(-1, 3)[at + shift] *= 0.82


def _sheet(panels: Sequence[tuple[str, NDArray[np.uint8]]], per_mm: float, extent: FloatArray) -> Image.Image:
    face, small = font(20), font(16)
    line = line_height(face)
    width, height = 2 * (SIDE + _GAP) + _GAP, 2 * (SIDE + line + _GAP) + 2 * _GAP + line_height(small)
    sheet = Image.new("RGB", (width, height), PAPER)
    draw = ImageDraw.Draw(sheet)
    for number, (name, picture) in enumerate(panels):
        left = _GAP + number % 2 * (SIDE + _GAP)
        top = _GAP + number // 2 * (SIDE + line + _GAP)
        sheet.paste(Image.fromarray(picture), (left, top))
        draw.text((left + 2, top + SIDE + 1), name, fill=INK, font=face)
        draw_scale_bar(draw, (left + 14, top + SIDE - 14), per_mm, 0.25 * SIDE, small, dark=True)
    sides = " by ".join(f"{side:.4g}" for side in extent)
    told = f"extent along the axes {sides} mm"
    draw.text((_GAP + 2, height - _GAP - line_height(small)), told, fill=FAINT, font=small)
    return sheet
