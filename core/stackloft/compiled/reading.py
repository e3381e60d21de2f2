"""Stored values read from files where they lie as they are, 16-bit ones shifted, some slices at once."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from ctypes import POINTER, c_char_p, c_int, c_int32, c_int64, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import THREADS, Kernel

_AS_IT_IS, _SIGNED, _UNSIGNED = range(3)


class _Part(ctypes.Structure):
    _fields_ = (
        ("path", c_char_p),
        ("at", c_int64),
        ("bytes", c_int64),
        ("to", c_void_p),
        ("kind", c_int32),
        ("by", c_int32),
        ("low", c_int32),
        ("high", c_int32),
        ("done", c_int32),
    )


_read = Kernel("stackloft_read", None, POINTER(_Part), c_int64, c_int)


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Where stored values lie, and what becomes of them."""

    path: Path | None
    """None: they are in `to` already."""
    at: int
    """Byte of the file."""
    to: NDArray[Any]
    """They are written here, whatever was in it; contiguous."""
    shift: int = 0
    """Added to 16-bit values modulo 2¹⁶; these hold the sums as int16 or uint16 afterwards."""


Ends = tuple[int, int]
"""The least and the greatest value as they were stored; (0, 0) where they were not looked at."""


def read_parts(parts: Sequence[Part]) -> list[Ends | None] | None:
    """Read the values; return the ends of each part's, None of one whose file is gone or too short.

    None for all without compiled kernels, or where they cannot do it: then nothing has been changed.

    Examples
    --------
    >>> import numpy as np
    >>> stored = np.array([0, 4095], dtype=np.uint16)
    >>> found = read_parts([Part(None, 0, stored, -1024)])
    >>> found is None or (found, stored.view(np.int16).tolist())
    ([(0, 4095)], [-1024, 3071])
    """
    function = _read.here()
    if function is None or not all(map(_usable, parts)):
        return None
    own = (_Part * len(parts))(*map(_as_part, parts))
    function(own, len(parts), THREADS)
    return [(part.low, part.high) if part.done else None for part in own]


def _usable(part: Part) -> bool:
    flags, kind = part.to.flags, part.to.dtype
    return bool(
        flags.c_contiguous
        and flags.writeable
        and part.to.size
        and (not part.shift or (kind.char in "hH" and kind.isnative))
    )


def _as_part(part: Part) -> _Part:
    kind = _AS_IT_IS
    if part.shift:
        kind = _SIGNED if part.to.dtype.kind == "i" else _UNSIGNED
    path = None if part.path is None else os.fsencode(part.path)
    return _Part(path, part.at, part.to.nbytes, address(part.to), kind, part.shift & 0xFFFF, 0, 0, 0)
