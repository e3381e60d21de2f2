"""Stored values shifted in place: as NumPy does it, and taken back where 16 bits do not hold them."""

import numpy as np
import pytest

from stackloft.compiled.library import without_kernels
from stackloft_plugins.readers.dicom_pixels import rescaled


@pytest.mark.parametrize("kind", [np.int16, np.uint16, np.int8, np.uint8])
@pytest.mark.parametrize("shift", [-40000, -32768, -1024, -1, 1, 1024, 32767, 40000])
def test_shifted_in_place_or_not_values_are_the_same(kind, shift):
    rng = np.random.default_rng(abs(shift))
    ends = np.iinfo(kind)
    for low, high in ((ends.min, ends.max), (0, 100), (ends.max - 100, ends.max), (ends.min, ends.min + 100)):
        stored = rng.integers(low, high, (31, 67), dtype=kind, endpoint=True)
        own = rescaled(stored.copy(), 1.0, float(shift), own=True)
        with without_kernels():
            reference = rescaled(stored.copy(), 1.0, float(shift))
        assert np.array_equal(own.astype(np.int64), stored.astype(np.int64) + shift)
        assert own.dtype == reference.dtype
        assert np.array_equal(own, reference)


def test_a_read_only_picture_is_not_shifted_in_place():
    stored = np.array([[0, 4095]], dtype=np.uint16)
    stored.setflags(write=False)
    assert rescaled(stored, 1.0, -1024.0).tolist() == [[-1024, 3071]]
    assert stored.tolist() == [[0, 4095]]
