r"""What ``visu_pars`` says of a ``2dseq``: which frame lies where, and what its numbers mean.

::

    VisuFGOrderDesc  (2, <FG_ECHO>, …) (12, <FG_SLICE>, …)      the first group runs fastest in the file:
    frame            echo 1 of slice 1, echo 2 of slice 1, echo 1 of slice 2, …

    VisuCorePosition (3 numbers) and VisuCoreOrientation (9: the directions of columns, rows and normal) are
    given for every frame, for every slice, or once.

Positions are those of the first voxel, in the subject's millimetres, as DICOM's Image Position (Patient).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.errors import InputError
from stackloft_plugins.readers.jcamp import Parameters

TYPES = {
    "_8BIT_UNSGN_INT": "u1",
    "_16BIT_SGN_INT": "i2",
    "_32BIT_SGN_INT": "i4",
    "_32BIT_FLOAT": "f4",
}
"""VisuCoreWordType to NumPy's type without byte order."""
_ORDERS = {"littleEndian": "<", "bigEndian": ">"}
_SLICES = "FG_SLICE"
_MOST_FRAMES = 1 << 17
_MOST_SIDE = 1 << 15
_UNIT = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class VisuFrames:
    """A ``2dseq`` as its ``visu_pars`` describes it."""

    dtype: np.dtype[np.generic]
    shape: tuple[int, ...]
    """(rows, columns) of a frame, or (slices, rows, columns) of a three-dimensional one"""
    spacing: tuple[float, ...]
    """mm, as `shape`"""
    groups: tuple[tuple[str, int], ...]
    """(name, length) of the frame groups, the fastest first; never empty"""
    positions: FloatArray
    """(frames, 3) mm: the first voxel's centre"""
    axes: FloatArray
    """(frames, 3, 3) rows: directions of increasing column, of increasing row, and normal"""
    slope: FloatArray
    """(frames)"""
    offset: FloatArray
    """(frames)"""
    thickness: float | None
    """mm, of two-dimensional frames"""
    backwards: bool
    """Whether slices are stored in reverse."""

    @property
    def count(self) -> int:
        """How many frames there are."""
        return len(self.positions)

    def grid(self) -> tuple[IntArray, IntArray]:
        """Return each frame's slice number and its number among the frames of one slice (echo, time, …)."""
        sizes = [length for _, length in self.groups]
        places = np.array(np.unravel_index(np.arange(self.count), sizes[::-1]))[::-1]
        slices = next((k for k, (name, _) in enumerate(self.groups) if name == _SLICES), None)
        if slices is None:
            return np.zeros(self.count, dtype=np.int64), np.arange(self.count)
        others = [k for k in range(len(sizes)) if k != slices]
        repeat = np.zeros(self.count, dtype=np.int64)
        for k in reversed(others):
            repeat = repeat * sizes[k] + places[k]
        return places[slices].astype(np.int64), repeat


def visu_frames(visu: Parameters) -> VisuFrames:
    """Return the description of the frames.

    Raises
    ------
    InputError
        A parameter is missing or impossible; it is named.
    """
    dimension, count = visu.whole("VisuCoreDim"), visu.whole("VisuCoreFrameCount")
    _check(visu, "VisuCoreDim", 2 <= dimension <= 3, f"{dimension}", "2 or 3")
    _check(visu, "VisuCoreFrameCount", 0 < count <= _MOST_FRAMES, f"{count}", "a plausible number of frames")
    kinds = visu.words("VisuCoreDimDesc") if "VisuCoreDimDesc" in visu else ["spatial"]
    _check(visu, "VisuCoreDimDesc", set(kinds) == {"spatial"}, ", ".join(kinds), "spatial dimensions alone")
    size, extent = _of_length(visu, "VisuCoreSize", dimension), _of_length(visu, "VisuCoreExtent", dimension)
    sides = bool(((size >= 1) & (size <= _MOST_SIDE) & (size == np.round(size))).all())
    _check(visu, "VisuCoreSize", sides, str(size), "whole numbers of pixels")
    _check(visu, "VisuCoreExtent", bool((extent > 0).all()), str(extent), "lengths above 0")
    if "VisuCoreUnits" in visu:
        units = set(visu.words("VisuCoreUnits"))
        _check(visu, "VisuCoreUnits", units == {"mm"}, ", ".join(sorted(units)), "mm")
    groups = _groups(visu, count)
    order = (
        visu.word("VisuCoreDiskSliceOrder") if "VisuCoreDiskSliceOrder" in visu else "disk_normal_slice_order"
    )
    slope = _for_frames(visu, "VisuCoreDataSlope", 1, groups)[:, 0]
    _check(visu, "VisuCoreDataSlope", bool((slope != 0).all()), "0", "numbers other than 0")
    return VisuFrames(
        dtype=np.dtype(
            _one_of(visu, "VisuCoreByteOrder", _ORDERS) + _one_of(visu, "VisuCoreWordType", TYPES)
        ),
        shape=tuple(int(side) for side in size[::-1]),
        spacing=tuple(float(side) for side in (extent / size)[::-1]),
        groups=groups,
        positions=_for_frames(visu, "VisuCorePosition", 3, groups),
        axes=_axes(visu, _for_frames(visu, "VisuCoreOrientation", 9, groups).reshape(-1, 3, 3)),
        slope=slope,
        offset=_for_frames(visu, "VisuCoreDataOffs", 1, groups)[:, 0],
        thickness=_thickness(visu) if dimension == 2 else None,
        backwards=order == "disk_reverse_slice_order",
    )


