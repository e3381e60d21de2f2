"""Bodies that touch are cut apart on request; a waist is left alone unless that is asked for."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.sectioning.objects import find_objects

PITCH, PIXEL = 1.5, 0.8


def covered(bodies, shape=(44, 90, 90)):
    """Grey levels 0 to 100 of ellipsoids (centre, half-axes; mm), voxels at the rim partly filled."""
    grid = np.indices(shape).transpose(1, 2, 3, 0) * np.array([PITCH, PIXEL, PIXEL])
    grey = np.zeros(shape)
    for centre, half in bodies:
        away = (grid - centre) / np.array(half)
        square = (away**2).sum(axis=-1)
        slope = 2.0 * np.linalg.norm(away / np.array(half), axis=-1) + 1e-9
        grey = np.maximum(grey, 100 * np.clip(0.5 + (1 - square) / slope, 0, 1))
    return grey


def scan(volume, decoded=None, **kept):
    def decode(number):
        if decoded is not None:
            decoded[number] += 1
        return volume[number]

    z = np.arange(len(volume)) * PITCH
    spacing = np.full((len(volume), 2), PIXEL)
    names = tuple(f"slice {k}" for k in range(len(volume)))
    stack = SliceStack(decode, names, volume.shape[1:], z, spacing, SectionKind.SLAB)
    return Segmentation(stack, lambda k, picture: SectionField(picture, 50.0), fill_voids=True, **kept)


# 10 % of the thinner one's width beyond contact; across slices as well as in their plane
TOUCHING = [
    ([((33.0, 26.0, 20.0), (20.0, 14.0, 12.0)), ((33.0, 36.0, 45.0), (24.0, 17.0, 14.0))]),
    ([((17.0, 36.0, 36.0), (13.0, 17.0, 20.0)), ((45.0, 36.0, 33.0), (16.0, 15.0, 20.0))]),
]


@pytest.mark.parametrize("bodies", TOUCHING)
def test_two_ellipsoids_that_touch_are_each_as_large_as_they_are(bodies):
    whole = scan(covered(bodies))
    assert len(find_objects(whole)) == 1
    found = find_objects(replace(whole, neck=0.6))
    expected = sorted((4 / 3 * np.pi * np.prod(half) for _, half in bodies), reverse=True)
    assert [body.size for body in found] == pytest.approx(expected, rel=0.02)
    assert "bodies-cut" in {notice.code for notice in found[0].segmentation.notices}


def test_a_dumbbell_is_one_body_unless_its_waist_is_asked_to_be_cut():
    ends = [((33.0, 36.0, 18.0), (14.0, 14.0, 14.0)), ((33.0, 36.0, 54.0), (14.0, 14.0, 14.0))]
    dumbbell = scan(covered([*ends, ((33.0, 36.0, 36.0), (7.0, 7.0, 24.0))]))
    assert len(find_objects(dumbbell)) == 1
    assert len(find_objects(replace(dumbbell, neck=0.3))) == 1
    assert len(find_objects(replace(dumbbell, neck=0.8))) == 2


def test_a_slender_bent_body_is_not_cut():
    t = np.linspace(-1.0, 1.0, 25)
    beads = [((33.0, 20.0 + 25.0 * x**2, 36.0 + 24.0 * x), (9.0, 9.0, 9.0)) for x in t]
    assert len(find_objects(scan(covered(beads), neck=0.5))) == 1


def test_no_slice_of_a_scan_is_decoded_twice():
    decoded = Counter()
    stack = scan(covered([((33.0, 36.0, 36.0), (24.0, 20.0, 28.0))]), decoded).stack
    outcome = measure(MeasureRequest("memory", method="all"), product=stack)
    assert set(decoded.values()) == {1}
    assert len(decoded) == len(stack)
    done = {name for name, row in outcome.result.objects[0].methods.items() if row.error is None}
    assert {"loft", "cavalieri", "partial-volume", "voxel", "crofton", "isosurface"} <= done
