"""Twenty JPEGs of 12 Mpx: measuring them, against merely decoding them one after the other with one library.

Run: ``python benchmarks/photo_speed.py [--slices 20] [--rounds 5] [--reference] [--large]``. Each round
decodes all files with Pillow and then measures them (two threads), in one process, on warm files; the ratio
within a round is what counts, since the machine's own speed cancels. Imports are done before the clock runs.
The rounds are run in a fresh process, and in this one, which has drawn the pictures: there Pillow often finds
memory that the system need not hand out and clear again, and decodes in less than half the time.
The largest memory is a child's, less that of a child that measures the same pictures ten times smaller.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

import stackloft

SIZE = (3000, 4000)
MM_PER_PIXEL = 0.03
PEAK = """
import sys
import stackloft
stackloft.measure(sys.argv[1])
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""


def write_slices(folder: Path, count: int, *, reference: bool, large: bool = False) -> None:
    """Write a body 66 mm across on a light plate: grain, flesh, uneven light; a disc if asked for.

    A large one is 109 × 80 mm and ends bluntly: it fills 45 to 60 % of all pictures.
    """
    rows, columns = SIZE
    y, x = np.mgrid[:rows, :columns].astype(np.float32) * MM_PER_PIXEL
    random = np.random.default_rng(7)
    light = (1.0 + 0.06 * (x / x.max() - 0.5) - 0.04 * (y / y.max() - 0.5))[..., None]
    grain = random.normal(0, 2.0, (rows, columns)).astype(np.float32)
    across, down = ((x - 60.0) / 1.58, (y - 45.0) / 1.2) if large else (x - 64.0, y - 46.0)
    from_middle, angle = np.hypot(across, down), np.arctan2(down, across)
    for k in range(count):
        z = (k + 0.5) / count * 2 - 1
        width = 33.0 * (1 - 0.15 * z * z if large else np.sqrt(1 - z * z))
        edge = width * (1 + (0.0 if large else 0.06) * np.cos(3 * angle + z) + 0.04 * np.sin(2 * angle))
        inside = np.clip((edge - from_middle) / MM_PER_PIXEL + 0.5, 0, 1)[..., None]
        coarse = random.normal(0, 1, (30, 40)).astype(np.float32)
        mottled = cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_CUBIC)[..., None]
        scene = 226.0 + (np.array([168.0, 70.0, 62.0], np.float32) + 14.0 * mottled - 226.0) * inside
        if reference:
            disc = np.clip((12.125 - np.hypot(x - 15.0, y - 15.0)) / MM_PER_PIXEL + 0.5, 0, 1)[..., None]
            scene += (np.array([120.0, 124.0, 130.0], np.float32) - scene) * disc
        scene = cv2.GaussianBlur(scene * light, (0, 0), 1.0) + np.roll(grain, 37 * k, axis=1)[..., None]
        picture = Image.fromarray(scene.clip(0, 255).astype(np.uint8))
        picture.save(folder / f"cut_{k + 1:02d}.jpg", quality=92)
    say(folder, count, MM_PER_PIXEL, reference=reference)


def say(folder: Path, count: int, pixel: float, *, reference: bool) -> None:
    scale = 'reference = "disc:24.25mm"' if reference else f'pixel_size = "{pixel}mm"'
    lines = (scale, f'thickness = "{66 / count}mm"', 'height = "66mm"', "")
    (folder / "stack.toml").write_text("\n".join(lines))


def decode_all(folder: Path) -> None:
    for path in sorted(folder.glob("*.jpg")):
        with Image.open(path) as image:
            np.asarray(image)


def peak(folder: Path) -> float:
    """Return the largest memory of a process that measures `folder`, MB."""
    command = [sys.executable, "-c", PEAK, str(folder)]
    return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout) / 1024


def extra_memory(folder: Path, *, reference: bool) -> float:
    """Return by how many MB the largest memory exceeds that of the same stack, ten times smaller."""
    with tempfile.TemporaryDirectory() as temporary:
        small = Path(temporary)
        files = sorted(folder.glob("*.jpg"))
        for path in files:
            with Image.open(path) as image:
                image.resize((SIZE[1] // 10, SIZE[0] // 10), Image.Resampling.BOX).save(small / path.name)
        say(small, len(files), 10 * MM_PER_PIXEL, reference=reference)
        return peak(folder) - peak(small)


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--slices", type=int, default=20)
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--reference", action="store_true")
    arguments.add_argument("--large", action="store_true")
    arguments.add_argument("--only", type=Path, metavar="FOLDER", help=argparse.SUPPRESS)
    said = arguments.parse_args()
    if said.only:
        report(said.only, said.rounds)
        return
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        write_slices(folder, said.slices, reference=said.reference, large=said.large)
        print("a fresh process", flush=True)
        alone = [sys.executable, __file__, "--only", str(folder), "--rounds", str(said.rounds)]
        subprocess.run(alone, check=True)
        print("the process that drew the pictures")
        report(folder, said.rounds)
        extra = extra_memory(folder, reference=said.reference)
    picture = SIZE[0] * SIZE[1] * 3 / 2**20
    print(f"memory above small pictures' {extra:.0f} MB: {extra / picture:.1f} pictures of {picture:.0f} MB")


def report(folder: Path, rounds: int) -> None:
    result = stackloft.measure(folder)  # imports, and the files in memory
    ratios, processor = [], []
    for number in range(rounds):
        start, cpu = time.perf_counter(), time.process_time()
        decode_all(folder)
        middle, cpu_middle = time.perf_counter(), time.process_time()
        stackloft.measure(folder)
        end, cpu_end = time.perf_counter(), time.process_time()
        ratios.append((end - middle) / (middle - start))
        processor.append((cpu_end - cpu_middle) / (cpu_middle - cpu))
        told = f"round {number + 1}: decoding {middle - start:.2f} s, measuring {end - middle:.2f} s"
        print(f"{told}, ratio {ratios[-1]:.2f}, of processor time {processor[-1]:.2f}")
    print(f"{len(list(folder.glob('*.jpg')))} JPEGs, V = {result.objects[0].volume.value / 1000:.2f} cm³")
    told = f"median ratio {np.median(ratios):.2f}, least {min(ratios):.2f}"
    print(f"{told}; of processor time {np.median(processor):.2f}")


if __name__ == "__main__":
    main()
