"""Checks of segmenters; run them with one pytest call.

::

    @pytest.mark.parametrize("check", segmenter_checks(SegmenterCase(MySegmenter)), ids=str)
    def test_my_segmenter(check):
        check()
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.errors import StackloftError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.registry.options_model import validate
from stackloft.testing.conformance.check import Check, must, suite
from stackloft.testing.conformance.option_checks import check_options, check_shape
from stackloft.testing.conformance.plain_stack import SLICES, as_bytes, body_of, picture_of, stack_of
from stackloft.testing.conformance.watching import watching


@dataclass(frozen=True, slots=True)
class SegmenterCase:
    """One segmenter and what may be asked of it."""

    segmenter: type[Any]
    options: Mapping[str, Any] = field(default_factory=dict)
    change: Callable[[FloatArray], Picture] = as_bytes
    """From grey levels 60 (body) and 200 (background) to the pictures it is made for."""
    area_tolerance: float = 0.02
    """Relative error allowed of a body of some 1600 pixels."""
    centre_tolerance: float = 0.25
    """Pixels."""
    most_decoded: int = 0
    """Slices that ``segment`` itself may decode."""

    def segment(self, stack: SliceStack) -> Segmentation:
        """Return the segmentation of `stack`."""
        values = validate(self.segmenter, self.options, self.segmenter.__name__)
        found: Segmentation = self.segmenter(**values).segment(stack)
        return found

    def mask(self, change: Callable[[FloatArray], Picture] | None = None, k: int = 1) -> BoolArray:
        """Return the body's pixels on slice `k` of the stack whose pictures went through `change`."""
        stack = stack_of(change or self.change)
        return mask_of(self.segment(stack).field_of(k, stack.decode(k)), stack.shape)


def mask_of(section: SectionField, shape: tuple[int, int]) -> BoolArray:
    """Return the pixels above the level, in the whole slice."""
    rows, columns = section.values.shape
    top, left = section.offset
    fits = top >= 0 and left >= 0 and top + rows <= shape[0] and left + columns <= shape[1]
    must(fits, f"the crop {rows} × {columns} at {section.offset} does not lie within the picture {shape}")
    level = section.level if section.local_levels is None else section.local_levels
    mask = np.zeros(shape, dtype=np.bool_)
    mask[top : top + rows, left : left + columns] = section.values > level
    return mask


def shape(case: SegmenterCase) -> None:
    """Check that the registry lets the segmenter in."""
    check_shape("segmenter", case.segmenter)


def options(case: SegmenterCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.segmenter, case.options)


def segments(case: SegmenterCase) -> None:
    """Check that a Segmentation of the same stack is returned, its fields finite and read twice the same."""
    stack = stack_of(case.change)
    found = case.segment(stack)
    must(isinstance(found, Segmentation), f"{type(found).__name__} is returned, not a Segmentation")
    must(len(found) == SLICES, f"{len(found)} slices of {SLICES} are segmented")
    for k in range(SLICES):
        picture = stack.decode(k)
        kept = picture.copy()
        first, second = (found.field_of(k, picture) for _ in range(2))
        must(isinstance(first, SectionField), f"{type(first).__name__} is returned, not a SectionField")
        must(np.isfinite(first.values).all() and np.isfinite(first.level), "a field or level is not finite")
        must(np.array_equal(first.values, second.values), "a second look at a slice gives another field")
        must(first.level == second.level, "a second look at a slice gives another level")
        must(np.array_equal(picture, kept), "the decoded picture is changed")


def finds_the_body(case: SegmenterCase) -> None:
    """Check that the body has its area and lies where it lies, on every slice."""
    stack = stack_of(case.change)
    found = case.segment(stack)
    for k in range(SLICES):
        mask = mask_of(found.field_of(k, stack.decode(k)), stack.shape)
        area, centre = body_of(k)
        must(mask.any(), f"no body on slice {k + 1}")
        error = mask.sum() / area - 1.0
        must(abs(error) <= case.area_tolerance, f"the body on slice {k + 1} has {error:+.1%} of its area")
        off = np.argwhere(mask).mean(axis=0) - centre
        told = f"the body on slice {k + 1} lies {off[0]:+.2f} rows and {off[1]:+.2f} columns off"
        must(np.abs(off).max() <= case.centre_tolerance, told)


def polarity(case: SegmenterCase) -> None:
    """Check that a light body on dark is found as a dark one on light."""
    _must_agree(case, lambda picture: case.change(260.0 - picture), "inverting the grey levels")


def grey_scale(case: SegmenterCase) -> None:
    """Check that scaling and shifting the grey levels changes nothing."""
    _must_agree(case, lambda picture: case.change(0.5 * picture + 50.0), "halving the contrast")
    _must_agree(case, lambda picture: (1e-3 * picture).astype(np.float32), "grey levels 0 to 1 in float")


