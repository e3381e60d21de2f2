"""A block's voxel spacing: flags first, then ``stack.toml``, then what the file says; never a guess."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import NAME, StackFile, load_stack_file
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft_plugins.readers.section_spacing import SpacingOptions, pixel_size_of, positions_of


@dataclass(frozen=True, slots=True)
class FileSpacing:
    """What a file says, mm; None where it is silent."""

    pixel: tuple[float, float] | None = None
    """(row, column)"""
    pitch: float | None = None
    source: str = ""
    """Who says so, for the provenance."""


@dataclass(frozen=True, slots=True, eq=False)
class BlockSpacing:
    """The spacing that is used."""

    pixel: tuple[float, float]
    """(row, column) mm"""
    positions: FloatArray
    """(slices) mm"""
    provenance: dict[str, str]


def block_spacing(flags: SpacingOptions, said: FileSpacing, slices: int, path: Path) -> BlockSpacing:
    """Return pixel size and positions of a block's slices.

    Parameters
    ----------
    flags : SpacingOptions
        ``pixel_size``, ``thickness`` (from one slice to the next) and ``positions``.
    said : FileSpacing
        What the file says.
    slices : int
    path : Path
        The file or folder.

    Raises
    ------
    InputError, UsageError
        Unknown spacing, or positions that do not fit.

    Examples
    --------
    >>> said = FileSpacing((0.2, 0.2), None, "ImageJ")
    >>> spacing = block_spacing(SpacingOptions(thickness="1mm"), said, 3, Path("a.tif"))
    >>> spacing.pixel, spacing.positions, spacing.provenance["pixel size"]
    ((0.2, 0.2), array([0., 1., 2.]), 'ImageJ')
    """
    toml = load_stack_file(path if path.is_dir() else path.parent)
    if flags.pixel_size is None and toml.pixel_size is None and said.pixel is not None:
        pixel, pixel_source = said.pixel, said.source
    else:
        size, pixel_source = pixel_size_of(flags, toml, path)
        pixel = (size, size)
    positions, source = _positions(flags, toml, said, slices, path)
    return BlockSpacing(pixel, positions, {"pixel size": pixel_source, "positions": source})


def _positions(
    flags: SpacingOptions, toml: StackFile, said: FileSpacing, slices: int, path: Path
) -> tuple[FloatArray, str]:
    given = (flags.thickness, flags.positions, toml.thickness, toml.positions)
    if any(value is not None for value in given):
        return positions_of(flags, toml, tuple(range(slices)), slices, path)
    if said.pitch is not None:
        return said.pitch * np.arange(slices, dtype=np.float64), said.source
    raise InputError(
        "distance between the slices is unknown",
        where=str(path),
        found="no z spacing in the file",
        fix=f'give --thickness 0.5mm, or thickness = "0.5mm" in {NAME}',
    )
