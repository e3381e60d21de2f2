"""Where a body of known extent is cut.

::

    mid      |--*--|--*--|--*--|        equal slices, each cut at mid-thickness
    faces    *-----*-----*-----)        equal slices, each seen on its face; a plane end is a section
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError

Placing = Literal["mid", "faces"]


def section_positions(
    extent: tuple[float, float],
    plane_ends: tuple[bool, bool],
    sections: int,
    placing: Placing | Sequence[float],
) -> FloatArray:
    """Return the positions of the sections, mm, increasing.

    Raises
    ------
    UsageError
        Fewer than two sections, an unknown placing, ``faces`` for a body without a plane end, or
        positions that do not increase.

    Examples
    --------
    >>> section_positions((0.0, 12.0), (False, False), 3, "mid").tolist()
    [2.0, 6.0, 10.0]
    >>> section_positions((0.0, 12.0), (True, False), 3, "faces").tolist()
    [0.0, 4.0, 8.0]
    >>> section_positions((0.0, 12.0), (True, True), 3, "faces").tolist()
    [0.0, 6.0, 12.0]
    """
    if not isinstance(placing, str):
        z = np.asarray(placing, dtype=float)
        if z.ndim != 1 or not len(z) or not (np.diff(z) > 0).all():
            raise UsageError("positions must increase", where="placing", found=str(placing))
        return z
    if placing not in {"mid", "faces"}:
        raise UsageError(
            "unknown placing", where="placing", found=repr(placing), expected="mid, faces or positions"
        )
    if sections < 2:
        raise UsageError("too few sections", where="sections", found=str(sections), expected="at least 2")
    low, high = extent
    if placing == "mid":
        return low + (high - low) * (np.arange(sections) + 0.5) / sections
    if not any(plane_ends):
        raise UsageError("no plane end to cut from", where="placing", found="faces", fix="use mid")
    if all(plane_ends):
        return np.linspace(low, high, sections)
    z = np.linspace(low, high, sections + 1)
    return z[:-1] if plane_ends[0] else z[1:]
