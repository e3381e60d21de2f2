r"""Body and plate told apart by colour, for flesh whose grey is near the plate's.

::

    L*a*b*  body .                      RGB   plate ---------*--------- body
             \  ΔE                            half-way along this line lies the edge: a pixel that is
              . plate                         covered by half is the mean of both colours

The body is where the colour differs from the plate's (CIE 1976 L*a*b* difference, Otsu's threshold). That
difference is not proportional to how much of a pixel the body covers, so the boundary itself is sought on
the line from the plate's colour to that of the body's edge in RGB, half-way as in `half_way`. Of flesh that
has a colour of its own, shadows on the plate do not count (`plate_shades`). That line tells the boundary:
deep within, where flesh may be paler than its skin, the difference has the word.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import cv2
import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import BoolArray, read_only
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.alignment import HOW, laid_out
from stackloft_plugins.segmenters.across_edge import across
from stackloft_plugins.segmenters.body_outline import Outline, main_outline
from stackloft_plugins.segmenters.body_window import body_window, coarse_step, main_body
from stackloft_plugins.segmenters.edge_level import edge_level
from stackloft_plugins.segmenters.flat_field import Light, fit_light
from stackloft_plugins.segmenters.glare import glare_notice, without_glare
from stackloft_plugins.segmenters.grey import Grey, median_filtered
from stackloft_plugins.segmenters.half_way import Edge, grain, half_way_edge
from stackloft_plugins.segmenters.histogram_levels import histogram_level
from stackloft_plugins.segmenters.local_level import on_one_level
from stackloft_plugins.segmenters.plate_shades import (
    across_shades,
    difference_from_shades,
    lab_difference,
    tells_without_light,
)
from stackloft_plugins.segmenters.slice_field import mask_field

_FRAME = 0.02  # of the shorter side
_PLATE = 5.0
"""Robust standard deviations of the plate's own colour."""
_FINEST = 0.5  # L*a*b*: no plate is more even
_BRIGHT = 60.0  # of 255
_NO_STEP = 4.0  # standard deviations of the plate's noise
_LEAST_STEP = 6.0  # of 255
_DEEP = 4
"""Pixels from the boundary, beyond the bands that settle its level and beyond the median filter's reach."""


@dataclass(frozen=True, slots=True)
class ColourSegmenter:
    """Segments by the colour difference from the plate, whose colour is the frame's usual one.

    ``[slice.N] threshold`` in ``stack.toml`` is a colour difference here; ``mask`` works as ever.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> plate = np.full((60, 80, 3), 128, dtype=np.uint8)
    >>> plate[20:40, 20:60] = (190, 105, 100)               # as grey as the plate
    >>> stack = SliceStack(lambda k: plate, ("a", "b"), (60, 80), np.array([0.0, 5.0]),
    ...                    np.full((2, 2), 0.3), SectionKind.FACE)
    >>> field = ColourSegmenter().segment(stack).field_of(0, plate)
    >>> int((field.values > field.level).sum())             # 800, less the corners that the median rounds
    796
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (SliceStack,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)
    general: ClassVar[bool] = False

    threshold: float | None = option(
        None, "colour difference (L*a*b*) that is body; given, none is sought", gt=0, source="CIE 1976"
    )
    align: str = option(
        "auto",
        "photographs laid down one by one: how they are laid on each other; auto: as stack.toml says, or not",
        choices=("auto", *HOW),
    )

    def segment(self, stack: SliceStack) -> Segmentation:
        """Return the segmentation; slices are decoded here only to be aligned by their sections."""

        def field_of(number: int, picture: Picture) -> SectionField:
            said: Mapping[str, Any] = stack.hints.slices.get(number + 1, {})
            name = stack.names[number]
            if "mask" in said:
                return mask_field(said["mask"], stack.shape, name, said.get("turned"))
            return colour_field(picture, said.get("threshold", self.threshold), name)

        return laid_out(Segmentation(stack, field_of), self.align)


def colour_field(picture: Picture, threshold: float | None, name: str) -> SectionField:
    """Return the field of one slice, cropped to the body and a margin.

    Raises
    ------
    InputError
        The picture is grey, or shows no body of another colour than the plate.
    """
    if picture.ndim != 3:
        raise InputError(
            "has no colours to tell the body by", where=name, found="grey", fix="use the histogram segmenter"
        )
    full = float(np.iinfo(picture.dtype).max) if picture.dtype.kind in "iu" else float(picture.max())
    shape: tuple[int, int] = picture.shape[:2]
    step = coarse_step(shape)
    coarse = _scaled(picture[::step, ::step], full)
    plate, apart, blind = _look(coarse)
    level = _level(apart, name) if threshold is None else threshold
    light = _light(coarse, apart > level, step, shape)
    if light is not None:
        coarse /= light.at(np.arange(0, shape[0], step), np.arange(0, shape[1], step), np.float32)[..., None]
        plate, apart, blind = _look(coarse)
        level = _level(apart, name) if threshold is None else threshold
    window = body_window((apart > level).astype(np.uint8), step, shape)
    if window is None:
        raise _no_body(name, f"no colour differs from the plate's by {level:.3g}")
    colours = _scaled(picture[window], full)
    if light is not None:
        for some, own in light.strips(window):
            colours[some] /= own[..., None]
    difference = difference_from_shades if blind else lab_difference
    body = main_outline(median_filtered(difference(colours, plate)), level)
    grey, half = _along(colours, body, plate if blind else None)
    if grey is not None:
        grey = _deep_within(grey, body)
    edge = None if grey is None else half_way_edge(grey, half)
    if grey is None or edge is None or _is_lost(grey, edge):
        raise _no_body(name, "no boundary between two colours")
    seen = across(grey, edge.outline, edge.level)
    settled = edge_level(edge, seen)
    grey, edge = on_one_level(grey, edge, settled, seen if settled == edge.level else None)
    notices: tuple[Notice, ...] = ()
    if float(plate.sum()) > float(np.median(colours[edge.mask > 0], axis=0).sum()):  # a light plate
        grey, share = without_glare(grey, settled, edge)
        notices = glare_notice(share, name)
    return SectionField(
        values=read_only(grey.astype(np.float64)),
        level=settled,
        offset=(window[0].start, window[1].start),
        threshold=settled,
        notices=notices,
    )


def _level(apart: Grey, name: str) -> float:
    """Return the difference between plate and body: Otsu's, with all that is further off counted as body.

    Reflections and seeds may differ from the plate by far more than the flesh does; left as they are they
    would be the one class, and plate and flesh the other.
    """
    frame = _frame(apart)
    usual = float(np.median(frame))
    beyond = usual + _PLATE * max(1.4826 * float(np.median(np.abs(frame - usual))), _FINEST)
    body = main_body((apart > beyond).astype(np.uint8)) > 0
    if not body.any():
        return histogram_level(apart, "otsu", name)
    return histogram_level(np.minimum(apart, np.float32(np.median(apart[body]))), "otsu", name)


def _light(coarse: Grey, body: BoolArray, step: int, shape: tuple[int, int]) -> Light | None:
    """Return the light over a bright plate; None where the plate is too dark, or too little seen, to tell."""
    grey = np.asarray(255.0 * cv2.cvtColor(coarse, cv2.COLOR_RGB2GRAY), dtype=np.float32)
    if np.median(grey[~body]) < _BRIGHT:
        return None
    return fit_light(grey, body.astype(np.uint8), step, shape)


def _is_lost(grey: Grey, edge: Edge) -> bool:
    """Tell whether the step is no more than noise, shadow and juice put aside."""
    step = edge.contrast
    return step < _LEAST_STEP or (
        step < _NO_STEP * edge.noise and step < _NO_STEP * grain(grey, edge.outline.outer)
    )


def _scaled(part: Picture, full: float) -> Grey:
    """Return RGB from 0 to 1."""
    return np.ascontiguousarray(part, dtype=np.float32) / np.float32(full)


def _plate(colours: Grey) -> Grey:
    """Return the frame's usual colour, (3)."""
    return np.asarray(np.median(_frame(colours).reshape(-1, 3), axis=0), np.float32)


