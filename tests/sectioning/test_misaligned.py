"""Slices that do not lie on each other are told; sound stacks are left in peace."""

from pathlib import Path

import numpy as np
import pytest

from stackloft.sectioning.contour_sink import trace_stack
from stackloft.testing import phantoms
from stackloft.testing.phantoms.laying import Laying
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft_plugins.readers.photos import PhotosReader
from stackloft_plugins.segmenters.histogram import HistogramSegmenter

BODIES = ("potato", "apple", "banana", "meat", "potato")
REAL = Path(__file__).resolve().parents[3] / "shared" / "real"
MISTAKES = {"misaligned", "motion", "wrong-order", "slice-odd", "slice-missing", "slice-doubled"}


def specimen(number):
    """Return a food of its own size, every second one in a random pose, and how it is photographed."""
    rng = np.random.default_rng([number, 5])
    name = BODIES[number % len(BODIES)]
    more = {"potato": {"seed": number}, "apple": {"diameter": float(rng.uniform(60, 90))}}.get(name, {})
    pose = int(rng.integers(10**6)) if number % 2 else None
    look = {"realism": Realism.of(name, seed=number), "suffix": "jpg"} if number % 4 == 0 else {}
    if name == "apple":
        look["plate"] = "black"
    options = {"sections": int(rng.integers(9, 17)), "pixel_size": float(rng.uniform(0.3, 0.45)), **look}
    return phantoms.make(name, rotation=pose, **more), options


def codes(folder, number, laying):
    phantom, options = specimen(number)
    tell = ("pixel_size", "thickness", "background")
    Photographs(laying=laying, tell=tell, **options).write(phantom, folder)
    contours = trace_stack(HistogramSegmenter().segment(PhotosReader().read(folder)))
    return {notice.code for notice in contours.notices} & MISTAKES


@pytest.mark.parametrize("number", [0, 1, 2, 3])
def test_a_stack_and_the_same_slices_laid_down_one_by_one(tmp_path, number):
    assert codes(tmp_path / "sound", number, None) == set()
    assert "misaligned" in codes(tmp_path / "laid", number, Laying(seed=number))


@pytest.mark.prove
def test_100_misaligned_and_100_sound_stacks(tmp_path, proof):
    laid = [codes(tmp_path / f"laid{k}", k, Laying(seed=k)) for k in range(100)]
    sound = [codes(tmp_path / f"sound{k}", k, None) for k in range(100)]
    told = sum("misaligned" in found for found in laid)
    alarms = sum("misaligned" in found for found in sound)
    rows = [
        ("laid down to ±3 mm and ±5° each", 100, told, sum(bool(found) for found in laid)),
        ("each on the one before", 100, alarms, sum(bool(found) for found in sound)),
    ]
    claim = (
        "Photographed potatoes, apples, bananas and meat, half of them tilted, 9 to 16 slices, a quarter of "
        "them realistic: who is told that the slices do not lie on each other"
    )
    proof("misaligned", claim, ("slices", "stacks", "misaligned told", "any mistake told"), rows)
    assert told >= 95
    assert alarms <= 3
    assert rows[1][3] <= 3


@pytest.mark.skipif(not REAL.is_dir(), reason="the real stacks are not here")
@pytest.mark.parametrize(("first", "last"), [("1020.jpg", "1300.jpg"), ("1100.jpg", "1200.jpg")])
def test_cryosections_raise_no_alarm(first, last):
    reader = PhotosReader(pixel_size="1.32mm", thickness="5mm", first=first, last=last)
    contours = trace_stack(HistogramSegmenter().segment(reader.read(REAL / "visible_human_photos")))
    assert "misaligned" not in {notice.code for notice in contours.notices}
