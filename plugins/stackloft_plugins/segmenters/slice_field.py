"""One slice's field: where the body is looked for, at which level, and what a person should know."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import cv2
import numpy as np

from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField
from stackloft.model.slice_stack import Picture
from stackloft_plugins.segmenters.across_edge import across
from stackloft_plugins.segmenters.body_window import Background, background_of, body_window, coarse_step
from stackloft_plugins.segmenters.edge_level import edge_level
from stackloft_plugins.segmenters.flat_field import Light, Window, fit_light
from stackloft_plugins.segmenters.glare import glare_notice, without_glare
from stackloft_plugins.segmenters.grey import Grey, Levels, filtered, grey_levels, single
from stackloft_plugins.segmenters.half_way import Edge, edge_at, grain, half_way_edge
from stackloft_plugins.segmenters.histogram_levels import histogram_level
from stackloft_plugins.segmenters.local_level import on_one_level
from stackloft_plugins.segmenters.unclear_flesh import unclear_notice, unclear_share
from stackloft_plugins.segmenters.window_levels import window_levels

_NO_STEP = 4.0  # a boundary whose step is below this many standard deviations of noise is none
_FAINT = 10.0
_NO_STEP_OF_SCALE = 0.015  # likewise, as a fraction of the picture's full scale
_FAINT_OF_SCALE = 0.10

_REPAIR = (
    "give [slice.N] threshold or mask in stack.toml, or set skip = true there; "
    "where body and plate differ by colour alone, --segmenter colour"
)


@dataclass(frozen=True, slots=True)
class LevelRules:
    """How the level of a slice is found."""

    method: str = "half-way"
    threshold: float | None = None
    """Given: no other is sought."""
    channel: str = "luminance"
    background: str | None = None
    """``light`` or ``dark``; None: found from the frame."""

    @property
    def settles(self) -> bool:
        """Whether the level is sought at the body's edge."""
        return self.threshold is None and self.method == "half-way"


def slice_field(picture: Picture, rules: LevelRules, name: str) -> SectionField:
    """Return the field of one slice, cropped to the body and a margin.

    Raises
    ------
    InputError
        There is no body in the picture `name`.

    Examples
    --------
    >>> plate = np.full((60, 80), 240, dtype=np.uint8)
    >>> plate[20:40, 20:60] = 90
    >>> field = slice_field(plate, LevelRules(), "a.png")
    >>> field.offset, field.values.shape, field.threshold
    ((7, 7), (46, 66), 165.0)
    """
    return begun_field(picture, rules, name)()


def begun_field(picture: Picture, rules: LevelRules, name: str) -> Callable[[], SectionField]:
    """Return what makes the same field, without the picture, when it is called."""
    look = _coarse_look(picture, rules, name)
    grey, unit = window_levels(picture, look.window, rules.channel, look.sign, look.light)
    return partial(_settled, look, grey, unit, rules, name)


