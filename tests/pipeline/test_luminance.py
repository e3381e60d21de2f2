"""Slices are decoded without their colours where nobody looks at these; figures are the same to the bit."""

from dataclasses import replace

import numpy as np
import pytest

import stackloft
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.testing import phantoms
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism


class Watching:
    """A sink that looks at pictures."""

    def begin(self, segmentation):
        self.shapes = []

    def add(self, index, picture, section_field):
        self.shapes.append(picture.shape)

    def end(self):
        return tuple(self.shapes)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("meat")
    camera = Photographs(pixel_size=0.4, suffix="jpg", realism=Realism.of("meat", seed=3), sections=8)
    camera.write(phantoms.make("meat"), where)
    return where


def test_figures_do_not_depend_on_who_looks(folder):
    alone = measure(MeasureRequest(folder))
    sink = Watching()
    looked_at = measure(MeasureRequest(folder), sinks=[sink])
    assert all(len(shape) == 3 for shape in sink.shapes)
    assert alone.result.objects[0].volume.value == looked_at.result.objects[0].volume.value
    assert alone.result.objects[0].area.value == looked_at.result.objects[0].area.value


def test_a_stack_gives_luminance_and_another_decoder_its_own(folder):
    stack = stackloft.read(folder)
    assert stack.luminance(0).ndim == 2
    assert stack.decode(0).ndim == 3
    inverted = replace(stack, decode=lambda k: 255 - stack.decode(k))
    assert np.array_equal(inverted.luminance(0), 255 - stack.decode(0))
