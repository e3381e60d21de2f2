"""The slices of a TIFF file: one page each, or one page with all of them one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.block_spacing import FileSpacing
from stackloft_plugins.readers.tiff_spacing import tiff_spacing

MOST_PIXELS = 1 << 27
"""Of one slice; more is taken for damage."""


@dataclass(frozen=True, slots=True)
class TiffPages:
    """A file's slices; calling it with a number decodes that slice alone."""

    path: Path
    offsets: tuple[int, ...]
    """Where each page's directory begins, or, for `raw`, each slice's pixels."""
    shape: tuple[int, ...]
    """(rows, columns) or (rows, columns, samples)"""
    dtype: np.dtype[Any]
    raw: bool
    """Pixels lie one slice after the other behind a single directory (ImageJ above 4 GB)."""
    spacing: FileSpacing

    def __call__(self, number: int) -> Picture:
        """Return slice `number`; safe to call from several threads."""
        return read_only(self._raw(number) if self.raw else self._page(number))

    def _raw(self, number: int) -> Picture:
        count = int(np.prod(self.shape))
        values = np.fromfile(self.path, dtype=self.dtype, count=count, offset=self.offsets[number])
        if values.size != count:
            raise _damaged(self.path, f"slice {number + 1} is cut off")
        return values.reshape(self.shape).astype(self.dtype.newbyteorder("="))

    def _page(self, number: int) -> Picture:
        from tifffile import TiffPage  # noqa: PLC0415 - slow to import, needed where TIFF is read

        with _opened(self.path) as tiff:
            tiff.filehandle.seek(self.offsets[number])
            picture = np.asarray(TiffPage(tiff, index=number).asarray())
        if picture.shape != self.shape:
            raise _damaged(self.path, f"slice {number + 1} is {picture.shape}, the first is {self.shape}")
        return picture


def tiff_pages(path: Path) -> TiffPages:
    """Return the slices of the file's first series; only directories are read.

    Raises
    ------
    InputError
        Damaged, empty, or with more axes than a volume.
    """
    with _opened(path) as tiff:
        if not tiff.series:
            raise _damaged(path, "no picture")
        series = tiff.series[0]
        page = series.keyframe
        shape = tuple(page.shape)
        if (
            len(shape) not in {2, 3}
            or int(np.prod(shape)) > MOST_PIXELS
            or (len(shape) == 3 and shape[2] > 4)
        ):
            raise InputError("holds no grey or colour slices", where=str(path), found=str(shape))
        slices = int(np.prod(series.shape)) // int(np.prod(shape))
        dtype, spacing = np.dtype(series.dtype).newbyteorder(tiff.byteorder), tiff_spacing(tiff)
        if len(series.pages) == slices:
            offsets = tuple(int(each.offset) for each in series.pages)
            return TiffPages(path, offsets, shape, dtype, False, spacing)
        if series.dataoffset is None:
            raise _damaged(path, f"{len(series.pages)} pages for {slices} slices")
        size = int(np.prod(shape)) * dtype.itemsize
        starts = tuple(int(series.dataoffset) + k * size for k in range(slices))
        return TiffPages(path, starts, shape, dtype, True, spacing)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a TIFF; whatever goes wrong inside is the file's damage."""
    from tifffile import TiffFile  # noqa: PLC0415 - slow to import, needed where TIFF is read

    try:
        with TiffFile(path) as tiff:
            yield tiff
    except InputError:
        raise
    except OSError as error:
        raise InputError("cannot be opened", where=str(path), found=error.strerror) from error
    except Exception as error:
        raise _damaged(path, f"{type(error).__name__}: {error}") from error


def _damaged(path: Path, found: str) -> InputError:
    return InputError(
        "is damaged or no TIFF", where=str(path), found=found, fix="copy it again from its source"
    )