def depth(case: SegmenterCase) -> None:
    """Check that 8-bit, 16-bit and floating grey levels give the same body."""
    for kind, scale, shift in (
        (np.uint16, 200.0, 0.0),
        (np.int16, 10.0, -1024.0),
        (np.float32, 1.0, 0.0),
        (np.float64, 1.0, 0.0),
        (np.dtype(">u2"), 200.0, 0.0),
    ):
        _must_agree(
            case,
            lambda picture, k=kind, s=scale, b=shift: (s * picture + b).round().astype(k),  # type: ignore[misc]
            f"grey levels as {np.dtype(kind).str}",
        )


def strides(case: SegmenterCase) -> None:
    """Check that how a picture lies in memory changes nothing."""
    _must_agree(case, lambda picture: np.asfortranarray(case.change(picture)), "column-wise memory")
    _must_agree(case, lambda x: np.repeat(case.change(x), 2, axis=1)[:, ::2], "a picture with strides")


def nan(case: SegmenterCase) -> None:
    """Check that pixels that are not a number are refused, or left out: no field or level becomes NaN."""

    def spoilt(picture: FloatArray) -> Picture:
        spotted = picture.astype(np.float32)
        spotted[5:8, 100:104] = np.nan
        return spotted

    try:
        mask = case.mask(spoilt)
    except StackloftError:
        return
    area, _ = body_of(1)
    error = mask.sum() / area - 1.0
    must(abs(error) <= case.area_tolerance, f"a few NaN in the background change the area by {error:+.1%}")


def nothing_there(case: SegmenterCase) -> None:
    """Check that no body is found on an even picture: refused, or nothing above the level."""
    try:
        mask = case.mask(lambda picture: case.change(np.full_like(picture, 200.0)))
    except StackloftError:
        return
    must(not mask.any(), f"{mask.sum()} pixels of an even picture are taken for a body")


def shifted(case: SegmenterCase) -> None:
    """Check that moving the picture by whole pixels moves the body by as many."""
    moved = case.mask(lambda picture: case.change(np.roll(picture, (3, -7), axis=(0, 1))))
    off = _share(moved, np.roll(case.mask(), (3, -7), axis=(0, 1)))
    must(off <= case.area_tolerance, f"moving the picture changes {off:.1%} of the body")


def lazy(case: SegmenterCase) -> None:
    """Check that no more slices are decoded than the case allows, and none again to work one out."""
    decoded: list[int] = []
    stack = stack_of(case.change, decoded)
    decoded.clear()
    found = case.segment(stack)
    must(len(decoded) <= case.most_decoded, f"segment() decodes {len(decoded)} slices by itself")
    decoded.clear()
    found.field_of(2, case.change(picture_of(2)))
    must(not decoded, f"working out one slice decodes slices {', '.join(map(str, decoded))}")


def threads(case: SegmenterCase) -> None:
    """Check that slices worked out on several threads at once are those worked out one by one."""
    stack = stack_of(case.change)
    found = case.segment(stack)
    numbers = list(range(SLICES)) * 4
    alone = [found.field_of(k, stack.decode(k)).values for k in numbers[:SLICES]]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda k: found.field_of(k, stack.decode(k)).values, numbers))
    same = all(np.array_equal(alone[k], values) for k, values in zip(numbers, together, strict=True))
    must(same, "slices worked out at the same time differ from those worked out one by one")


def no_side_effects(case: SegmenterCase) -> None:
    """Check that segmenting writes nothing, asks no network, changes no global state."""
    with tempfile.TemporaryDirectory() as folder:
        case.mask()  # imports what it needs
        with watching(Path(folder)) as watch:
            case.mask()
    must(not watch.deeds, f"segmenting {'; '.join(watch.deeds)}")


def _must_agree(case: SegmenterCase, change: Callable[[FloatArray], Picture], what: str) -> None:
    off = _share(case.mask(change), case.mask())
    must(off <= case.area_tolerance, f"{what} changes {off:.1%} of the body")


def _share(one: BoolArray, other: BoolArray) -> float:
    """Return the part of the body on which two masks differ."""
    return int(np.count_nonzero(one != other)) / max(int(np.count_nonzero(other)), 1)


CHECKS = {
    "plugin-shape": shape,
    "options-validated": options,
    "segments": segments,
    "finds-the-body": finds_the_body,
    "polarity": polarity,
    "grey-scale": grey_scale,
    "grey-depth": depth,
    "strides": strides,
    "not-a-number": nan,
    "nothing-there": nothing_there,
    "shifted": shifted,
    "lazy": lazy,
    "threads": threads,
    "no-side-effects": no_side_effects,
}


def segmenter_checks(case: SegmenterCase, expected_failures: Mapping[str, str] | None = None) -> list[Check]:
    """Return the checks of one segmenter.

    Parameters
    ----------
    case : SegmenterCase
        The segmenter, its options and tolerances.
    expected_failures : mapping, optional
        Reasons by check for those that this segmenter may break; it must then really break them.
    """
    return suite(CHECKS, case, expected_failures or {})
