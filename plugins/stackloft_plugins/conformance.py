"""What the conformance kit must know of the built-in plug-ins; see `stackloft.testing.conformance.suites`."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.measurement import Result
from stackloft.model.tet_mesh import TetMesh
from stackloft_plugins import conformance_scans as scans

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


def in_colour(picture: Any) -> Any:
    """Return the kit's grey levels (60 body, 200 plate) as red flesh on a plate almost as bright."""
    body = np.clip((200.0 - picture) / 140.0, -0.1, 1.1)[..., None]
    colours = np.array([200.0, 198.0, 196.0]) + body * np.array([-25.0, -105.0, -100.0])
    return colours.round().clip(0, 255).astype(np.uint8)


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


def read_mphtxt(path: Path) -> TetMesh:
    """Read COMSOL's text by its description: counts, then numbers, comments behind #."""
    words = [
        word
        for line in path.read_text(encoding="utf-8").splitlines()
        for word in line.partition("#")[0].split()
    ]
    at = words.index("Mesh") + 2
    count, at = int(words[at + 1]), at + 3
    nodes = np.array(words[at : at + 3 * count], dtype=float).reshape(-1, 3)
    at += 3 * count + 1
    blocks = {}
    while words[at + 1][:3] in {"tri", "tet"}:
        name, width, rows = words[at + 1], int(words[at + 2]), int(words[at + 3])
        at += 4
        blocks[name] = np.array(words[at : at + width * rows], dtype=np.int64).reshape(rows, width)
        at += width * rows
        at += 1 + int(words[at])
    faces, elements = blocks["tri2"][:, [0, 1, 2, 3, 5, 4]], blocks["tet2"][:, [0, 1, 2, 3, 4, 6, 5, 7, 8, 9]]
    return TetMesh(frozen_floats(nodes), frozen_ints(elements), frozen_ints(faces))


CASES: Mapping[str, Mapping[str, Any]] = {
    "reader.photos": {"write": write_pictures, "options": _GIVEN, "spacing_options": tuple(_GIVEN)},
    "reader.numpy": {
        "write": write_array,
        "options": _GIVEN,
        "spacing_options": tuple(_GIVEN),
        "write_told": scans.write_npz_told,
    },
    "reader.dicom": {
        "write": scans.write_dicom_folder,
        "without_spacing": scans.write_dicom_bare,
        "write_told": scans.write_dicom_told,
    },
    "reader.bruker": {
        "write": scans.write_bruker_folder,
        "without_spacing": scans.write_bruker_bare,
        "write_told": scans.write_bruker_told,
    },
    "reader.dicom-seg": {"write": scans.write_segments},
    "reader.rtstruct": {"write": scans.write_structures},
    "reader.itk": {
        "write": scans.write_nrrd,
        "without_spacing": scans.write_nrrd_bare,
        "write_told": scans.write_nrrd_told,
    },
    "reader.tiff": {
        "write": scans.write_tiff_stack,
        "without_spacing": scans.write_tiff_bare,
        "write_told": scans.write_tiff_told,
    },
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
    "segmenter.colour": {
        "change": in_colour,
        "expected_failures": dict.fromkeys(
            ("grey-scale", "grey-depth"), "it tells the body by its colours, and the kit takes them away"
        ),
    },
    "writer.json": {"read": _json_figures, "expected": _figures},
    "writer.mphtxt": {"read": read_mphtxt},
    "writer.csv": {"read": _csv_areas, "expected": _areas},
    "mesher.tetwild": {
        "steadiness": 3e-3
    },  # its envelope is a part of the whole surface's size, not of each body's
    "reconstructor.shape-interpolation": {
        "expected_failures": {
            "additivity": "two bodies share one grid of 96 steps across both, coarser than one body's own:"
            " at 8 sections volume comes 0.5 % low",
        },
    },
    "integrator.frustum": {
        "expected_failures": {
            "convergence": "frusta know a section's area and perimeter alone: the area stays 4.6 % off on"
            " sections with axes 1.75 : 1",
        },
    },
}
