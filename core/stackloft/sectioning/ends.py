"""Decide how a stack is closed: what was said, what the height tells, what the areas suggest."""

from __future__ import annotations

from dataclasses import dataclass, replace

from stackloft.geometry.end_model import EndGuess, guess_end, local_exponent
from stackloft.geometry.limb_end import distance_to_limb_end
from stackloft.model.arrays import FloatArray
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SectionKind

FLAT_BELOW = 0.15
"""With a known height, an end whose local exponent is lower is a plane face."""
TIP_ABOVE = 1.6
"""With a known height, an end whose local exponent is higher is a sharp tip."""

CUT_ABOVE = 0.6
"""An outermost area above this fraction of the largest may be a plane cut."""


@dataclass(frozen=True, slots=True)
class PlannedEnd:
    """One end, decided."""

    kind: EndKind
    """face, flat, round or point; never auto."""
    length: float
    """mm beyond the outermost section; 0 for face."""
    reason: str
    guessed: bool
    """True when neither a length nor the height fixed the position."""
    shortest: float = 0.0
    """mm; when guessed, the shortest plausible length."""
    longest: float = 0.0
    """mm; when guessed, the longest plausible length."""
    perhaps_face: bool = False
    """True when the guess may be a plane cut on the outermost section itself."""

    @property
    def extremes(self) -> tuple[PlannedEnd, PlannedEnd]:
        """The two ends between which a guess lies."""
        far = replace(self, length=self.longest)
        if self.perhaps_face:
            return replace(self, kind=EndKind.FACE, length=0.0), replace(self, length=self.length)
        return replace(self, length=self.shortest), far


@dataclass(frozen=True, slots=True, eq=False)
class StackEnds:
    """What deciding the ends needs to know of a stack."""

    positions: FloatArray
    """(m,) mm"""
    areas: FloatArray
    """(m,) mm²"""
    kind: SectionKind
    thickness: float | None
    """A slab's own thickness, mm."""
    seen_beyond: tuple[float, float] = (0.0, 0.0)
    """How far beyond the first and the last section the body still showed, mm."""
    half_widths: FloatArray | None = None
    """(m,) mm: half the smaller width of each section; tells limbs' caps where areas do not."""


def plan_ends(stack: StackEnds, said: tuple[End, End], height: float | None) -> tuple[PlannedEnd, PlannedEnd]:
    """Return both ends of a stack.

    Parameters
    ----------
    stack : StackEnds
    said : pair of End
        What the person (or ``stack.toml``) said.
    height : float, optional
        The body's length along the axis, mm.

    Raises
    ------
    InputError
        The height is smaller than the sections' span, or contradicts both given lengths.
    UsageError
        ``flat`` without a length, and neither height nor slab to take it from.
    """
    first = _plan(stack, said[0], at_last=False, height_known=height is not None)
    last = _plan(stack, said[1], at_last=True, height_known=height is not None)
    if height is None:
        return first, last
    return _fit_height(stack, said, (first, last), height)


def _inward(stack: StackEnds, *, at_last: bool) -> tuple[FloatArray, FloatArray]:
    """Return areas and depths from the outermost section inwards."""
    if at_last:
        return stack.areas[::-1], (stack.positions[-1] - stack.positions)[::-1]
    return stack.areas, stack.positions - stack.positions[0]


def _guess(stack: StackEnds, *, at_last: bool) -> EndGuess:
    areas, depth = _inward(stack, at_last=at_last)
    limb = None
    if stack.half_widths is not None:
        widths = stack.half_widths[::-1] if at_last else stack.half_widths
        limb = distance_to_limb_end(areas, widths, depth)
    return guess_end(areas, depth, float(depth[1]), stack.seen_beyond[at_last], limb)


def _plan(stack: StackEnds, end: End, *, at_last: bool, height_known: bool) -> PlannedEnd:
    """Return the end as far as it can be decided without the height."""
    if end.kind is EndKind.FACE:
        return PlannedEnd(EndKind.FACE, 0.0, "given: the outermost section is the face", guessed=False)
    if end.length is not None:
        return PlannedEnd(end.kind, end.length, "given", guessed=False)
    if end.kind is EndKind.FLAT:
        if stack.kind is SectionKind.SLAB and stack.thickness is not None:
            half = 0.5 * stack.thickness
            return PlannedEnd(EndKind.FLAT, half, "half a slab beyond the last slice", guessed=False)
        if not height_known:
            raise UsageError(
                "a flat end needs its distance from the last section",
                where="--ends",
                found="flat",
                expected="flat:LEN, or --height, or face when the last section is the end face",
            )
    guess = _guess(stack, at_last=at_last)
    kind = end.kind
    if kind is EndKind.AUTO:
        kind = EndKind.POINT if guess.pointed else EndKind.ROUND
    elif kind is EndKind.POINT and not guess.pointed:
        guess = replace(guess, reason=f"{guess.reason}; given as pointed")
    areas, _ = _inward(stack, at_last=at_last)
    return PlannedEnd(
        kind,
        guess.length,
        guess.reason,
        guessed=True,
        shortest=guess.shortest,
        longest=guess.longest,
        perhaps_face=bool(areas[0] > CUT_ABOVE * areas.max()),
    )


def _fit_height(
    stack: StackEnds, said: tuple[End, End], ends: tuple[PlannedEnd, PlannedEnd], height: float
) -> tuple[PlannedEnd, PlannedEnd]:
    """Return the ends with their unknown lengths filled from the body's height."""
    span = float(stack.positions[-1] - stack.positions[0])
    known = sum(end.length for end in ends if not end.guessed)
    rest = height - span - known
    open_ends = [end for end in ends if end.guessed]
    if not open_ends:
        if abs(rest) > 0.01 * height:
            raise InputError(
                "the height contradicts the sections and the ends",
                where="--height",
                found=f"{height:g} mm",
                expected=f"{span + known:g} mm (span {span:g} mm + ends {known:g} mm)",
                fix="correct --height, the thickness or --ends",
            )
        return ends
    if rest <= 0.0:
        raise InputError(
            "the height leaves nothing beyond the outermost sections",
            where="--height",
            found=f"{height:g} mm",
            expected=f"more than {span + known:g} mm",
            fix="correct --height or the thickness; --ends face when the outermost sections are the ends",
        )
    share = rest / sum(end.length for end in open_ends)
    first, last = (
        _with_height(stack, end, given, share, at_last=at_last)
        for end, given, at_last in zip(ends, said, (False, True), strict=True)
    )
    return first, last


def _with_height(stack: StackEnds, end: PlannedEnd, given: End, share: float, *, at_last: bool) -> PlannedEnd:
    """Return an end whose length is its share of the height; ``auto`` is decided anew."""
    if not end.guessed:
        return end
    length = end.length * share
    kind = end.kind
    reason = "from the height"
    if given.kind is EndKind.AUTO:
        areas, depth = _inward(stack, at_last=at_last)
        q = local_exponent(areas, depth, length)
        kind = EndKind.FLAT if q < FLAT_BELOW else EndKind.POINT if q > TIP_ABOVE else EndKind.ROUND
        reason = f"from the height; the area closes with exponent {q:.2f}"
    return PlannedEnd(kind, length, reason, guessed=False)
