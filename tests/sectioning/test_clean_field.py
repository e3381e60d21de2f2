"""Voxels and contours see the same body: crumbs dropped, glare filled, holes kept."""

import numpy as np
import pytest

from stackloft.model.segmentation import SectionField
from stackloft.sectioning.clean_field import clean_field
from stackloft.sectioning.tracing import trace_field


def plate(*boxes):
    grey = np.full((80, 90), 10.0)
    for rows, columns, level in boxes:
        grey[slice(*rows), slice(*columns)] = level
    return grey


BODY = ((10, 60), (10, 60), 110.0)


@pytest.mark.parametrize(
    ("boxes", "area"),
    [
        ((BODY,), 2500),
        ((BODY, ((70, 74), (70, 74), 110.0)), 2500),  # a crumb
        ((BODY, ((65, 79), (10, 60), 110.0)), 2500 + 700),  # a branch
        ((BODY, ((20, 23), (20, 23), 40.0)), 2500),  # glare
        ((BODY, ((20, 40), (20, 40), 12.0)), 2500 - 400),  # a hole through which the plate is seen
        ((BODY, ((20, 40), (20, 40), 45.0)), 2500),  # fat: nearer the level than the plate
    ],
)
def test_the_same_body_as_the_contours(boxes, area):
    section = SectionField(plate(*boxes), 60.0)
    assert np.count_nonzero(clean_field(section, labels=False) > 0) == area
    traced = trace_field(section, (1.0, 1.0), (80, 90), "a")
    assert sum(loop.signed_area for loop in traced.loops) == pytest.approx(area, rel=0.03)


def test_a_label_map_is_taken_as_it_is():
    grey = plate(BODY, ((70, 72), (70, 72), 110.0), ((20, 22), (20, 22), 10.0))
    field = clean_field(SectionField(grey, 60.0), labels=True)
    assert np.count_nonzero(field > 0) == 2500 + 4 - 4
    np.testing.assert_array_equal(field, grey - 60.0)


def test_levels_that_vary_are_followed():
    grey = plate(BODY) + np.arange(90.0)
    section = SectionField(grey, 60.0, local_levels=np.broadcast_to(60.0 + np.arange(90.0), grey.shape))
    assert np.count_nonzero(clean_field(section, labels=False) > 0) == 2500


def test_an_empty_slice_stays_empty():
    assert not (clean_field(SectionField(plate(), 60.0), labels=False) > 0).any()
