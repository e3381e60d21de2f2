"""A body on slices: a scalar field per slice, body where field > level."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.flat_view import taken
from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.notices import Notice
from stackloft.model.reused_memory import empty
from stackloft.model.slice_stack import Picture, SliceStack


def above(values: NDArray[Any], level: float) -> BoolArray:
    """Return where grey levels, whole numbers or not, lie above a level.

    Examples
    --------
    >>> above(np.array([[2, 3]], dtype=np.int16), 2.5).tolist()
    [[False, True]]
    """
    whole = values.dtype.kind in "iu" and math.isfinite(level)  # else they would all become floats
    inside = empty(values.shape, np.bool_)
    return np.asarray(np.greater(values, math.floor(level) if whole else level, out=inside))


@dataclass(frozen=True, slots=True, eq=False)
class SectionField:
    """One slice's grey levels, oriented so that the body is above the level."""

    values: NDArray[Any]
    """(rows, columns) of the crop, of any real dtype: a scan's own whole grey levels need no copy."""
    level: float
    """Body where values > level; the boundary lies sub-pixel on values = level."""
    offset: tuple[int, int] = (0, 0)
    """(row, column) of the crop's first pixel in the slice."""
    threshold: float = float("nan")
    """The level on the picture's own grey scale, for people."""
    local_levels: FloatArray | None = None
    """(rows, columns) or None: the level pixel by pixel where it varies (uneven light)."""
    notices: tuple[Notice, ...] = ()
    outline: NDArray[np.int32] | None = None
    """(k, 2) column, row in the slice: the body's border pixels in order around it, from the leftmost of its
    first row, where somebody has found that the body is one piece without a hole and nowhere held together by
    corners alone. None: not known."""
    unit: float = 1.0
    """Grey levels of the picture's own that one of `values` is: whole numbers may count parts of them."""
    noise: NoiseFloor | None = None
    """What noise still adds to empty pixels of `values`, far below the level; None: nothing."""

    def above(self) -> BoolArray:
        """Return where the body is, (rows, columns).

        Examples
        --------
        >>> SectionField(np.array([[2, 3]], dtype=np.int16), 2.5).above().tolist()
        [[False, True]]
        """
        if self.local_levels is not None:
            return np.asarray(self.values > self.local_levels)
        return above(self.values, self.level)

    def relative(self) -> FloatArray:
        """Return the field above its level, float64: zero on the boundary."""
        level = self.level if self.local_levels is None else self.local_levels
        values = self.values if self.noise is None else self.noise.taken_off(self.values)
        return np.asarray(np.subtract(values, level, dtype=np.float64))

    def relative_where(self, mask: BoolArray) -> FloatArray:
        """Return the same at the True pixels of a mask, (n), row after row.

        Examples
        --------
        >>> section = SectionField(np.array([[2, 3]], dtype=np.int16), 2.5)
        >>> section.relative_where(np.array([[False, True]])).tolist()
        [0.5]
        """
        return self.relative_at(np.flatnonzero(mask))

    def relative_at(self, numbers: IntArray) -> FloatArray:
        """Return the same at pixels by their numbers, (n), counted row after row.

        Examples
        --------
        >>> section = SectionField(np.array([[2, 3], [4, 5]], dtype=np.int16), 2.5)
        >>> section.relative_at(np.array([1, 2])).tolist()
        [0.5, 1.5]
        """
        values = taken(self.values, numbers)
        level = self.level if self.local_levels is None else taken(self.local_levels, numbers)
        grey = values.astype(np.float64) if self.noise is None else self.noise.taken_off(values)
        return np.asarray(np.subtract(grey, level, out=grey))

    def every(self, step: int) -> SectionField:
        """Return every `step`-th pixel of every `step`-th row, for its grey levels; it is at no place."""
        local = None if self.local_levels is None else self.local_levels[::step, ::step]
        return replace(self, values=self.values[::step, ::step], local_levels=local, outline=None)


@dataclass(frozen=True, slots=True, eq=False)
class Beyond:
    """A slice beyond a body's ends, of which the body fills so little that it shows no contour there."""

    position: float
    """mm"""
    pixel_area: float
    """mm²"""
    shown: bool
    """Whether some pixel there is above the level."""
    field: Callable[[], SectionField]
    """Decodes the slice."""


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """What a segmenter makes of a stack; each slice is worked out when asked for."""

    stack: SliceStack
    field_of: Callable[[int, Picture], SectionField]
    """(slice number, decoded picture) to the slice's field; safe to call from several threads. One with a
    true attribute `pointwise` looks at every pixel alone: of a part of a picture it makes that part of it.
    One with an attribute `begun`, of the same arguments, does all there that it needs the picture for, and
    gives what is to be called for the field when the picture has been let go."""
    binary: bool = False
    """True for label maps: no grey levels, so contours are stair-stepped and say so."""
    notices: tuple[Notice, ...] = ()
    labels: tuple[int, ...] = ()
    """The labels that a label map's pictures hold, one for each body; touching labels are bodies of their
    own. Empty for grey levels."""
    fill_voids: bool = False
    """Whether background that is closed in on every side counts as body."""
    neck: float | None = None
    """Bodies that touch are cut apart where the neck between them is narrower than this part of the thinner
    one's width; None: what hangs together is one body."""
    luminance_alone: bool = False
    """Whether `field_of` looks at the luminance of pictures alone."""
    before: tuple[Beyond, ...] = ()
    """Slices before the first one that the body may reach into, in order."""
    after: tuple[Beyond, ...] = ()
    """Slices after the last one that the body may reach into, in order."""
    known_of: Callable[[int], Picture] | None = None
    """The `decode` of whose pictures `field_of` knows enough: as long as it is the stack's own, empty
    pictures do where nobody looks at them."""

    @property
    def pointwise(self) -> bool:
        """Whether the field of a part of a picture is that part of its field, but for the offset."""
        return bool(getattr(self.field_of, "pointwise", False))

    @property
    def knows_its_pictures(self) -> bool:
        """Whether `field_of` takes empty pictures."""
        return self.known_of is not None and self.known_of is self.stack.decode

    def __len__(self) -> int:
        return len(self.stack)

    def field_at(self, index: int) -> SectionField:
        """Return the field of slice `index`, decoding no more of its picture than the field needs."""
        if self.knows_its_pictures:
            return self.field_of(index, np.zeros((0, 0), np.uint8))
        decode = self.stack.luminance if self.luminance_alone else self.stack.decode
        begun = getattr(self.field_of, "begun", None)
        if begun is None:
            return self.field_of(index, decode(index))
        rest: Callable[[], SectionField] = begun(
            index, decode(index)
        )  # here nobody holds the picture any more
        return rest()

    def field_beside(self, index: int, picture: Picture) -> SectionField:
        """Return the same field, to the bit, where the slice's whole `picture` has been decoded anyway."""
        whole = not self.luminance_alone or self.stack.luminance is self.stack.decode
        return self.field_of(index, picture) if whole else self.field_at(index)
