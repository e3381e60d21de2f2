"""Damaged structure sets, segmentations and 2dseq: refused in one line, or still where they were written."""

import random
import shutil
import time
import tracemalloc

import numpy as np
import pytest

from stackloft.model.errors import StackloftError
from stackloft.model.segmentation import Segmentation
from stackloft.testing.phantoms.scan_bruker import write_bruker
from stackloft.testing.phantoms.scan_seg import segmentation
from stackloft.testing.phantoms.structure_set import add_region, structure_bytes, structure_set
from stackloft_plugins.readers.bruker import BrukerReader
from stackloft_plugins.readers.dicom_seg import DicomSegReader
from stackloft_plugins.readers.rtstruct import RtstructReader

MOST_BYTES = 150_000_000
MOST_SECONDS = 20.0  # of a machine that others use too


def truncated(content, rng):
    return content[: rng.randrange(len(content))]


def flipped(content, rng):
    spoilt = bytearray(content)
    for _ in range(rng.choice([1, 3, 20])):
        spoilt[rng.randrange(132 if len(spoilt) > 200 else 0, len(spoilt))] ^= 1 << rng.randrange(8)
    return bytes(spoilt)


def absurd_length(content, rng):
    spoilt = bytearray(content)
    place = rng.randrange(0, len(spoilt) - 4)
    spoilt[place : place + 4] = rng.choice([b"\xff\xff\xff\xff", b"\xfe\xff\xff\xff", b"\xf0\xff\xff\x7f"])
    return bytes(spoilt)


def doubled(content, rng):
    start = rng.randrange(len(content))
    return content[:start] + content[max(0, start - 400) :]


def emptied(content, rng):
    start = rng.randrange(len(content))
    return content[:start] + bytes(min(8, len(content) - start)) + content[start + 8 :]


DAMAGES = (truncated, flipped, absurd_length, doubled, emptied)


@pytest.fixture(scope="module")
def sound(tmp_path_factory, scan):
    folders = {name: tmp_path_factory.mktemp(name) for name in ("rtstruct", "dicom-seg", "bruker")}
    turn = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    rings = [
        np.column_stack([(9 + k) * np.cos(turn), 9 * np.sin(turn), np.full(30, 3.0 * k)]) for k in range(6)
    ]
    data = structure_set()
    add_region(data, 1, "rings", rings)
    (folders["rtstruct"] / "RS").write_bytes(structure_bytes(data))
    volume = scan(6)
    masks = (np.stack(volume.slices) > 0)[..., None]
    (folders["dicom-seg"] / "SEG").write_bytes(segmentation(volume, masks, ["discs"]))
    write_bruker(volume, folders["bruker"])
    return folders


READERS = {"rtstruct": RtstructReader, "dicom-seg": DicomSegReader, "bruker": BrukerReader}


def outcome(name, folder):
    """What is read and decoded, or the refusal."""
    try:
        found = READERS[name]().read(folder)
        stack = found.stack if isinstance(found, Segmentation) else found
        for k in range(len(stack) if name != "rtstruct" else 0):
            stack.decode(k)
    except StackloftError as error:
        return error
    return stack


def places(stack):
    """Where the slices' corners lie in space, in order."""
    return np.array([(stack.affine @ [0.0, 0.0, z, 1.0])[:3] for z in stack.positions])


def same_geometry(found, expected):
    """Whether every slice lies where one of the undamaged lies; a slice whose body is gone may be missing."""
    old, new = places(expected), places(found)
    for place in new:
        assert np.abs(old - place).max(axis=1).min() < 1e-4


def check(seed, sound, folder):
    rng = random.Random(seed)
    name = list(READERS)[seed % 3]
    shutil.copytree(sound[name], folder)
    victims = sorted(path for path in folder.iterdir())
    victim = rng.choice(victims)
    victim.write_bytes(DAMAGES[seed % len(DAMAGES)](victim.read_bytes(), rng))
    tracemalloc.start()
    start = time.perf_counter()
    try:
        found = outcome(name, folder)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert time.perf_counter() - start < MOST_SECONDS
    assert peak < MOST_BYTES
    if isinstance(found, StackloftError):
        assert "\n" not in str(found)
        assert "Grey" not in str(found)
    elif victim.name not in {"visu_pars", "reco"}:  # plain numbers in text: another number is another scan
        same_geometry(found, outcome(name, sound[name]))
    return isinstance(found, StackloftError)


@pytest.mark.parametrize("seed", range(15))
def test_damaged_files(seed, sound, tmp_path):
    check(seed, sound, tmp_path / "spoilt")


@pytest.mark.prove
def test_three_hundred_damaged_files(sound, tmp_path):
    refused = sum(check(seed, sound, tmp_path / str(seed)) for seed in range(5000, 5300))
    assert refused > 100
