"""The bands beside an outline, sought in tiles, are those of the whole picture; so is the body itself."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft_plugins.segmenters.body_outline import main_outline, outline_in
from stackloft_plugins.segmenters.body_window import main_body

NEAR, FAR = (cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * r + 1, 2 * r + 1)) for r in (1, 2))


def eroded(mask, disc):
    return cv2.erode(mask, disc, borderType=cv2.BORDER_CONSTANT, borderValue=1)


def blobs(rows, columns, seed):
    rng = np.random.default_rng(seed)
    noise = cv2.GaussianBlur(rng.normal(size=(rows, columns)), (0, 0), rng.uniform(0.5, 12))
    return noise > np.quantile(noise, rng.uniform(0.1, 0.9))


@settings(max_examples=60, deadline=None)
@given(st.integers(3, 150), st.integers(3, 150), st.integers(0, 2**32 - 1))
def test_bands_are_those_of_the_whole_picture(rows, columns, seed):
    inside = blobs(rows, columns, seed)
    outline, body = outline_in(inside), main_body(inside.astype(np.uint8))
    assert np.array_equal(outline.mask(), body)
    assert outline.area == body.sum()
    inner = np.flatnonzero(eroded(body, NEAR) > eroded(body, FAR))
    if not len(inner):
        inner = np.flatnonzero(body > eroded(body, FAR))
    assert np.array_equal(np.sort(outline.inner), inner)
    assert np.array_equal(
        np.sort(outline.outer), np.flatnonzero(cv2.dilate(body, FAR) > cv2.dilate(body, NEAR))
    )


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_a_part_of_the_mask_is_that_part(seed):
    outline = outline_in(blobs(90, 110, seed))
    window = np.s_[20:61, 33:100]
    assert np.array_equal(outline.part(window), outline.mask()[window])


@pytest.mark.parametrize("dtype", [np.int16, np.float32])
def test_above_a_level_between_whole_numbers(dtype):
    levels = np.zeros((20, 30), dtype)
    levels[5:15, 8:20], levels[5, 8] = 3, 2
    assert main_outline(levels, 2.5).area == 119
    assert main_outline(levels, 1.5).area == 120


def test_nothing_above_the_level():
    outline = main_outline(np.zeros((20, 30), np.int16), 5.0)
    assert outline.area == len(outline.inner) == len(outline.outer) == 0
    assert not outline.mask().any()
