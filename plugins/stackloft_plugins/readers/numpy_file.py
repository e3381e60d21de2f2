"""NumPy arrays in ``.npy`` and ``.npz`` files: (slice, row, column) grey levels or labels."""

from __future__ import annotations

import threading
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.array_axis import AXES, MEMORY
from stackloft.sectioning.object_choice import LARGEST
from stackloft_plugins.readers.block_spacing import FileSpacing, block_spacing
from stackloft_plugins.readers.label_map import CHOICES, as_labels
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.section_spacing import SpacingOptions
from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack

_NPY, _ZIP = b"\x93NUMPY", b"PK\x03\x04"
_CONFIDENCE = 0.9
SPACING = "spacing"
"""Name of an array in an ``.npz`` file that holds (slice, row, column) spacing, mm."""


@dataclass(frozen=True, slots=True)
class NumpyReader:
    """Reads a three-dimensional array into a `SliceStack`, or a `Segmentation` where it is a label map.

    An ``.npy`` file is read slice by slice. The spacing comes from flags, ``stack.toml``, or an array
    ``spacing`` of three numbers in an ``.npz`` file.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "volume.npy"
    >>> np.save(path, np.arange(60.0).reshape(3, 4, 5))
    >>> stack = NumpyReader(pixel_size="0.5mm", thickness="2mm").read(path)
    >>> stack.positions, stack.decode(1)[0]
    (array([0., 2., 4.]), array([20., 21., 22., 23., 24.]))
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack, Segmentation)

    pixel_size: float | str | None = option(None, "length of one pixel", unit="mm", gt=0)
    thickness: float | str | None = option(None, "distance from slice to slice", unit="mm", gt=0)
    positions: tuple[float, ...] | str | None = option(
        None, "position of every slice along the axis", unit="mm"
    )
    array: str = option("", "name of the array in an .npz file; the only volume in it when empty")
    labels: str = option("auto", "whether the values are labels of bodies", choices=CHOICES)
    object: str = option(LARGEST, "label maps: which body, largest or its label")
    axis: str = option("0", "label maps: the array's axis that sections are taken across", choices=AXES)
    memory: float = option(MEMORY, "what another axis than 0 may take for the whole map", unit="MB", gt=0)
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.9 for a file that begins as NumPy's, 0 otherwise."""
        try:
            return _CONFIDENCE if path.is_file() and _begins(path) else 0.0
        except OSError:
            return 0.0

    def read(self, path: Path) -> SliceStack | Segmentation:
        """Return the stack, or the segmentation of a label map.

        Raises
        ------
        InputError
            Damaged, no volume of real numbers, or without a spacing.
        """
        if not path.is_file() or not _begins(path):
            raise InputError(
                "is no NumPy file" if path.exists() else "does not exist",
                where=str(path),
                expected=".npy, .npz",
            )
        volume = _Volume(path, self.array)
        flags = SpacingOptions(self.pixel_size, self.thickness, self.positions)
        spacing = block_spacing(flags, volume.said(), volume.shape[0], path)
        grid = VoxelGrid(volume.shape, spacing.pixel, spacing.positions)
        stack = volume_stack(grid, volume, path, spacing.provenance)
        known = with_scale(stack, self.scale_uncertainty, path)
        return as_labels(known, self.labels, self.object, self.axis, self.memory)


class _Volume:
    """An array's slices: of an ``.npy`` file read one by one, of an ``.npz`` file all at the first call."""

    def __init__(self, path: Path, name: str) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._array: Any = None
        self._packed = _is_packed(path)
        self._key = ""
        shapes = self._shapes()
        if self._packed:
            self._key = _chosen(shapes, name, path)
        shape, dtype = shapes[self._key]
        if len(shape) != 3 or dtype.kind not in "buif" or 0 in shape:
            raise InputError(
                "is no volume of real numbers",
                where=str(path),
                found=f"{dtype} {shape}",
                expected="an array (slice, row, column)",
            )
        self.shape: tuple[int, int, int] = (shape[0], shape[1], shape[2])
        self._spaced = SPACING in shapes

    def said(self) -> FileSpacing:
        """Return the spacing that the file holds."""
        if not self._spaced:
            return FileSpacing()
        sides = np.asarray(self._loaded(SPACING), dtype=np.float64).ravel()
        if sides.shape != (3,):
            raise InputError(f"array {SPACING!r} is no three numbers", where=str(self._path))
        pitch, row, column = (float(side) for side in sides)
        return FileSpacing((row, column), pitch, f"array {SPACING!r}")

    def __call__(self, number: int) -> Picture:
        """Return a copy of one slice; safe to call from several threads."""
        with self._lock:
            if self._array is None:
                self._array = self._loaded(self._key)
        if isinstance(self._array, np.memmap) and self._array.flags.c_contiguous:
            return self._read(self._array, number)
        return read_only(np.array(self._array[number]))

    def _read(self, array: np.memmap[Any, Any], number: int) -> Picture:
        """Return a slice of a plain array, read: what is mapped stays in memory longer than it is wanted."""
        count = array.shape[1] * array.shape[2]
        start = array.offset + number * count * array.itemsize
        try:
            values = np.fromfile(self._path, dtype=array.dtype, count=count, offset=start)
            return read_only(values.reshape(array.shape[1:]))
        except (OSError, ValueError) as error:  # gone, or cut short, since its head was read
            raise self._damaged(error) from error

    def _loaded(self, key: str) -> Any:
        """Return an array: a packed one in memory, a plain one mapped."""
        try:
            if not self._packed:
                return np.load(self._path, mmap_mode="r", allow_pickle=False)
            with np.load(self._path, allow_pickle=False) as content:
                return content[key]
        except Exception as error:  # a damaged file raises anything
            raise self._damaged(error) from error

    def _shapes(self) -> dict[str, tuple[tuple[int, ...], np.dtype[Any]]]:
        """Return shape and type of every array by name, from the headers; a plain one has no name."""
        try:
            if not self._packed:
                with self._path.open("rb") as stream:
                    return {"": _header(stream)}
            with zipfile.ZipFile(self._path) as archive:
                found = {}
                for item in archive.namelist():
                    with archive.open(item) as stream:
                        found[item.removesuffix(".npy")] = _header(stream)
                return found
        except Exception as error:  # a damaged file raises anything
            raise self._damaged(error) from error

    def _damaged(self, error: Exception) -> InputError:
        found = type(error).__name__
        return InputError("is damaged, or holds no plain array", where=str(self._path), found=found)


def _header(stream: Any) -> tuple[tuple[int, ...], np.dtype[Any]]:
    """Return shape and type from the head of an ``.npy`` stream."""
    version = np.lib.format.read_magic(stream)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(stream)
    return shape, dtype


def _chosen(shapes: Mapping[str, tuple[tuple[int, ...], Any]], name: str, path: Path) -> str:
    volumes = [key for key, (shape, _) in shapes.items() if len(shape) == 3]
    chosen = name or (volumes[0] if len(volumes) == 1 else "")
    if chosen not in shapes:
        raise InputError(
            f"holds no array {name!r}" if name else f"holds {len(volumes)} volumes",
            where=str(path),
            found=", ".join(shapes),
            fix="--set numpy.array=NAME",
        )
    return chosen


def _is_packed(path: Path) -> bool:
    with path.open("rb") as stream:
        return stream.read(4) == _ZIP


def _begins(path: Path) -> bool:
    with path.open("rb") as stream:
        head = stream.read(6)
    return head == _NPY or (head[:4] == _ZIP and path.suffix.lower() == ".npz")
