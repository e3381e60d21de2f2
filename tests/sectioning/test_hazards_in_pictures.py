"""Each mistake made in rendered photographs is told with file and figure; sound stacks are silent."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from stackloft.model.errors import InputError
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.testing import phantoms
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft.testing.phantoms.reference_object import ReferenceObject
from stackloft_plugins.readers.photos import PhotosReader
from stackloft_plugins.segmenters.histogram import HistogramSegmenter

STACKS = [(name, seed) for name in ("potato", "apple", "meat", "ellipsoid") for seed in (1, 2)]
SECTIONS = 16
FIGURE = dict.fromkeys(
    ("wrong-order", "slice-missing", "slice-doubled", "slice-odd", "motion"), r"\.jpg.*\d"
) | {
    "low-contrast": r"\.jpg: .* only \d",
    "second-object": r"\.jpg: .* of \d+\.\d %",
    "border-contact": r"\.jpg: the body touches the picture's (top|bottom|left|right)",
    "refused": "",
}
COIN = ReferenceObject("disc", 24.25)


def written(folder, name, seed, pixel_size=0.5, **options):
    own = {"seed": seed} if name == "potato" else {}
    phantom = phantoms.make(name, rotation=None if name == "meat" else seed, **own)
    camera = Photographs(
        sections=SECTIONS, pixel_size=pixel_size, realism=Realism.of(name, seed=seed), suffix="jpg",
        plate="black" if name == "apple" else "white", tell=("thickness", "pixel_size", "reference"),
    )  # fmt: skip
    keys = camera.tell if "reference" in options else camera.tell[:2]
    replace(camera, tell=keys, **options).write(phantom, folder)
    return sorted(folder.glob("slice_*.jpg"))


def told(folder):
    try:
        notices = trace_stack(HistogramSegmenter().segment(PhotosReader().read(folder))).notices
    except InputError as error:
        return [("refused", str(error))]
    return [(one.code, one.message) for one in notices]


def renamed(files, order, folder):
    """Copy files into another folder as slice 1, 2, … in `order`."""
    folder.mkdir()
    shutil.copy(files[0].parent / "stack.toml", folder)
    for number, which in enumerate(order, start=1):
        shutil.copy(files[which], folder / f"slice_{number:02d}.jpg")


def altered(files, numbers, change, folder):
    renamed(files, range(len(files)), folder)
    for number in numbers:
        path = folder / f"slice_{number:02d}.jpg"
        picture = change(np.asarray(Image.open(path)).astype(float))
        Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8)).save(path, quality=95)


def enlarged(picture):
    rows, columns = picture.shape[:2]
    wide = Image.fromarray(picture.astype(np.uint8)).resize((round(1.04 * columns), round(1.04 * rows)), 3)
    top, left = (wide.height - rows) // 2, (wide.width - columns) // 2
    return np.asarray(wide)[top : top + rows, left : left + columns].astype(float)


def faint(picture):
    plate = np.median(picture[:6].reshape(-1, 3), axis=0)
    return plate + (picture - plate) * 0.12


def with_another(picture):
    """The slice with a lump of 15 % of the picture's height in its corner, as grey as flesh."""
    rows, columns = np.indices(picture.shape[:2])
    plate = np.median(picture[:6].reshape(-1, 3), axis=0)
    far = np.hypot(rows - 0.1 * len(rows), columns - 0.1 * len(rows))
    flesh = (150, 90, 80) if plate.mean() > 100 else (200, 190, 150)
    return np.where((far < 0.075 * len(rows))[..., None], flesh, picture)


def moved(picture):
    return np.roll(picture, (10, 0), (0, 1))


def mistakes(files, folder, k):
    """Yield what was made, the code that tells of it, the file that it is about (k: its number from 1)."""
    n = len(files)
    order = list(range(n))
    swapped = [*order[: k - 1], k, k - 1, *order[k + 1 :]]
    renamed(files, swapped, folder / "swapped")
    yield "swapped", "wrong-order", k
    shifted = [*order[: k - 1], *order[k:]]
    shifted.insert(n - 3 if k < n // 2 else 2, k - 1)
    renamed(files, shifted, folder / "displaced")
    yield "displaced", "wrong-order", shifted.index(k - 1) + 1
    renamed(files, [*order[: k - 1], *order[k:]], folder / "missing")
    yield "missing", "slice-missing", k - 1
    renamed(files, [*order[:k], *order[k - 1 :]], folder / "doubled")
    yield "doubled", "slice-doubled", k
    altered(files, [k], enlarged, folder / "outlier")
    yield "outlier", "slice-odd", k
    altered(files, [k], faint, folder / "low contrast")
    yield "low contrast", "low-contrast", k
    altered(files, range(k, n + 1), moved, folder / "motion")
    yield "motion", "motion", k


def misplaced(folder, k, name, seed):
    """As `mistakes`, of what has to be rendered anew."""
    wide = written(folder / "wide", name, seed, margin=18.0)
    altered(wide, [k], with_another, folder / "two bodies")
    yield "two bodies", "second-object", k
    written(folder / "cut by the border", name, seed, margin=-4.0)
    yield "cut by the border", "border-contact", None
    written(folder / "reference cut off", name, seed, reference=replace(COIN, gap=-6.0))
    yield "reference cut off", "refused", None


def rightly_told(folder, code, number):
    """Whether the mistake is told by its code, the file's name and a figure."""
    for found, message in told(folder):
        name = r"slice_\d\d" if number is None else f"slice_{number:02d}"
        if code == "refused" and "slice_01.jpg: an object in a corner is cut off by the picture's" in message:
            return True
        if found == code and re.search(name + FIGURE[code], message):
            return True
    return False


def test_each_mistake_is_told_with_its_file(tmp_path):
    files = written(tmp_path / "sound", "ellipsoid", 1, pixel_size=0.7)
    assert told(tmp_path / "sound") == []
    made = mistakes(files, tmp_path, 5)
    assert [what for what, code, number in made if not rightly_told(tmp_path / what, code, number)] == []


@pytest.mark.prove
def test_every_mistake_in_many_stacks(tmp_path, proof):
    rates, alarms = {}, []
    for name, seed in STACKS:
        folder = tmp_path / f"{name}{seed}"
        files = written(folder / "sound", name, seed)
        alarms += [one for one in told(folder / "sound") if one[0] != "hole-filled"]
        k = int(np.random.default_rng(seed).integers(4, SECTIONS - 4))
        for what, code, number in (*mistakes(files, folder, k), *misplaced(folder, k, name, seed)):
            rates.setdefault((what, code), []).append(rightly_told(folder / what, code, number))
    rows = [("none made", "", len(STACKS), len(alarms))]
    rows += [(what, f"`{code}`", len(found), sum(found)) for (what, code), found in rates.items()]
    claim = "Mistakes in rendered photographs (4 kinds of bodies, 16 slices) told with file and figure"
    proof("stack-hazards-photographs", claim, ("mistake", "warning", "stacks", "told"), rows)
    assert not alarms
    for (what, _), found in rates.items():
        sure = what in {"low contrast", "two bodies", "cut by the border", "reference cut off"}
        assert np.mean(found) >= (1.0 if sure else 0.5), what
