"""Photographs of a body's cut faces, one file per slice.

::

    apple/                        z ->
      stack.toml                   0    t   2t   3t
      slice_1.jpg  face at 0       |    |    |    |
      slice_2.jpg  face at t       |####|####|####|      t: slice thickness
      slice_10.jpg face at 2t      |####|####|####|

Files are put in natural order (``slice_2`` before ``slice_10``). A photograph shows the face that a
cut laid bare; with a thickness t, face k lies at k·t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import NAME, StackFile, load_stack_file
from stackloft.model.arrays import frozen_floats
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft_plugins.readers.picture_decode import PictureHeader, decode_picture, read_header
from stackloft_plugins.readers.picture_folder import check_sizes, list_pictures, split_source
from stackloft_plugins.readers.picture_kinds import READABLE, SUFFIXES, natural_key, picture_kind
from stackloft_plugins.readers.picture_scale import Bench
from stackloft_plugins.readers.reference_sighting import Found
from stackloft_plugins.readers.scale_choice import ScaledSlices, profiles, require_scale, scale_of
from stackloft_plugins.readers.scale_said import ScaleFlags, scale_said
from stackloft_plugins.readers.section_spacing import (
    SpacingOptions,
    first_position,
    height_notice,
    positions_of,
)
from stackloft_plugins.readers.skipped_slices import without_skipped

MIN_SLICES = 2
"""Fewer sections bound no body."""

_PROBED = 8  # files opened to tell whether a folder holds pictures
_CONFIDENCE = 0.8


@dataclass(frozen=True, slots=True)
class PhotosReader:
    """Reads a folder of photographs into a `SliceStack` of faces.

    Examples
    --------
    >>> import tempfile
    >>> from PIL import Image
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for number in (1, 2, 10):
    ...         Image.new("L", (40, 30), 255).save(Path(folder) / f"slice_{number}.png")
    ...     stack = PhotosReader(pixel_size="0.3mm", thickness=5).read(Path(folder))
    ...     stack.names, stack.positions, stack.decode(0).shape
    (('slice_1.png', 'slice_2.png', 'slice_10.png'), array([ 0.,  5., 10.]), (30, 40))
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)

    pixel_size: float | str | None = option(None, "length of one pixel on the cut face", unit="mm", gt=0)
    thickness: float | str | None = option(None, "thickness of one slice: faces lie at k·t", unit="mm", gt=0)
    positions: tuple[float, ...] | str | None = option(
        None, "position of every face along the axis, in the order of the file names", unit="mm"
    )
    pixel_sizes: tuple[float, ...] | str | None = option(
        None, "pixel size of every picture, in the order of the file names", unit="mm"
    )
    dpi: bool = option(False, "take the pixel size from the files' resolution tags, as of a flatbed scan")
    reference: str | None = option(
        None, "an object of known size in a corner: disc:DIAMETER, square:SIDE or ruler:LENGTH"
    )
    reference_height: float | str | None = option(
        None, "the reference object above the cut face; negative below it", unit="mm"
    )
    reference_stays: bool = option(False, "it is that far above the first face, and stays there")
    camera_distance: float | str | None = option(
        None, "from the lens to the first picture's cut face", unit="mm", gt=0
    )
    plane: str | None = option(
        None,
        "fixed: all cut faces are as far from the lens; receding: slices are taken off the top",
        choices=("fixed", "receding"),
    )
    scale_uncertainty: float | None = option(
        None, "standard uncertainty of the pixel size", unit="%", ge=0, lt=100
    )
    kerf: float | str | None = option(
        None,
        "what the blade takes away between two slices: faces lie at k·(thickness + kerf)",
        unit="mm",
        ge=0,
    )
    first: str = option("", "file name of the first slice to use; the folder's first when empty")
    last: str = option("", "file name of the last slice to use; the folder's last when empty")

    def probe(self, path: Path) -> float:
        """Return 0.8 for a folder (or pattern) with at least one picture, 0 otherwise."""
        folder, pattern = split_source(path)
        try:
            files = sorted(item for item in folder.glob(pattern) if item.is_file()) if folder.is_dir() else []
            found = any(picture_kind(item) in READABLE for item in _sample(files))
        except (OSError, ValueError):
            return 0.0
        return _CONFIDENCE if found else 0.0

    def read(self, path: Path) -> SliceStack:
        """Return the stack; headers are read here, pixels when a slice is asked for.

        Parameters
        ----------
        path : Path
            A folder, or a folder and a pattern of file names (``apple/slice_*.jpg``).

        Raises
        ------
        InputError
            No or one picture, damaged or unreadable pictures, different sizes, unknown spacing.
        """
        folder, _ = split_source(path)
        said = load_stack_file(folder)
        _check_kind(said, folder)
        every, matched = list_pictures(path, _masks(said))
        numbers = self._chosen(every, matched)
        scale_told = scale_said(self._scale, said)
        require_scale(scale_told, path)
        positions, position_source = positions_of(self._spacing, said, numbers, len(every), path)
        kept, notices = without_skipped(numbers, said, every)
        headers = tuple(read_header(every[number]) for number in kept)
        _check_count(headers, path)
        check_sizes(headers)
        places = dict(zip(numbers, positions, strict=True))
        folder_first = first_position(self._spacing, said, numbers, path)
        z = frozen_floats([places[number] for number in kept])
        slices = ScaledSlices(headers, kept, len(every), Bench(z - folder_first, scale_told))
        paper = 0 if said.background == "dark" else 255
        scale, found = scale_of(slices, said, paper)
        return SliceStack(
            decode=_decoder(headers, found, paper),
            names=tuple(header.path.name for header in headers),
            shape=headers[0].size,
            positions=z,
            pixel_spacing=scale.spacing,
            kind=said.kind or SectionKind.FACE,
            origins=scale.origins,
            scale_uncertainty=scale.uncertainty,
            hints=said.hints(folder, {number + 1: slot for slot, number in enumerate(kept, start=1)}),
            notices=(*notices, *self._height_checked(said, numbers, len(every), folder), *scale.notices),
            provenance={"pixel size": scale.source, "positions": position_source, **profiles(headers)},
        )

    def _height_checked(
        self, said: StackFile, numbers: tuple[int, ...], total: int, folder: Path
    ) -> tuple[Notice, ...]:
        """Return a notice when the height is not the slices' sum; a part of a stack is not checked."""
        return height_notice(self._spacing, said, total, folder) if len(numbers) == total else ()

    @property
    def _spacing(self) -> SpacingOptions:
        return SpacingOptions(thickness=self.thickness, positions=self.positions, kerf=self.kerf)

    @property
    def _scale(self) -> ScaleFlags:
        return ScaleFlags(
            self.pixel_size,
            self.pixel_sizes,
            self.dpi,
            self.reference,
            self.reference_height,
            self.reference_stays,
            self.camera_distance,
            self.plane,
            self.scale_uncertainty,
        )

    def _chosen(self, every: tuple[Path, ...], matched: tuple[int, ...]) -> tuple[int, ...]:
        """Return the numbers, from 0, of the slices between `first` and `last`."""
        names = [path.name for path in every]
        for flag, name in (("first", self.first), ("last", self.last)):
            if name and name not in names:
                raise UsageError(
                    "no such slice", where=f"reader.{flag}", found=name, expected=f"{names[0]} … {names[-1]}"
                )
        start = names.index(self.first) if self.first else 0
        stop = names.index(self.last) if self.last else len(names) - 1
        if stop < start:
            raise UsageError(
                "last comes before first", where="reader.last", found=f"{self.first}, {self.last}"
            )
        return tuple(number for number in matched if start <= number <= stop)


