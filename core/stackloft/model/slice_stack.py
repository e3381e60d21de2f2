"""A stack of grey or colour slices, decoded on demand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.ends import End
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.scale import ScaleUncertainty

Picture = NDArray[Any]
"""One decoded slice: (rows, columns) grey or (rows, columns, 3) RGB, any real dtype."""


class SectionKind(StrEnum):
    """What one slice shows."""

    FACE = "face"
    """A photographed cut: the section at one plane."""
    SILHOUETTE = "silhouette"
    """The outline seen from above."""
    SLAB = "slab"
    """A scan's slice of finite thickness, which may be thinner than the pitch."""


@dataclass(frozen=True, slots=True, eq=False)
class Hints:
    """What the folder's ``stack.toml`` (or the format) tells beyond the pictures; flags win over it."""

    ends: tuple[End, End] | None = None
    height: float | None = None
    """The body's length along the axis, mm."""
    background: str | None = None
    """``light`` or ``dark``; None: found from the picture."""
    specimen: str | None = None
    measured_weight: float | None = None
    """g"""
    measured_volume: float | None = None
    """mm³"""
    slices: Mapping[int, Mapping[str, Any]] = field(default_factory=dict)
    """Per-slice overrides (``threshold``, ``mask``, ``links``) by slice number, counted from 1."""
    align: str | None = None
    """``none``, ``translation`` or ``rigid``; None: not said."""
    links: Mapping[str, tuple[tuple[int, int], ...]] = field(default_factory=dict)
    """By a section's name: which of its loops go on as which of the next one's, numbered from 1 by size."""


@dataclass(frozen=True, slots=True, eq=False)
class SliceStack:
    """Slices in order along the axis, in millimetres.

    In-plane coordinates: x = column·column spacing, y = row·row spacing, z = position: the picture is
    seen along +z, so (x, y, z) is right-handed. Pixel (0, 0)'s centre is the in-plane origin, or lies at
    the slice's own origin when slices are scaled about a principal point, or were laid down one by one and
    are aligned: x = origin + column·spacing. A slice may also be turned about that pixel (`placed`).
    """

    decode: Callable[[int], Picture]
    """Slice number (from 0) to picture; decodes that slice alone; safe to call from several threads. It may
    have attributes ``luminance``, ``at_hand``, ``slow`` and ``prefetch``, see there."""
    names: tuple[str, ...]
    """(m) file name or slice label, for messages."""
    shape: tuple[int, int]
    """(rows, columns), the same for every slice."""
    positions: FloatArray
    """(m) mm, strictly increasing."""
    pixel_spacing: FloatArray
    """(m, 2) mm: row spacing, column spacing of each slice."""
    kind: SectionKind
    thickness: FloatArray | None = None
    """(m) mm, a slab's own thickness; None for faces."""
    affine: FloatArray = field(default_factory=lambda: frozen_floats(np.eye(4)))
    """(4, 4) from stack millimetres (x, y, z, 1) to patient/bench millimetres; shear is gantry tilt."""
    origins: FloatArray | None = None
    """(m, 2) mm: x, y of pixel (0, 0)'s centre in each slice; None: all at 0."""
    turns: FloatArray | None = None
    """(m) rad from x to y, about pixel (0, 0)'s centre; None: no slice is turned."""
    marks: FloatArray | None = None
    """(m, k, 2) column, row of fiducial marks that moved with each slice, the same ones in the same order;
    NaN where one was not seen. None: there are none."""
    scale_uncertainty: ScaleUncertainty | None = None
    """How well the pixel spacing is known; None: nothing is known of that."""
    hints: Hints = field(default_factory=Hints)
    notices: tuple[Notice, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)
    """How the geometry was learned, for example ``{"pixel size": "--pixel-size"}``; no personal data."""

    def __post_init__(self) -> None:
        check_slice_stack(self)

    def __len__(self) -> int:
        return len(self.names)

    @property
    def luminance(self) -> Callable[[int], Picture]:
        """As `decode`, for those who look at luminance alone.

        It may give grey levels where the file holds these beside its colours, which saves time and memory.
        Being the decoder's own, it goes when another decoder takes its place.
        """
        own: Callable[[int], Picture] = getattr(self.decode, "luminance", self.decode)
        return own

    @property
    def at_hand(self) -> bool:
        """Whether the decoder says that a slice costs no more to decode again than to keep.

        So it is with pixels that lie in a file as they are: memory that is taken for the first time costs as
        much as reading them once more.
        """
        return bool(getattr(self.decode, "at_hand", False))

    @property
    def slow(self) -> bool:
        """Whether the decoder says that a slice takes milliseconds in which other threads may work.

        So it is with compressed pixels; slices of photographs and large ones are taken to be slow anyway.
        """
        return bool(getattr(self.decode, "slow", False))

    def prefetch(self, numbers: Sequence[int]) -> None:
        """Let the decoder get slices ready together, where it can: each will be asked for once, and soon.

        What becomes of those that cannot be decoded is told when they are asked for.
        """
        prefetch(self.decode, numbers)

    def placed(self, index: int, points: FloatArray) -> FloatArray:
        """Return points of slice `index` where they lie in the stack's plane coordinates.

        Parameters
        ----------
        index : int
            Slice number, from 0.
        points : array (n, 2)
            x = column·column spacing, y = row·row spacing, mm.
        """
        turned = points if self.turns is None else points @ turn_matrix(float(self.turns[index])).T
        return turned if self.origins is None else turned + self.origins[index]


