"""Damaged DICOM files: never a traceback, a hang, memory for a claimed size, or another geometry."""

import random
import resource
import shutil
import struct
import time
import tracemalloc

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft_plugins.readers.dicom import DicomReader

SYNTAXES = ("explicit", "implicit", "rle", "jpeg-ls", "jpeg-2000", "deflated")
MOST_SECONDS = 5.0
MOST_BYTES = 100_000_000
HEADER = 900


def truncated(content, rng):
    return content[: rng.randrange(len(content))]


def flipped_header(content, rng):
    return flipped(content, rng, 132, min(HEADER, len(content)))


def flipped_pixels(content, rng):
    return flipped(content, rng, min(HEADER, len(content) // 2), len(content))


def flipped(content, rng, start, stop):
    spoilt = bytearray(content)
    for _ in range(rng.choice([1, 3, 20])):
        spoilt[rng.randrange(start, stop)] ^= 1 << rng.randrange(8)
    return bytes(spoilt)


def absurd_size(content, rng):
    spoilt = bytearray(content)
    for tag in (b"\x28\x00\x10\x00US\x02\x00", b"\x28\x00\x11\x00US\x02\x00"):
        place = spoilt.find(tag)
        if place >= 0:
            spoilt[place + 8 : place + 10] = struct.pack("<H", rng.choice([0, 1, 40000, 65535]))
    return bytes(spoilt)


def absurd_length(content, rng):
    spoilt = bytearray(content)
    place = rng.randrange(140, min(HEADER, len(spoilt) - 4))
    spoilt[place : place + 4] = struct.pack("<I", rng.choice([0xFFFFFFFF, 0xFFFFFFFE, 0x7FFFFFF0, 1 << 31]))
    return bytes(spoilt)


def deep_nesting(content, rng):
    depth = rng.choice([50, 3000])
    item = b"\xfe\xff\x00\xe0\xff\xff\xff\xff" + b"\x08\x00\x40\x11SQ\x00\x00\xff\xff\xff\xff"
    place = content.find(b"\x08\x00\x60\x00CS")
    place = 400 if place < 0 else place
    return content[:place] + b"\x08\x00\x40\x11SQ\x00\x00\xff\xff\xff\xff" + item * depth + content[place:]


def wrong_type(content, rng):
    spoilt = bytearray(content)
    known = [b"US", b"DS", b"IS", b"UI", b"CS", b"SH", b"LO", b"OW", b"SQ", b"FD", b"ZZ"]
    places = [k for k in range(132, min(HEADER, len(spoilt))) if bytes(spoilt[k : k + 2]) in known]
    if places:
        place = rng.choice(places)
        spoilt[place : place + 2] = rng.choice(known)
    return bytes(spoilt)


def zero_length(content, rng):
    spoilt = bytearray(content)
    tags = [
        b"\x20\x00\x32\x00DS",
        b"\x20\x00\x37\x00DS",
        b"\x28\x00\x30\x00DS",
        b"\x28\x00\x10\x00US",
        b"\x28\x00\x01\x01US",
    ]
    place = spoilt.find(rng.choice(tags))
    if place >= 0:
        length = struct.unpack_from("<H", spoilt, place + 6)[0]
        spoilt[place + 6 : place + 8] = b"\0\0"
        del spoilt[place + 8 : place + 8 + length]
    return bytes(spoilt)


DAMAGES = (
    truncated,
    flipped_header,
    flipped_pixels,
    absurd_size,
    absurd_length,
    deep_nesting,
    wrong_type,
    zero_length,
)


@pytest.fixture(scope="module")
def sound(tmp_path_factory, scan):
    folders = {}
    for syntax in SYNTAXES:
        folders[syntax] = tmp_path_factory.mktemp(syntax)
        write_dicom(scan(6, size=(48, 56), syntax=syntax), folders[syntax])
    for folder in folders.values():
        DicomReader().read(folder).decode(0)  # imports what it needs
    return folders


def outcome(folder):
    """Read and decode everything: the stack, or the refusal."""
    try:
        stack = DicomReader().read(folder)
        for k in range(len(stack)):
            stack.decode(k)
    except InputError as error:
        return error
    return stack


def same_geometry(stack, expected):
    """Whether a stack's slices lie where the undamaged ones do; all of them, or fewer with a warning."""
    if len(stack) < len(expected):
        assert {"several-series"} & {notice.code for notice in stack.notices}
    number = {name: k for k, name in enumerate(expected.names)}
    kept = [number[name] for name in stack.names]
    assert np.allclose(stack.positions, expected.positions[kept], atol=1e-6)
    assert np.allclose(stack.pixel_spacing, expected.pixel_spacing[kept], atol=1e-6)
    assert np.allclose(stack.affine, expected.affine, atol=1e-5)
    assert stack.shape == expected.shape


def check(seed, sound, folder):
    rng = random.Random(seed)
    syntax, damage = SYNTAXES[seed % len(SYNTAXES)], DAMAGES[seed % len(DAMAGES)]
    shutil.copytree(sound[syntax], folder)
    victim = folder / f"IM{rng.randrange(1, 7):04d}"
    victim.write_bytes(damage(victim.read_bytes(), rng))
    tracemalloc.start()
    start = time.perf_counter()
    try:
        found = outcome(folder)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert time.perf_counter() - start < MOST_SECONDS
    assert peak < MOST_BYTES
    if isinstance(found, InputError):
        assert not {"\n", "Grey"} & {part for part in ("\n", "Grey") if part in str(found)}
    else:
        same_geometry(found, DicomReader().read(sound[syntax]))
    return isinstance(found, InputError)


@pytest.mark.parametrize("seed", range(48))
def test_damaged_files(seed, sound, tmp_path):
    check(seed, sound, tmp_path / "series")


@pytest.mark.prove
def test_three_hundred_damaged_files(proof, sound, tmp_path):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    outcomes = {damage.__name__: [] for damage in DAMAGES}
    for seed in range(1000, 1300):
        outcomes[DAMAGES[seed % len(DAMAGES)].__name__].append(check(seed, sound, tmp_path / str(seed)))
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before  # kB, decoders' own included
    rows = [
        (name.replace("_", " "), len(found), sum(found), len(found) - sum(found))
        for name, found in outcomes.items()
    ]
    refused = sum(row[2] for row in rows)
    rows.append(("all", 300, refused, 300 - refused))
    claim = (
        f"300 seeded damaged DICOM series of {len(SYNTAXES)} transfer syntaxes: none a traceback, none above "
        f"{MOST_SECONDS:g} s or {MOST_BYTES // 1_000_000} MB, the process grown by {grown / 1000:.0f} MB; "
        "what is not refused has the undamaged geometry"
    )
    proof("damaged-files", claim, ("damage", "series", "refused", "read, same geometry"), rows)
    assert refused > 150
    assert grown < 300_000
