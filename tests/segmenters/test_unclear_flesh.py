"""Flesh through which the level runs is told; holes, and flesh that is seen well, are not."""

from dataclasses import replace

import numpy as np
import pytest

from stackloft.testing import phantoms
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft_plugins.readers.photos import PhotosReader
from stackloft_plugins.segmenters.half_way import half_way_edge
from stackloft_plugins.segmenters.histogram import HistogramSegmenter
from stackloft_plugins.segmenters.unclear_flesh import UNCLEAR, unclear_share


def told(folder, name, plate, seed):
    look = replace(Realism.of(name, seed=seed), light=0.1)
    Photographs(sections=4, pixel_size=0.4, realism=look, plate=plate, suffix="jpg").write(
        phantoms.make(name), folder
    )
    stack = PhotosReader().read(folder)
    segmentation = HistogramSegmenter().segment(stack)
    fields = [segmentation.field_of(k, stack.decode(k)) for k in range(4)]
    return [notice.code for field in fields for notice in field.notices]


@pytest.mark.parametrize("seed", [1, 2])
def test_a_pale_apple_on_a_white_plate_is_in_doubt(tmp_path, seed):
    assert {"flesh-unsure", "low-contrast"} & set(told(tmp_path, "apple", "white", seed))


@pytest.mark.parametrize(("name", "plate"), [("apple", "black"), ("meat", "white"), ("banana", "white")])
def test_flesh_that_is_seen_well_is_in_no_doubt(tmp_path, name, plate):
    assert told(tmp_path, name, plate, 3) == []


@pytest.mark.parametrize("size", [100, 900])
def test_the_share_does_not_depend_on_the_pixels(size):
    grey = np.full((size, size), 20, dtype=np.float32)
    near, far = round(0.2 * size), round(0.8 * size)
    grey[near:far, near:far] = 120
    flesh = grey[near + 3 : far - 3, near + 3 : far - 3]
    flesh[:, : flesh.shape[1] // 2] = 60  # the left half is pale
    share = unclear_share(grey, half_way_edge(grey, 90.0), 70.0)
    assert share == pytest.approx(0.5, abs=0.03)
    assert share > UNCLEAR
