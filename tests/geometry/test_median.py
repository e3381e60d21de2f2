"""Medians by selection, and noise's floor taken off wherever pixels are looked at."""

import numpy as np
import pytest

from stackloft.geometry.median import median
from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.model.segmentation import SectionField


@pytest.mark.parametrize("dtype", [np.int16, np.float32, np.float64])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 100, 101])
def test_median_is_that_of_the_sorted_values(count, dtype):
    values = (1000 * np.random.default_rng(count).normal(size=count)).astype(dtype)
    ordered = np.sort(values).astype(np.float64)
    assert median(values) == 0.5 * (ordered[(count - 1) // 2] + ordered[count // 2])


def test_every_way_to_look_at_a_field_takes_the_floor_off():
    values = np.arange(-1000, -1000 + 36, dtype=np.int16).reshape(6, 6)
    floor = NoiseFloor.over(-1000.0, 4.0)
    section = SectionField(values, -970.5, noise=floor)
    expected = np.where(values < -990, values - 4.0, values) + 970.5
    mask = np.random.default_rng(1).random((6, 6)) > 0.5
    assert section.relative().tolist() == expected.tolist()
    assert section.relative_where(mask).tolist() == expected[mask].tolist()
    assert section.every(2).relative().tolist() == expected[::2, ::2].tolist()
    assert (section.above() == (expected > 0)).all()
    assert NoiseFloor.over(-1000.0, 0.0) is None
