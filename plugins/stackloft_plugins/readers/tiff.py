"""TIFF volumes: one file of many pages, or a folder with one page per slice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.errors import InputError, StackloftError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft.sectioning.array_axis import AXES, MEMORY
from stackloft.sectioning.object_choice import LARGEST
from stackloft_plugins.readers.block_spacing import FileSpacing, block_spacing
from stackloft_plugins.readers.label_map import CHOICES, as_labels
from stackloft_plugins.readers.picture_kinds import natural_key
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.section_spacing import SpacingOptions
from stackloft_plugins.readers.tiff_pages import TiffPages, tiff_pages
from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack

_MAGIC = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_FILE, _SLABS, _PERHAPS = 0.9, 0.9, 0.3
"""Confidence: a file; a folder whose stack.toml says slabs; any other folder, which may be photographs."""


@dataclass(frozen=True, slots=True)
class TiffReader:
    """Reads a TIFF volume into a `SliceStack` of slabs, or a `Segmentation` where it is a label map.

    ImageJ's and OME's spacings are read; a flag or ``stack.toml`` wins. A folder of TIFF files is taken for
    photographs unless its ``stack.toml`` says ``kind = "slab"`` or ``--reader tiff`` is given.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> scanner = phantoms.Scans(form="tiff", sections=5, pixel_size=2.0)
    >>> path = scanner.write(phantoms.make("cone"), Path(tempfile.mkdtemp()))[0]
    >>> stack = TiffReader().read(path)
    >>> len(stack), stack.provenance["positions"]
    (7, 'ImageJ')
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack, Segmentation)

    pixel_size: float | str | None = option(None, "length of one pixel", unit="mm", gt=0)
    thickness: float | str | None = option(None, "distance from slice to slice", unit="mm", gt=0)
    positions: tuple[float, ...] | str | None = option(
        None, "position of every slice along the axis", unit="mm"
    )
    labels: str = option("auto", "whether the values are labels of bodies", choices=CHOICES)
    object: str = option(LARGEST, "label maps: which body, largest or its label")
    axis: str = option("0", "label maps: the array's axis that sections are taken across", choices=AXES)
    memory: float = option(MEMORY, "what another axis than 0 may take for the whole map", unit="MB", gt=0)
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.9 for a TIFF file, less for a folder of them, 0 for anything else."""
        try:
            if path.is_file():
                return _FILE if _is_tiff(path) else 0.0
            files = _tiffs(path)[:1]
            if not files or not _is_tiff(files[0]):
                return 0.0
            return _SLABS if load_stack_file(path).kind is SectionKind.SLAB else _PERHAPS
        except (OSError, StackloftError):
            return 0.0

    def read(self, path: Path) -> SliceStack | Segmentation:
        """Return the stack, or the segmentation of a label map; pixels are decoded when asked for.

        Raises
        ------
        InputError
            Damaged files, pages of different sizes, an unknown spacing.
        """
        slices = _slices(path)
        first = slices[0][0]
        said = (
            first.spacing if path.is_file() else FileSpacing(first.spacing.pixel, None, first.spacing.source)
        )
        flags = SpacingOptions(self.pixel_size, self.thickness, self.positions)
        spacing = block_spacing(flags, said, len(slices), path)
        shape = (len(slices), first.shape[0], first.shape[1])
        grid = VoxelGrid(shape, spacing.pixel, spacing.positions)
        names = [_name(pages, k) for pages, k in slices]
        stack = volume_stack(grid, _Decoder(slices), path, spacing.provenance, names=names)
        known = with_scale(stack, self.scale_uncertainty, path)
        return as_labels(known, self.labels, self.object, self.axis, self.memory)


class _Decoder:
    """Slice number to the page of its file."""

    def __init__(self, slices: Sequence[tuple[TiffPages, int]]) -> None:
        self._slices = tuple(slices)

    def __call__(self, number: int) -> Picture:
        pages, page = self._slices[number]
        return pages(page)


def _name(pages: TiffPages, page: int) -> str:
    return f"{pages.path.name}[{page + 1}]" if len(pages.offsets) > 1 else pages.path.name


def _slices(path: Path) -> list[tuple[TiffPages, int]]:
    """Return file and page of every slice, in natural order of the file names."""
    files = [path] if path.is_file() or not path.exists() else _tiffs(path)
    if not files:
        raise InputError("no TIFF file", where=str(path))
    every = [tiff_pages(file) for file in files]
    for pages in every:
        if pages.shape != every[0].shape:
            raise InputError(
                "slices have different sizes",
                where=str(pages.path),
                found=" × ".join(map(str, pages.shape)),
                expected=" × ".join(map(str, every[0].shape)),
            )
    return [(pages, k) for pages in every for k in range(len(pages.offsets))]


def _tiffs(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    files = [x for x in folder.iterdir() if x.suffix.lower() in {".tif", ".tiff"} and x.name[0] != "."]
    return sorted(files, key=lambda x: natural_key(x.name))


def _is_tiff(path: Path) -> bool:
    with path.open("rb") as stream:
        return stream.read(4) in _MAGIC
