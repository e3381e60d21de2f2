"""The loop of a slice whose body is one piece without a hole, traced by the compiled kernels.

Such a slice has nothing to sort: no debris, no hole, and where the body keeps off the crop's border no
contact with the picture's. All others are traced by `tracing`, which gives the same loop for these.
"""

from __future__ import annotations

from collections.abc import Sequence

from stackloft.compiled.level_line import Border, level_lines
from stackloft.model.arrays import FloatArray, read_only
from stackloft.sectioning.slice_lines import SliceToTrace, TraceRules


def single_outlines(slices: Sequence[SliceToTrace], rules: TraceRules) -> list[FloatArray | None]:
    """Return the points (x, y) of each slice's one loop, (k, 2) mm; None where it is not so simple.

    None of all without compiled kernels.
    """
    borders = [_border(one) for one in slices]
    traced = iter(level_lines([one for one in borders if one is not None]))
    found = [None if one is None else next(traced) for one in borders]
    return [None if one is None or one[1] < rules.fewest_pixels else read_only(one[0]) for one in found]


def _border(one: SliceToTrace) -> Border | None:
    """Return a body's known outline; what is not known yet is found sooner by `slice_lines`."""
    section = one.section
    if section.local_levels is not None or section.outline is None:
        return None
    chain = section.outline - (section.offset[1], section.offset[0])
    return Border(section.values, section.level, section.noise, chain, section.offset, one.spacing)