def _settled(look: _Look, grey: Levels, unit: float, rules: LevelRules, name: str) -> SectionField:
    sign = look.sign
    edge = _edge(grey, sign * look.first / unit, rules, name)
    seen = across(grey, edge.outline, edge.level) if rules.settles else None
    level = sign * look.first / unit if seen is None else edge_level(edge, seen)
    notices = list(_contrast_notices(grey, edge, look.scale, unit, name))
    notices += unclear_notice(unclear_share(grey, edge, level), name)
    if rules.background is None and not look.background.sure:
        notices.append(_unsure(name))
    if rules.settles:
        grey, edge = on_one_level(grey, edge, level, seen if level == edge.level else None, unit)
    if sign < 0.0:
        grey, share = without_glare(grey, level, edge)
        notices += glare_notice(share, name)
    return SectionField(
        values=read_only(grey),
        level=single(level),
        offset=(look.window[0].start, look.window[1].start),
        threshold=sign * level * unit,
        notices=tuple(notices),
        unit=unit,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Look:
    """What every few pixels tell of a picture."""

    window: Window
    """Where the body is."""
    first: float
    """A grey level that tells body and background apart."""
    sign: float
    """1 for a body lighter than its background, else -1."""
    light: Light | None
    background: Background
    scale: float
    """Range of grey levels."""


def _coarse_look(picture: Picture, rules: LevelRules, name: str) -> _Look:
    shape: tuple[int, int] = picture.shape[:2]
    step = coarse_step(shape)
    coarse = grey_levels(filtered(picture[::step, ::step], rules.channel))
    first = _first_level(picture, coarse, rules, name)
    background = background_of(coarse, first)
    sign = 1.0 if (background.dark if rules.background is None else rules.background == "dark") else -1.0
    light = None
    if sign < 0.0 and rules.settles:
        light = fit_light(coarse, (coarse < first).astype(np.uint8), step, shape)
        if light is not None:
            coarse = light.flattened(coarse, np.s_[::step, ::step])
            first = _first_level(picture, coarse, rules, name)
    seen = (sign * coarse > sign * first).astype(np.uint8)
    window = body_window(seen, step, shape)
    if window is None:
        raise _no_body(name, f"nothing {'above' if sign > 0 else 'below'} grey level {first:g}")
    return _Look(window, first, sign, light, background, _full_scale(picture, coarse))


def mask_field(path: Path, shape: tuple[int, int], name: str, turned: str | None = None) -> SectionField:
    """Return the field of a slice whose body a person has drawn white on black.

    `turned` says how the picture was turned back that the mask was drawn on: ``left-right``, ``up-down``.

    Raises
    ------
    InputError
        The mask is missing, damaged, of another size, or of one colour only.
    """
    try:
        encoded = np.fromfile(path, dtype=np.uint8)
    except OSError as error:
        raise InputError(f"the mask of {name} cannot be opened", where=str(path), found=str(error)) from error
    mask = cv2.imdecode(encoded, cv2.IMREAD_GRAYSCALE) if encoded.size else None
    if mask is None:
        raise InputError(f"the mask of {name} is no picture", where=str(path), fix="save it as PNG")
    if mask.shape != shape:
        raise InputError(
            f"the mask of {name} has another size",
            where=str(path),
            found=f"{mask.shape[1]} × {mask.shape[0]} pixels",
            expected=f"{shape[1]} × {shape[0]}",
        )
    if mask.min() == mask.max():
        raise InputError(
            f"the mask of {name} is of one colour", where=str(path), expected="body white, rest black"
        )
    if turned is not None:
        mask = np.ascontiguousarray(mask[:, ::-1] if turned == "left-right" else mask[::-1])
    level = 0.5 * (float(mask.min()) + float(mask.max()))
    return SectionField(read_only(mask.astype(np.float64)), level, threshold=level)


def _first_level(picture: Picture, coarse: Grey, rules: LevelRules, name: str) -> float:
    if rules.threshold is not None:
        return rules.threshold
    if rules.method == "half-way":
        return histogram_level(coarse, "otsu", name)
    return histogram_level(grey_levels(filtered(picture, rules.channel)), rules.method, name)


def _edge(grey: Levels, first: float, rules: LevelRules, name: str) -> Edge:
    edge = half_way_edge(grey, first) if rules.settles else edge_at(grey, first)
    if edge is None:
        raise _no_body(name, "no boundary between a body and its background")
    return edge


def _full_scale(picture: Picture, coarse: Grey) -> float:
    """Return 255 for 8-bit pictures; others seldom use all of their scale, so the range that occurs."""
    return 255.0 if picture.dtype == np.uint8 else float(np.ptp(coarse))


def _contrast_notices(grey: Levels, edge: Edge, scale: float, unit: float, name: str) -> tuple[Notice, ...]:
    step, noise = unit * edge.contrast, unit * edge.noise
    if step < _FAINT * noise:  # shadow and juice beside the body are no noise
        noise = min(noise, unit * grain(grey, edge.outline.outer))
    if step < _NO_STEP * noise or step < _NO_STEP_OF_SCALE * scale:
        raise _no_body(name, f"a step of {step:.3g} grey levels at the boundary, noise {noise:.2g}")
    if step >= max(_FAINT * noise, _FAINT_OF_SCALE * scale):
        return ()
    message = (
        f"{name}: body and background differ by only {step:.3g} grey levels (noise {noise:.2g}); "
        "look at its contour; where they differ by colour, --segmenter colour tells them apart"
    )
    return (Notice("low-contrast", message),)


def _no_body(name: str, found: str) -> InputError:
    return InputError("no body found", where=name, found=found, fix=_REPAIR)


def _unsure(name: str) -> Notice:
    message = (
        f"{name}: the picture's frame is partly light and partly dark, so which of them is background is "
        'a guess; set background = "light" or "dark" in stack.toml'
    )
    return Notice("background-unsure", message)