def _frame(values: Grey) -> Grey:
    """Return the picture's outermost pixels, which show plate."""
    width = max(1, round(_FRAME * min(values.shape[:2])))
    edges = (values[:width], values[-width:], values[:, :width], values[:, -width:])
    return np.concatenate([edge.reshape(-1, *values.shape[2:]) for edge in edges])


def _look(coarse: Grey) -> tuple[Grey, Grey, bool]:
    """Return the plate's colour, every pixel's difference from it, and whether that leaves its shades out."""
    plate = _plate(coarse)
    apart, blind = lab_difference(coarse, plate), difference_from_shades(coarse, plate)
    if tells_without_light(apart, blind, _frame(blind), plate):
        return plate, median_filtered(blind), True
    return plate, median_filtered(apart), False


def _along(colours: Grey, body: Outline, shades_of: Grey | None) -> tuple[Grey | None, float]:
    """Return how far each pixel lies on the way from the plate beside the edge to the body, and half of it.

    Lengths of the way are those of RGB from 0 to 255. Reflections and crumbs may lie beyond either end.
    Given the plate's colour, only the way's part across its shades counts.
    """
    inner, outer = body.inner, body.outer
    if not len(inner) or not len(outer):
        return None, 0.0
    pixels = colours.reshape(-1, 3)
    beside = np.median(pixels[outer], axis=0)
    way = np.median(pixels[inner], axis=0) - beside
    if shades_of is not None:
        way = across_shades(way, shades_of)
    length = float(np.linalg.norm(way))
    if length == 0.0:
        return None, 0.0
    grey = np.asarray(255.0 * ((colours - beside) @ (way / length)), dtype=np.float32)
    return median_filtered(grey), 127.5 * length


def _deep_within(grey: Grey, body: Outline) -> Grey:
    """Return the grey levels with no pixel deep within the body below its edge's own."""
    deep = cv2.erode(body.mask(), np.ones((2 * _DEEP + 1, 2 * _DEEP + 1), np.uint8)) > 0
    return np.where(deep, np.maximum(grey, np.float32(np.median(grey.ravel()[body.inner]))), grey)


def _no_body(name: str, found: str) -> InputError:
    return InputError(
        "no body of another colour found",
        where=name,
        found=found,
        fix="give --set segmenter.threshold=DIFFERENCE, or a mask for it in stack.toml",
    )