def _groups(visu: Parameters, count: int) -> tuple[tuple[str, int], ...]:
    if "VisuFGOrderDesc" not in visu:
        return ((_SLICES, count),)
    found = visu.structures("VisuFGOrderDesc")
    good = all(len(each) >= 2 and each[0].isdecimal() and 0 < int(each[0]) <= count for each in found)
    lengths = [int(each[0]) for each in found] if good else [0]
    total = int(np.prod(lengths, dtype=object))
    _check(visu, "VisuFGOrderDesc", total == count, f"{total} frames", f"{count}, as VisuCoreFrameCount says")
    return tuple((each[1], length) for each, length in zip(found, lengths, strict=True))


def _for_frames(visu: Parameters, name: str, width: int, groups: tuple[tuple[str, int], ...]) -> FloatArray:
    """Return an entry's rows for every frame, where it gives them for each, for each slice, or once."""
    values = visu.numbers(name)
    total = int(np.prod([length for _, length in groups]))
    rows = values.reshape(-1, width) if len(values) % width == 0 else values[:0].reshape(0, width)
    if len(rows) == total:
        return rows
    if len(rows) == 1:
        return np.repeat(rows, total, axis=0)
    before = 1
    for group, length in groups:
        if group == _SLICES and len(rows) == length:
            return rows[np.arange(total) // before % length]
        before *= length
    raise InputError(
        f"is damaged: {name} is wrong",
        where=str(visu.path),
        found=f"{len(values)} numbers",
        expected=f"{width} for each of {total} frames, for each slice, or once",
    )


def _axes(visu: Parameters, axes: FloatArray) -> FloatArray:
    """Return the directions, made exactly perpendicular; the normal is what they say, not their product."""
    lengths = np.linalg.norm(axes, axis=2)
    products = np.einsum("fij,fkj->fik", axes, axes) - np.eye(3)
    good = bool((np.abs(lengths - 1) < _UNIT).all() and (np.abs(products) < 2 * _UNIT).all())
    _check(visu, "VisuCoreOrientation", good, "no perpendicular unit vectors", "three for each frame")
    across = axes[:, 0] / lengths[:, :1]
    down = axes[:, 1] - np.einsum("fj,fj->f", axes[:, 1], across)[:, None] * across
    down /= np.linalg.norm(down, axis=1)[:, None]
    normal = np.cross(across, down)
    normal *= np.sign(np.einsum("fj,fj->f", normal, axes[:, 2]))[:, None]
    return np.stack([across, down, normal], axis=1)


def _thickness(visu: Parameters) -> float | None:
    if "VisuCoreFrameThickness" not in visu:
        return None
    values = visu.numbers("VisuCoreFrameThickness")
    return float(values[0]) if len(values) and (values > 0).all() and np.ptp(values) == 0 else None


def _of_length(visu: Parameters, name: str, length: int) -> FloatArray:
    values = visu.numbers(name)
    _check(visu, name, len(values) == length, f"{len(values)} numbers", f"{length}, as VisuCoreDim says")
    return values


def _one_of(visu: Parameters, name: str, choices: dict[str, str]) -> str:
    word = visu.word(name)
    _check(visu, name, word in choices, word[:40], ", ".join(choices))
    return choices[word]


def _check(visu: Parameters, name: str, good: bool, found: str, expected: str) -> None:
    if not good:
        raise InputError(f"{name} is impossible", where=str(visu.path), found=found, expected=expected)
