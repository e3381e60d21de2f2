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
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import StackFile, load_stack_file
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft_plugins.readers.chosen_slices import (
    between,
    check_count,
    check_kind,
    masks,
    paired,
    sample,
)
from stackloft_plugins.readers.picture_decode import read_header
from stackloft_plugins.readers.picture_folder import check_sizes, list_pictures, split_source
from stackloft_plugins.readers.picture_kinds import READABLE, picture_kind
from stackloft_plugins.readers.picture_scale import Bench
from stackloft_plugins.readers.scale_choice import ScaledSlices, profiles, require_scale, scale_of
from stackloft_plugins.readers.scale_said import ScaleFlags, scale_said
from stackloft_plugins.readers.section_spacing import SpacingOptions, first_position, positions_of
from stackloft_plugins.readers.skipped_slices import without_skipped
from stackloft_plugins.readers.slice_decoder import SliceDecoder
from stackloft_plugins.readers.slice_faces import placed_when_turned, turned_over, without_doubles
from stackloft_plugins.readers.slice_thickness import height_notice, own_thickness
from stackloft_plugins.readers.what_is_shown import (
    FACES,
    FIRST,
    SECTIONS,
    TURNED,
    Shown,
    check_silhouettes,
    ends_with_cap,
    fiducials_said,
    hints_of,
    what_is_shown,
    without_cap,
)

if TYPE_CHECKING:
    from stackloft_plugins.readers.fiducials import Marks

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
    section: str | None = option(
        None, "face: pictures show cut faces alone; silhouette: side walls as well", choices=SECTIONS
    )
    first_shows: str | None = option(
        None, "cap: the folder's first picture shows the body's outer end, not a cut", choices=FIRST
    )
    faces: str | None = option(
        None, "both: two pictures for each slice, its upper face and its lower one", choices=FACES
    )
    turned: str | None = option(None, "how slices were turned over for their lower faces", choices=TURNED)
    fiducials: str | None = option(
        None, "marks beside the body that moved with each slice: disc:DIAMETER, two at least"
    )
    first: str = option("", "file name of the first slice to use; the folder's first when empty")
    last: str = option("", "file name of the last slice to use; the folder's last when empty")

    def probe(self, path: Path) -> float:
        """Return 0.8 for a folder (or pattern) with at least one picture, 0 otherwise."""
        folder, pattern = split_source(path)
        try:
            files = folder.glob(pattern) if folder.is_dir() else ()
            found = any(picture_kind(item) in READABLE for item in sample(files))
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
        check_kind(said, folder)
        shown = what_is_shown(self.section, self.first_shows, self.faces, self.turned, said)
        every, matched = list_pictures(path, masks(said))
        every, matched = paired(every, matched, shown)
        numbers = between(every, matched, self.first, self.last)
        scale_told = scale_said(self._scale, said)
        require_scale(scale_told, path)
        check_silhouettes(shown, scale_told.plane)
        positions, position_source = positions_of(self._spacing, said, numbers, len(every), path, shown)
        names = [picture.name for picture in every]
        used, notices = without_doubles(numbers, positions, names, shown)
        used, more = without_cap(used, shown, names)
        kept, skipped = without_skipped(used, said, every)
        notices = (*notices, *more, *skipped)
        headers = tuple(read_header(every[number]) for number in kept)
        check_count(headers, path)
        check_sizes(headers)
        places = dict(zip(numbers, positions, strict=True))
        folder_first = first_position(self._spacing, said, numbers, path, shown)
        z = frozen_floats([places[number] for number in kept])
        slices = ScaledSlices(headers, kept, len(every), Bench(z - folder_first, scale_told))
        paper = 0 if said.background == "dark" else 255
        scale, found = scale_of(slices, said, paper)
        over = tuple(turned_over(number, shown) for number in kept)
        decode = SliceDecoder(headers, tuple(() if one is None else (one,) for one in found), paper, over)
        marks = self._marks(said, decode, tuple(header.path.name for header in headers), scale.spacing)
        thickness = own_thickness(self._spacing, said, shown, places, folder, kept)
        beyond = z[0] - folder_first if thickness is None else thickness[0]
        return SliceStack(
            decode=decode if marks is None else decode.hiding(marks.found),
            names=tuple(header.path.name for header in headers),
            shape=headers[0].size,
            positions=z,
            pixel_spacing=scale.spacing,
            kind=shown.section,
            thickness=thickness,
            origins=placed_when_turned(
                scale.spacing, scale.origins, headers[0].size, scale_told.principal, over
            ),
            marks=None if marks is None else marks.places,
            scale_uncertainty=scale.uncertainty,
            hints=replace(hints_of(said, folder, kept, over), ends=ends_with_cap(said.ends, shown, beyond)),
            notices=(
                *notices,
                *self._height_checked(said, numbers, len(every), folder, shown),
                *scale.notices,
                *(() if marks is None else marks.notices),
            ),
            provenance={"pixel size": scale.source, "positions": position_source, **profiles(headers)},
        )

    def _height_checked(
        self, said: StackFile, numbers: tuple[int, ...], total: int, folder: Path, shown: Shown
    ) -> tuple[Notice, ...]:
        """Return a notice when the height is not the slices' sum; a part of a stack is not checked."""
        return height_notice(self._spacing, said, total, folder, shown) if len(numbers) == total else ()

    def _marks(
        self, said: StackFile, decode: Callable[[int], Picture], names: tuple[str, ...], spacing: FloatArray
    ) -> Marks | None:
        """Return the fiducial marks; None when nobody speaks of any."""
        mark = said.fiducials if self.fiducials is None else fiducials_said(self.fiducials)
        if mark is None:
            return None
        from stackloft_plugins.readers.fiducials import marks_of  # noqa: PLC0415 - needs OpenCV

        return marks_of(decode, names, spacing, mark)

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
