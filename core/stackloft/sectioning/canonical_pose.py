r"""Which way round a stack is lofted: always the same, whether it or its mirror image was given.

::

     given     |     given           33 points cannot lie on a loop as they would on its mirror image's,
     `--.      |      .--'           and of two equally good chords one must be taken. So the loft works on
        |      |      |              a body whose odd moments are positive, and what it made is mirrored
               |                     back. Turned half round is both mirrors at once.

Where all moments that would tell two poses apart are zero, the body is the same in both, and either will do.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby, islice

import numpy as np

from stackloft.geometry.odd_moments import Powers, central_moment_ratios
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.sectioning.loop_curves import flipped_points, mirror_ready

POWERS: tuple[Powers, ...] = (
    (3, 0, 0), (1, 2, 0),
    (0, 3, 0), (2, 1, 0),
    (1, 1, 0), (3, 1, 0), (1, 3, 0),
    (1, 0, 1), (3, 0, 1), (1, 2, 1),
    (0, 1, 1), (0, 3, 1), (2, 1, 1),
    (1, 1, 1), (3, 1, 1), (1, 3, 1),
)  # fmt: skip
"""Moments x^p y^q z^r by what they are odd in: x; y; both; and the same with z."""
NOTHING = 1e-9
"""Ratios below this are rounding: of exact loops they are wrong by 1e-13."""
ENOUGH = 48
"""Sections looked at."""
FLIPS = ((1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0))


def canonical_flip(contours: ContourStack) -> tuple[float, float]:
    """Return by what x and y are multiplied, 1 or -1 each, to lay a body in its canonical pose.

    Of moments odd in the same coordinates the largest decides; they decide in the order of `POWERS`.

    Examples
    --------
    >>> from stackloft.model.contour_stack import Section
    >>> wedge = np.array([[0.0, 0.0], [6.0, -1.0], [6.0, 1.5]])
    >>> def stack(x, y):
    ...     loop = Loop(wedge * [x, y])
    ...     return ContourStack((Section(0.0, (loop,), "a"), Section(1.0, (loop,), "b")))
    >>> canonical_flip(stack(1, 1)), canonical_flip(stack(-1, 1)), canonical_flip(stack(-1, -1))
    ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0))
    """
    ratios = _ratios(contours)
    left = list(FLIPS)
    for odd, group in groupby(range(len(POWERS)), key=lambda k: _odd(POWERS[k])):
        value = max((float(ratios[k]) for k in group), key=abs)
        if abs(value) < NOTHING:
            continue
        upright = [flip for flip in left if value * flip[0] ** odd[0] * flip[1] ** odd[1] > 0.0]
        left = upright or left
    return left[0]


def flipped_stack(contours: ContourStack, flip: tuple[float, float]) -> ContourStack:
    """Return the stack with x and y multiplied; it lies where it lay on the bench.

    What is known of its loops (`ready_loops`, `ready_curves`) is flipped along, not worked out anew.
    """
    if flip == (1.0, 1.0):
        return contours
    flat = [loop for section in contours.sections for loop in section.loops]
    points = flipped_points([loop.points for loop in flat], flip)
    loops = (Loop(own, loop.corners, loop.hole) for own, loop in zip(points, flat, strict=True))
    sections = tuple(
        Section(section.z, tuple(islice(loops, len(section.loops))), section.name)
        for section in contours.sections
    )
    affine = frozen_floats(contours.affine * [*flip, 1.0, 1.0])
    mirrored = replace(contours, sections=sections, affine=affine)
    mirror_ready(contours, mirrored, flip)
    return mirrored


def _odd(powers: Powers) -> tuple[int, int, int]:
    p, q, r = (power % 2 for power in powers)
    return p, q, r


def _ratios(contours: ContourStack) -> FloatArray:
    """Return the moments' ratios, of some sections evenly chosen where there are many."""
    count = len(contours)
    chosen = np.unique(np.round(np.linspace(0, count - 1, min(count, ENOUGH))).astype(int))
    z = contours.positions[chosen]
    share = np.gradient(z) if len(z) > 1 else np.ones(1)
    sections = [contours.sections[k] for k in chosen]
    loops = [loop.points for section in sections for loop in section.loops]
    numbers = [len(section.loops) for section in sections]
    if not loops:
        return np.zeros(len(POWERS))
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = central_moment_ratios(loops, np.repeat(z, numbers), np.repeat(share, numbers), list(POWERS))
    return np.nan_to_num(ratios)  # loops without area are refused later, by name
