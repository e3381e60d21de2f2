"""The segmenter checks let a correct segmenter through and catch seeded faults, each by its name."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.registry import find
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.segmenter_checks import CHECKS, SegmenterCase, segmenter_checks


@dataclass(frozen=True)
class Middle:
    """Half-way between the background seen on the frame and what differs most from it."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (SliceStack,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)

    def segment(self, stack):
        return Segmentation(stack, self.field)

    def field(self, k, picture):
        grey = self.grey(picture)
        if not np.isfinite(grey).all():
            raise InputError("grey levels that are not finite")
        background = np.median(np.concatenate([grey[0], grey[-1]]))
        low, high = np.percentile(grey, (2, 98))
        body = low if background - low > high - background else high
        if abs(body - background) < 0.1 * max(abs(body), abs(background)):
            raise InputError("no body found")
        sign = self.sign(body, background)
        return SectionField(sign * grey, sign * 0.5 * (body + background))

    def grey(self, picture):
        return picture.astype(np.float64)

    def sign(self, body, background):
        return 1.0 if body > background else -1.0


def fault(name, **methods):
    return dataclass(frozen=True)(type(name, (Middle,), methods))


def changed(change):
    """Return a fault in which the field goes through `change`."""
    return {"field": lambda self, k, picture: change(Middle.field(self, k, picture))}


def decodes_all(self, stack):
    for k in range(len(stack)):
        stack.decode(k)
    return Segmentation(stack, self.field)


def spoils(self, k, picture):
    found = Middle.field(self, k, picture)
    picture[...] = 0
    return found


def sets_numpy(self, k, picture):
    np.random.seed(3)  # noqa: NPY002
    return Middle.field(self, k, picture)


def random_level(self, k, picture):
    found = Middle.field(self, k, picture)
    return replace(found, level=found.level + np.random.default_rng().normal())


def body_anyway(self, k, picture):
    grey = picture.astype(np.float64)
    return SectionField(-grey, -float(np.median(grey)) - 1e-9 if np.ptp(grey) > 60 else -1e9)


def other_slice(self, stack):
    return Segmentation(stack, lambda k, picture: self.field(k, stack.decode(min(k + 1, len(stack) - 1))))


FAULTS = {
    fault("FixedLevel", field=lambda self, k, x: SectionField(-x.astype(float), -130.0)): "grey-scale",
    fault("AlwaysDark", sign=lambda self, body, background: -1.0): "polarity",
    fault("EightBits", grey=lambda self, x: x.astype(np.uint8).astype(float)): "grey-depth",
    fault("RowsForColumns", **changed(lambda f: replace(f, values=f.values.T))): "finds-the-body",
    fault(
        "UpsideDown", **changed(lambda f: replace(f, values=np.ascontiguousarray(f.values[::-1])))
    ): "finds-the-body",
    fault(
        "HalfAPixel", **changed(lambda f: replace(f, values=(f.values + np.roll(f.values, -1, 0)) / 2))
    ): "finds-the-body",
    fault(
        "NotAPixelRight", **changed(lambda f: replace(f, values=np.roll(f.values, 2, 1)))
    ): "finds-the-body",
    fault("CropForgotten", **changed(lambda f: replace(f, values=f.values[9:, 9:]))): "finds-the-body",
    fault("CropOutside", **changed(lambda f: replace(f, offset=(5, 5)))): "finds-the-body",
    fault("TooBig", **changed(lambda f: replace(f, level=f.level - 60.0))): "finds-the-body",
    fault(
        "BackgroundForBody", **changed(lambda f: replace(f, values=-f.values, level=-f.level))
    ): "finds-the-body",
    fault("NoNumber", **changed(lambda f: replace(f, level=float("nan")))): "segments",
    fault("Tuple", **changed(lambda f: (f.values, f.level))): "segments",
    fault("Throws", **changed(lambda f: 1 / 0)): "segments",
    fault("Nothing", segment=lambda self, stack: None): "segments",
    fault("SpoilsThePicture", field=spoils): "segments",
    fault("DiceTheLevel", field=random_level): "segments",
    fault("Hungry", segment=decodes_all): "lazy",
    fault("TheNextSlice", segment=other_slice): "lazy",
    fault("SeedsNumpy", field=sets_numpy): "no-side-effects",
    fault("SeesBodiesEverywhere", field=body_anyway): "nothing-there",
    fault("Flattens", grey=lambda self, x: x.ravel(order="K").reshape(x.shape).astype(float)): "strides",
}


@pytest.mark.parametrize("segmenter", [Middle, find("segmenter", "histogram").plugin])
@pytest.mark.parametrize("name", CHECKS)
def test_correct_segmenters_pass(segmenter, name):
    next(check for check in segmenter_checks(SegmenterCase(segmenter)) if check.name == name)()


@pytest.mark.parametrize("segmenter", FAULTS, ids=lambda found: found.__name__)
def test_seeded_faults_are_caught(segmenter):
    failed = {x.check: x.reason for x in findings(segmenter_checks(SegmenterCase(segmenter))) if not x.passed}
    assert failed.get(FAULTS[segmenter]), failed
