"""A scan of 512 slices of 512 × 512 pixels: our figures against decoding alone, SimpleITK and scikit-image.

Every contestant measures the same DICOM files in a child process of its own, one after the other, and is
timed there with its imports done and the files in the system's cache; memory is what its peak lies above its
imports. pydicom and stackloft take turns, as machines are shared and change speed; medians are printed, of
the ratios, which are taken pair by pair, the least and the greatest too.

    .venv/bin/python benchmarks/scan_speed.py [--slices 512] [--syntax explicit] [--rounds 7] [--no-peers]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command `stackloft` has it; for all contestants

import numpy as np

SIDE = 512
METHODS = "loft,cavalieri,partial-volume"


def write_scan(folder: Path, slices: int, syntax: str) -> float:
    """Write a seeded potato as CT with noise, `slices` files of 512² pixels; return its volume, mm³."""
    from stackloft.testing import phantoms  # noqa: PLC0415
    from stackloft.testing.phantoms.scan_dicom import write_dicom  # noqa: PLC0415

    potato = phantoms.make("potato", seed=3)
    pixel = potato.height / (slices - 12) if slices > 100 else 0.161
    scans = phantoms.Scans(
        sections=slices - 12,
        empty=6,
        pixel_size=max(pixel, 0.15),
        noise=15.0,
        margin=5,
        slab_points=1,
        syntax=syntax,
    )
    volume = scans.volume(potato)
    rng = np.random.default_rng(1)
    rows, columns = volume.grid.shape
    top, left = (SIDE - rows) // 2, (SIDE - columns) // 2

    def framed(picture: np.ndarray) -> np.ndarray:
        air = np.hypot(*rng.normal(0.0, 15.0, (2, SIDE, SIDE))) - 1000.0
        whole = air.round().astype(np.int16)
        whole[top : top + rows, left : left + columns] = picture
        return whole

    origin = volume.grid.origin - np.array([left, top]) * scans.pixel_size
    grid = replace(volume.grid, shape=(SIDE, SIDE), origin=origin)
    folder.mkdir()
    write_dicom(replace(volume, slices=tuple(framed(one) for one in volume.slices), grid=grid), folder)
    return float(potato.volume)


def with_pydicom(folder: Path) -> Callable[[], str]:
    import pydicom  # noqa: PLC0415

    def run() -> str:
        total = sum(int(pydicom.dcmread(path).pixel_array[0, 0]) for path in sorted(folder.iterdir()))
        return f"decoded, first pixels sum to {total}"

    return run


def with_stackloft(folder: Path) -> Callable[[], str]:
    import stackloft  # noqa: PLC0415
    from stackloft.pipeline.request import MeasureRequest  # noqa: PLC0415
    from stackloft.pipeline.run import measure  # noqa: PLC0415

    few = folder.parent / "few"
    stackloft.measure(few, method=METHODS)  # imports what is imported where it is used

    def run() -> str:
        body = measure(MeasureRequest(folder, method=METHODS)).result.objects[0]
        return ", ".join(
            f"{name} {row.volume.value:.0f} mm³" for name, row in body.methods.items() if row.volume
        )

    return run


def with_simpleitk(folder: Path) -> Callable[[], str]:
    import SimpleITK as sitk  # noqa: N813, PLC0415

    def run() -> str:
        names = sitk.ImageSeriesReader.GetGDCMSeriesFileNames(str(folder))
        image = sitk.ReadImage(names)
        shapes = sitk.LabelShapeStatisticsImageFilter()
        shapes.ComputePerimeterOn()
        shapes.Execute(sitk.ConnectedComponent(sitk.OtsuThreshold(image, 0, 1)))
        largest = max(shapes.GetLabels(), key=shapes.GetPhysicalSize)
        return f"{shapes.GetPhysicalSize(largest):.0f} mm³, {shapes.GetPerimeter(largest):.0f} mm²"

    return run


def with_skimage(folder: Path) -> Callable[[], str]:
    import pydicom  # noqa: PLC0415
    from skimage.filters import threshold_otsu  # noqa: PLC0415
    from skimage.measure import marching_cubes, mesh_surface_area  # noqa: PLC0415

    def run() -> str:
        files = [pydicom.dcmread(path) for path in folder.iterdir()]
        files.sort(key=lambda one: float(one.ImagePositionPatient[2]))
        step = float(files[1].ImagePositionPatient[2]) - float(files[0].ImagePositionPatient[2])
        volume = np.stack([one.pixel_array for one in files])
        level = threshold_otsu(volume[::8])
        sides = (step, *map(float, files[0].PixelSpacing))
        points, faces, _, _ = marching_cubes(volume, level, spacing=sides)
        a, b, c = (points[faces[:, k]].astype(np.float64) for k in range(3))
        solid = abs(float(np.einsum("ij,ij->", a, np.cross(b, c)))) / 6.0
        return f"{solid:.0f} mm³, {mesh_surface_area(points, faces):.0f} mm²"

    return run


CONTESTANTS = {
    "pydicom, serial decoding": with_pydicom,
    f"stackloft, {METHODS}": with_stackloft,
    "SimpleITK: read, Otsu, label shapes": with_simpleitk,
    "scikit-image: marching cubes": with_skimage,
}


def peak() -> float:
    """Return this process's greatest resident memory so far, MB."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return float(status.partition("VmHWM:")[2].split()[0]) / 1024


