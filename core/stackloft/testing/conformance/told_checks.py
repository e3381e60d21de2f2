"""Checks of readers against a volume of which everything is known (`ToldVolume`)."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import StackloftError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.testing.conformance.check import NotHeldError, must, must_refuse
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.told_volume import ToldVolume, told

ODD_ORIGIN = np.array([-71.3, 12.9, 431.7])
ODD_AXES = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])


def spacing(case: ReaderCase) -> None:
    """Check that rows, columns and slices are as far apart as the file says, which is not the same."""
    _must_tell(case, told(), "at odd spacings")


def origin(case: ReaderCase) -> None:
    """Check that a volume far from the origin stays there."""
    _must_tell(case, told(origin=ODD_ORIGIN), "far from the origin")


def direction(case: ReaderCase) -> None:
    """Check that a volume whose axes are turned against the bench's is turned."""
    _must_tell(case, told(origin=ODD_ORIGIN, axes=ODD_AXES), "with turned axes")


def tilt(case: ReaderCase) -> None:
    """Check that slices that are shifted against each other (gantry tilt) come sheared."""
    _must_tell(case, told(axes=ODD_AXES, shear=0.31), "with a tilted gantry")


def dtype(case: ReaderCase) -> None:
    """Check that grey levels of every kind come out as they are: signs, the highest values, fractions."""
    held = [_held(case, kind) for kind in ("|u1", "<i2", "<u2", "<f4")]
    if not any(held):
        raise NotHeldError("grey levels of the kinds u1, i2, u2, f4")


def endianness(case: ReaderCase) -> None:
    """Check that big-endian files give the same grey levels."""
    held = [_held(case, kind) for kind in (">i2", ">u2", ">f4")]
    if not any(held):
        raise NotHeldError("big-endian grey levels")


def strides(case: ReaderCase) -> None:
    """Check that a file whose first axis runs fastest gives the same pictures."""
    _must_tell(case, told(fortran=True), "stored column by column")


def gap(case: ReaderCase) -> None:
    """Check that a missing slice is refused, or the others keep their places: never evened out."""
    volume = told(positions=1.7 * np.array([0.0, 1.0, 2.0, 4.0, 5.0]))
    with tempfile.TemporaryDirectory() as folder:
        source = _written(case, volume, folder)
        try:
            product = _reader(case).read(source)
        except StackloftError:
            return
        stack = _stack(product)
        found = stack.positions - stack.positions[0]
        kept = found.shape == volume.positions.shape and np.allclose(found, volume.positions, atol=1e-6)
        must(kept, f"a gap between slices is not refused, and positions are {found.round(3).tolist()} mm")


def duplicate(case: ReaderCase) -> None:
    """Check that two slices at one place are refused."""
    volume = told(positions=1.7 * np.array([0.0, 1.0, 1.0, 2.0, 3.0]))
    with tempfile.TemporaryDirectory() as folder:
        source = _written(case, volume, folder)
        must_refuse(lambda: _drained(_reader(case).read(source)), "a volume with two slices at one place")


def _held(case: ReaderCase, kind: str) -> bool:
    try:
        _must_tell(case, told(kind), f"of {kind}")
    except NotHeldError:
        return False
    return True


def _written(case: ReaderCase, volume: ToldVolume, folder: str) -> Path:
    if case.write_told is None:
        raise NotHeldError("volumes that the kit makes up")
    try:
        return case.write_told(Path(folder), volume)
    except NotImplementedError as error:
        raise NotHeldError(str(error)) from None


def _reader(case: ReaderCase) -> Any:
    """Return the reader without options that would tell the spacing instead of the file."""
    return case.make(**dict.fromkeys(case.spacing_options))


def _drained(product: Any) -> None:
    stack = _stack(product)
    for k in range(len(stack)):
        stack.decode(k)


def _stack(product: Any) -> SliceStack:
    stack = product.stack if isinstance(product, Segmentation) else product
    must(isinstance(stack, SliceStack), f"{type(stack).__name__} is read, which has no slices")
    found: SliceStack = stack
    return found


def _must_tell(case: ReaderCase, volume: ToldVolume, how: str) -> None:
    """Hold every picture's corner pixels, in the world, and their values against the truth."""
    with tempfile.TemporaryDirectory() as folder:
        stack = _stack(_reader(case).read(_written(case, volume, folder)))
        must(len(stack) == len(volume.pictures), f"{len(stack)} of {len(volume.pictures)} slices are read")
        pictures = [stack.decode(k) for k in range(len(stack))]
    seen = set()
    for k, picture in enumerate(pictures):
        must(picture.dtype.isnative, f"pictures {how} come in foreign byte order ({picture.dtype.str})")
        seen.add(_must_lie(stack, volume, k, picture, how))
    must(len(seen) == len(pictures), f"of a volume {how}, some slices are read twice")


def _must_lie(stack: SliceStack, volume: ToldVolume, k: int, picture: Any, how: str) -> int:
    """Return which slice of the volume slice `k` is."""
    inverse = np.linalg.inv(volume.affine())
    rows, columns = picture.shape[:2]
    at = [(r, c) for r in (0, rows // 3, rows - 1) for c in (0, columns // 4, columns - 1)]
    where = np.array([_world(stack, k, r, c) for r, c in at])
    column, row, z = (where @ inverse[:3, :3].T + inverse[:3, 3]).T
    number = np.abs(volume.positions - z[0]).argmin()
    off = np.abs(z - volume.positions[number]).max()
    must(off < 1e-3, f"slice {k + 1} of a volume {how} lies {off:.3g} mm off along the normal")
    nearest = np.column_stack([np.round(row), np.round(column)]).astype(int)
    off = float(np.abs(np.column_stack([row, column]) - nearest).max())
    must(off < 1e-3, f"pixels of a volume {how} lie {off:.3g} pixels beside where they are")
    shape = volume.pictures.shape[1:]
    within = (nearest >= 0).all() and (nearest < shape).all()
    must(within, f"pixels of a volume {how} come to lie outside of it")
    expected = volume.pictures[number][tuple(nearest.T)].astype(np.float64)
    found = np.array([picture[r, c] for r, c in at], dtype=np.float64)
    same = np.allclose(found, expected, rtol=1e-6, atol=1e-6)
    must(same, f"pixels of a volume {how} read {found[:3].tolist()}, written were {expected[:3].tolist()}")
    return int(number)


def _world(stack: SliceStack, k: int, row: int, column: int) -> FloatArray:
    x, y = (0.0, 0.0) if stack.origins is None else stack.origins[k]
    down, along = stack.pixel_spacing[k]
    point = np.array([x + column * along, y + row * down, stack.positions[k], 1.0])
    world: FloatArray = (stack.affine @ point)[:3]
    return world


CHECKS = {
    "told-spacing": spacing,
    "told-origin": origin,
    "told-direction": direction,
    "told-tilt": tilt,
    "told-dtype": dtype,
    "told-endianness": endianness,
    "told-strides": strides,
    "told-gap": gap,
    "told-duplicate": duplicate,
}
