"""What is done to the slices of a stack to lay them on each other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.slice_stack import SliceStack, turn_matrix


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What is done to each slice: p becomes R(turn)·(p - about) + about + shift."""

    about: FloatArray
    """(m, 2) mm: the section's or the marks' middle"""
    shift: FloatArray
    """(m, 2) mm"""
    turn: FloatArray
    """(m) rad"""


def moved(stack: SliceStack, motion: Motion) -> SliceStack:
    """Return the stack whose slices lie where the motion takes them."""
    m = len(stack)
    origins = np.zeros((m, 2)) if stack.origins is None else stack.origins
    turns = np.zeros(m) if stack.turns is None else stack.turns
    placed = [
        turn_matrix(motion.turn[k]) @ (origins[k] - motion.about[k]) + motion.about[k] + motion.shift[k]
        for k in range(m)
    ]
    turned = turns + motion.turn
    return replace(
        stack, origins=frozen_floats(placed), turns=frozen_floats(turned) if turned.any() else None
    )
