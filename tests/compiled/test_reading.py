"""Plain frames read together: as one by one, and left to others where 16 bits do not hold the sums."""

import numpy as np
import pytest

from stackloft.compiled.library import kernels, without_kernels
from stackloft.compiled.reading import Part, read_parts
from stackloft.sectioning.ahead import ahead_on
from stackloft.testing import phantoms
from stackloft_plugins.readers.dicom import DicomReader
from stackloft_plugins.readers.dicom_pixels import fits_short

pytestmark = pytest.mark.skipif(kernels() is None, reason="no compiled kernels here")


@pytest.mark.parametrize("kind", [np.int16, np.uint16])
@pytest.mark.parametrize("shift", [-32767, -1024, -1, 1, 1024, 32767])
def test_shifted_values_are_the_sums_where_they_fit(tmp_path, kind, shift):
    rng, ends = np.random.default_rng(abs(shift)), np.iinfo(kind)
    for low, high in ((ends.min, ends.max), (0, 100), (ends.max - 100, ends.max), (ends.min, ends.min + 100)):
        stored = rng.integers(low, high, (31, 67), dtype=kind, endpoint=True)
        (tmp_path / "values").write_bytes(b"head" + stored.tobytes())
        values = np.empty_like(stored)
        (found,) = read_parts([Part(tmp_path / "values", 4, values, shift)])
        assert found == (stored.min(), stored.max())
        sums = stored.astype(np.int64) + shift
        fit = fits_short(*found, shift)
        assert fit == bool(min(sums.min(), shift) >= -(2**15) and max(sums.max(), shift) < 2**15)
        if fit:
            assert np.array_equal(values.view(np.int16), sums)


def test_what_is_gone_or_too_short_is_not_read(tmp_path):
    (tmp_path / "short").write_bytes(bytes(20))
    rooms = [np.ones((4, 4), np.int16) for _ in range(3)]
    paths = (tmp_path / "short", tmp_path / "gone", tmp_path)
    found = read_parts([Part(path, 0, room) for path, room in zip(paths, rooms, strict=True)])
    assert found == [None, None, None]


def test_what_cannot_be_written_to_is_left_alone():
    locked = np.zeros((2, 2), np.int16)
    locked.setflags(write=False)
    assert read_parts([Part(None, 0, locked, 5)]) is None
    assert read_parts([Part(None, 0, np.zeros((4, 4), np.int16)[:, ::2], 5)]) is None
    assert read_parts([Part(None, 0, np.zeros((4, 4), np.int32), 5)]) is None


def test_slices_got_ready_together_are_those_decoded_one_by_one(tmp_path):
    phantoms.Scans(form="dicom", sections=9, pixel_size=1.0).write(phantoms.make("potato", seed=2), tmp_path)
    stack = DicomReader().read(tmp_path)
    assert stack.at_hand
    one_by_one = [stack.decode(number) for number in range(len(stack))]
    stack.prefetch(range(1, 5))
    assert sorted(stack.decode._ready) == [1, 2, 3, 4]
    for number, picture in enumerate(one_by_one):
        own = stack.decode(number)
        assert own.dtype == picture.dtype
        assert np.array_equal(own, picture)
        assert not own.flags.writeable
    assert not stack.decode._ready
    with without_kernels():
        stack.prefetch(range(5))
    assert not stack.decode._ready


@pytest.mark.parametrize(("syntax", "plain"), [("explicit", True), ("rle", False)])
def test_compressed_slices_are_kept_and_worked_on_ahead_plain_ones_are_at_hand(tmp_path, syntax, plain):
    scans = phantoms.Scans(form="dicom", sections=5, pixel_size=1.0, syntax=syntax)
    scans.write(phantoms.make("potato", seed=2), tmp_path)
    stack = DicomReader().read(tmp_path)
    assert (stack.at_hand, stack.slow) == (plain, not plain)
    assert bool(ahead_on(stack)) == (not plain)
    stack.prefetch(range(5))
    assert bool(stack.decode._ready) == plain