def turn_matrix(angle: float) -> FloatArray:
    """Return the (2, 2) matrix that turns (x, y) by `angle`, rad, from x to y.

    Examples
    --------
    >>> (turn_matrix(np.pi / 2) @ [1.0, 0.0]).round(9).tolist()
    [0.0, 1.0]
    """
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def check_slice_stack(stack: SliceStack) -> None:
    """Raise InputError when the stack's arrays disagree or its geometry is impossible."""
    m = len(stack.names)
    if stack.positions.shape != (m,) or stack.pixel_spacing.shape != (m, 2):
        raise InputError(
            "positions or pixel spacing do not fit the slices",
            found=f"{stack.positions.shape}, {stack.pixel_spacing.shape}",
            expected=f"({m},), ({m}, 2)",
        )
    if stack.origins is not None and (stack.origins.shape != (m, 2) or not np.isfinite(stack.origins).all()):
        raise InputError(
            "origins do not fit the slices", found=str(stack.origins.shape), expected=f"({m}, 2)"
        )
    if stack.turns is not None and (stack.turns.shape != (m,) or not np.isfinite(stack.turns).all()):
        raise InputError("turns do not fit the slices", found=str(stack.turns.shape), expected=f"({m},)")
    if stack.marks is not None and (stack.marks.ndim != 3 or stack.marks.shape[::2] != (m, 2)):
        raise InputError("marks do not fit the slices", found=str(stack.marks.shape), expected=f"({m}, k, 2)")
    if stack.scale_uncertainty is not None and stack.scale_uncertainty.each.shape != (m,):
        raise InputError("the scale's uncertainty does not fit the slices", expected=f"({m},) values")
    if not (np.isfinite(stack.positions).all() and (np.diff(stack.positions) > 0).all()):
        raise InputError("slice positions must be finite and strictly increasing")
    if not (np.isfinite(stack.pixel_spacing).all() and (stack.pixel_spacing > 0).all()):
        raise InputError("pixel spacing must be positive", found=str(stack.pixel_spacing.min()))


def prefetch(decode: Callable[[int], Picture], numbers: Sequence[int]) -> None:
    """Let a decoder get slices ready together, where it can (`SliceStack.prefetch`)."""
    own: Callable[[Sequence[int]], None] | None = getattr(decode, "prefetch", None)
    if own is not None:
        own(numbers)
