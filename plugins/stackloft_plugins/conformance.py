"""What the conformance kit must know of the built-in plug-ins; see `stackloft.testing.conformance.suites`."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.measurement import Result

_GIVEN = {"pixel_size": "0.3mm", "thickness": "2.5mm"}


def write_pictures(folder: Path, slices: int) -> Path:
    """Write photographs of discs that all differ, and return their folder."""
    from PIL import Image  # noqa: PLC0415 - slow to import

    for k in range(slices):
        Image.fromarray(_disc(k)).save(folder / f"slice_{k + 1}.png")
    return folder


def write_array(folder: Path, slices: int) -> Path:
    """Write a NumPy volume of the same discs."""
    path = folder / "volume.npy"
    np.save(path, np.stack([_disc(k) for k in range(slices)]))
    return path


def write_rings(folder: Path, slices: int) -> Path:
    """Write a table of contours whose positions it tells."""
    return _table(folder, slices, "section,z,loop,x,y")


def write_rings_without_positions(folder: Path, slices: int) -> Path:
    """Write the same table without them."""
    return _table(folder, slices, "section,loop,x,y")


def _table(folder: Path, slices: int, header: str) -> Path:
    rows = [header]
    for k in range(slices):
        z = f"{2.5 * k}," if ",z," in header else ""
        for angle in np.linspace(0, 2 * np.pi, 24, endpoint=False):
            x, y = (10 + k % 3) * np.cos(angle), (8 + k % 2) * np.sin(angle)
            rows.append(f"{k + 1},{z}1,{float(x)!r},{float(y)!r}")
    path = folder / "body.csv"
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


def _disc(k: int) -> Any:
    rows, columns = np.mgrid[:60, :80]
    grey = np.where((rows - 30) ** 2 + (columns - 40 - k % 7) ** 2 < (15 + k % 5) ** 2, 90, 235)
    noise = np.random.default_rng(k).normal(0, 3, grey.shape)
    return (grey + noise).clip(0, 255).astype(np.uint8)


def _figures(result: Result) -> tuple[float, ...]:
    body = result.objects[0]
    return (body.volume.value, body.area.value if body.area else 0.0)


def _json_figures(path: Path) -> tuple[float, ...]:
    body = json.loads(path.read_text(encoding="utf-8"))["objects"][0]
    return (body["volume"]["value"], body["area"]["value"])


def _areas(result: Result) -> list[float]:
    return [row.area for row in result.objects[0].sections]


def _csv_areas(path: Path) -> list[float]:
    return [
        float(row["area [mm^2]"]) for row in csv.DictReader(path.read_text(encoding="utf-8").splitlines())
    ]


def write_surface(folder: Path, slices: int) -> Path:
    """Write a closed surface as text STL; `slices` makes it finer."""
    angles = np.linspace(0, 2 * np.pi, 8 * slices, endpoint=False)
    ring = np.column_stack([9 * np.cos(angles), 7 * np.sin(angles), 0.1 * np.sin(3 * angles)])
    lines = ["solid spindle"]
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        for corners in ((a, b, [1.0, 2.0, 11.5]), (b, a, [-1.0, 0.5, -12.5])):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in (map(float, corner) for corner in corners)]
            lines += ["endloop", "endfacet"]
    path = folder / "body.stl"
    path.write_text("\n".join([*lines, "endsolid spindle"]) + "\n", encoding="utf-8")
    return path


CASES: Mapping[str, Mapping[str, Any]] = {
    "reader.photos": {"write": write_pictures, "options": _GIVEN, "spacing_options": tuple(_GIVEN)},
    "reader.numpy": {"write": write_array, "options": _GIVEN, "spacing_options": tuple(_GIVEN)},
    "reader.contours": {
        "write": write_rings,
        "without_spacing": write_rings_without_positions,
        "expected_failures": {
            "refuses-truncated": "a table cut off between two rows is a table, and says nothing of the rest",
        },
    },
    "reader.surface": {
        "write": write_surface,
        "expected_failures": {"refuses-one-slice": "a surface has no slices"},
    },
    "writer.json": {"read": _json_figures, "expected": _figures},
    "writer.csv": {"read": _csv_areas, "expected": _areas},
    "integrator.frustum": {
        "expected_failures": {
            "convergence": "frusta know a section's area and perimeter alone: the area stays 4.6 % off on"
            " sections with axes 1.75 : 1",
        },
    },
}