def in_child(name: str, folder: Path) -> None:
    """Run one contestant and print what it took, as JSON."""
    run = CONTESTANTS[name](folder)
    before = peak()
    wall, processor = time.perf_counter(), time.process_time()
    said = run()
    taken = {"wall": time.perf_counter() - wall, "processor": time.process_time() - processor}
    print(json.dumps({**taken, "memory": peak() - before, "said": said}))


def measured(name: str, folder: Path) -> dict[str, Any]:
    """Run one contestant in a process of its own; return what it printed."""
    command = [sys.executable, __file__, "--child", name, "--folder", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def line(name: str, rows: list[dict[str, Any]], bases: list[float]) -> str:
    """Return a line of the table: medians, and the ratios to pydicom's time, pair by pair."""
    wall, processor, memory = (median(row[key] for row in rows) for key in ("wall", "processor", "memory"))
    ratios = [row["wall"] / base for row, base in zip(rows, bases, strict=True)]
    return (
        f"{name:40s} {wall:6.2f} s ({median(ratios):5.2f} ×, {min(ratios):.2f} to {max(ratios):.2f})  "
        f"processor {processor:6.2f} s  peak +{memory:.0f} MB  {rows[0]['said']}"
    )


def main() -> None:
    """Write the files, run every contestant on them, print a table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--slices", type=int, default=512)
    parser.add_argument("--syntax", default="explicit")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--child")
    parser.add_argument("--folder", type=Path)
    given = parser.parse_args()
    if given.child:
        in_child(given.child, given.folder)
        return
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "scan"
        truth = write_scan(folder, given.slices, given.syntax)
        few = Path(scratch) / "few"
        few.mkdir()
        for path in sorted(folder.iterdir())[given.slices // 3 : given.slices // 3 + 12]:
            (few / path.name).symlink_to(path)
        print(f"{given.slices} slices of {SIDE}², {given.syntax}; the body has {truth:.0f} mm³")
        first, second, *peers = CONTESTANTS
        turns = [(measured(first, folder), measured(second, folder)) for _ in range(given.rounds)]
        bases = [base["wall"] for base, _ in turns]
        print(line(first, [base for base, _ in turns], bases))
        print(line(second, [own for _, own in turns], bases))
        for name in [] if given.no_peers else peers:
            print(line(name, [measured(name, folder)], [median(bases)]))


if __name__ == "__main__":
    main()