def _sample(files: list[Path]) -> list[Path]:
    """Return the few files worth opening: those that promise a picture first."""
    return sorted(files, key=lambda path: (path.suffix.lower() not in SUFFIXES, natural_key(path.name)))[
        :_PROBED
    ]


def _masks(said: StackFile) -> frozenset[str]:
    return frozenset(override.mask for override in said.slice.values() if override.mask is not None)


def _check_kind(said: StackFile, folder: Path) -> None:
    if said.kind is SectionKind.SLAB:
        raise InputError(
            "photographs do not show slabs",
            where=str(folder / NAME),
            found='kind = "slab"',
            expected='kind = "face" or "silhouette"',
        )


def _check_count(headers: tuple[PictureHeader, ...], path: Path) -> None:
    if len(headers) < MIN_SLICES:
        raise InputError(
            "one slice makes no body" if headers else "every slice is skipped",
            where=str(path),
            found=headers[0].path.name if headers else "none",
            expected="at least 2 pictures, better 7 or more",
        )


def _decoder(
    headers: tuple[PictureHeader, ...], found: tuple[Found | None, ...], paper: int
) -> Callable[[int], Picture]:
    if any(found):
        from stackloft_plugins.readers.reference_find import hide  # noqa: PLC0415 - needs OpenCV

    def decode(number: int) -> Picture:
        picture = decode_picture(headers[number], paper)
        reference = found[number]
        return picture if reference is None else hide(picture, reference)

    return decode
