"""The loop of a slice whose body is one piece without a hole, traced by the compiled kernels.

Such a slice has nothing to sort: no debris, no hole, and where the body keeps off the crop's border no
contact with the picture's. All others are traced by `tracing`, which gives the same loop for these.
"""

from __future__ import annotations

from stackloft.compiled.level_line import level_line
from stackloft.compiled.solid_piece import solid_piece
from stackloft.model.arrays import FloatArray, read_only
from stackloft.sectioning.slice_lines import SliceToTrace, TraceRules
from stackloft.sectioning.voids import CRACKS


def single_outline(one: SliceToTrace, rules: TraceRules) -> FloatArray | None:
    """Return the points (x, y) of a slice's one loop, (k, 2) mm; None where it is not so simple.

    None also without compiled kernels.
    """
    section = one.section
    if section.local_levels is not None:
        return None
    outline, (row, column) = section.outline, section.offset
    if outline is None:
        found = solid_piece(section.values, section.level, CRACKS)
        if found is None:
            return None
        chain = found.outline
    else:
        chain = outline - (column, row)
    traced = level_line(section.values, section.level, section.noise, chain, section.offset, one.spacing)
    if traced is None or traced[1] < rules.fewest_pixels:
        return None
    return read_only(traced[0])
