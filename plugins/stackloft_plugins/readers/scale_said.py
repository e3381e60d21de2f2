"""What is said about the scale of photographs: flags first, then ``stack.toml``."""

from __future__ import annotations

from dataclasses import dataclass, replace

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.errors import InputError, UsageError
from stackloft.model.lengths import parse_length, parse_lengths
from stackloft.model.reference import Reference


@dataclass(frozen=True, slots=True)
class ScaleFlags:
    """What the reader's options say; None or False where they are silent."""

    pixel_size: float | str | None = None
    pixel_sizes: tuple[float, ...] | str | None = None
    dpi: bool = False
    reference: str | None = None
    reference_height: float | str | None = None
    reference_stays: bool = False
    camera_distance: float | str | None = None
    plane: str | None = None
    scale_uncertainty: float | None = None


@dataclass(frozen=True, slots=True)
class ScaleSaid:
    """Everything said about the scale, in mm."""

    pixel_size: float | None = None
    pixel_sizes: tuple[float, ...] | None = None
    dpi: bool = False
    reference: Reference | None = None
    height: float = 0.0
    """Of the reference object above the cut face, mm."""
    stays: bool = False
    """True: that far above the first face, wherever the others are."""
    distance: float | None = None
    """From the lens to the first face."""
    plane: str | None = None
    """``fixed``, ``receding`` or None: not said"""
    principal: tuple[float, float] | None = None
    """(column, row)"""
    uncertainty: float | None = None
    """Relative standard uncertainty."""
    source: str = NAME
    """Who said the pixel size or the reference object."""

    @property
    def explicit(self) -> bool:
        """Whether the pixel size is told rather than measured."""
        return self.pixel_size is not None or self.pixel_sizes is not None or self.dpi


def scale_said(flags: ScaleFlags, said: StackFile) -> ScaleSaid:
    """Return what flags and file say; a flag that gives a scale outdoes every scale of the file.

    Raises
    ------
    UsageError, InputError
        Two explicit scales, a height or place of a reference object that nobody named, a wrong length.

    Examples
    --------
    >>> scale_said(ScaleFlags(pixel_size="0.03cm"), StackFile()).pixel_size
    0.3
    """
    told = _of_flags(flags)
    if not (told.explicit or told.reference):
        told = replace(
            told,
            pixel_size=said.pixel_size,
            pixel_sizes=said.pixel_sizes,
            dpi=said.dpi,
            source=NAME,
        )
    if told.reference is None:
        told = replace(told, reference=said.reference)
    _check_one(told)
    if told.reference is None and (flags.reference_height is not None or said.reference_height is not None):
        raise InputError("tells where a reference object lies, but not which it is", where="reference_height",
                         fix='give --reference disc:24.25mm')  # fmt: skip
    given = flags.reference_height is not None
    return replace(
        told,
        height=told.height if given else said.reference_height or 0.0,
        stays=flags.reference_stays or said.reference_stays,
        distance=told.distance or said.camera.distance,
        plane=told.plane or said.camera.plane,
        principal=said.camera.principal_point,
        uncertainty=told.uncertainty if told.uncertainty is not None else _relative(said.scale_uncertainty),
    )


def _of_flags(flags: ScaleFlags) -> ScaleSaid:
    sizes = flags.pixel_sizes
    if isinstance(sizes, str):
        sizes = parse_lengths(sizes, "--set reader.pixel_sizes")
    if sizes is not None and min(sizes, default=0.0) <= 0:
        raise UsageError(
            "must be positive", where="--set reader.pixel_sizes", found=f"{min(sizes, default=0):g}"
        )
    height = 0.0
    if flags.reference_height is not None:
        height = parse_length(flags.reference_height, "--set reader.reference_height")
    source = "--pixel-size" if flags.pixel_size is not None else "--reference" if flags.reference else "--set"
    return ScaleSaid(
        pixel_size=_positive(flags.pixel_size, "--pixel-size"),
        pixel_sizes=sizes,
        dpi=flags.dpi,
        reference=Reference.parse(flags.reference) if flags.reference else None,
        height=height,
        distance=_positive(flags.camera_distance, "--set reader.camera_distance"),
        plane=flags.plane,
        uncertainty=_relative(flags.scale_uncertainty),
        source=source,
    )


def _check_one(told: ScaleSaid) -> None:
    named = {"pixel_size": told.pixel_size, "pixel_sizes": told.pixel_sizes, "dpi": told.dpi or None}
    given = [name for name, value in named.items() if value is not None]
    if len(given) > 1:
        raise InputError("contradict each other; keep one", where=told.source, found=" and ".join(given))


def _positive(value: float | str | None, flag: str) -> float | None:
    if value is None:
        return None
    length = parse_length(value, flag)
    if length <= 0:
        raise UsageError("must be positive", where=flag, found=str(value), expected="for example 5.6mm")
    return length


def _relative(percent: float | None) -> float | None:
    return None if percent is None else percent / 100
