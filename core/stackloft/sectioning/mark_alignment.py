r"""How slices were laid down, from the fiducial marks that moved with them.

::

    o +---+        o  +---+         Generalised Procrustes analysis (Gower 1975, Psychometrika 40, 33–51),
      +---+ o  ->     +---+ o       no scale: the marks of all slices are laid on their mean, in turn.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.point_match import rigid_motion
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SliceStack, turn_matrix
from stackloft.sectioning.slice_motion import Motion

Seen = NDArray[np.bool_]


def by_marks(stack: SliceStack, *, rigid: bool) -> Motion:
    """Return the motion that lays the marks of all slices on their usual places.

    Raises
    ------
    InputError
        A slice shows fewer than two of its marks (one, when only moved).
    """
    if stack.marks is None:
        message = "the stack has no marks"
        raise ValueError(message)
    spacing = stack.pixel_spacing[:, None, ::-1]
    marks = np.array([stack.placed(k, points) for k, points in enumerate(stack.marks * spacing)])
    seen = np.isfinite(marks).all(axis=2)
    _check_seen(seen, stack.names, 2 if rigid else 1)
    usual = _usual_places(marks, seen, rigid=rigid)
    turn, shift, about = np.zeros(len(marks)), np.zeros((len(marks), 2)), np.zeros((len(marks), 2))
    for k, own in enumerate(seen):
        turn[k], move = rigid_motion(marks[k, own], usual[own], turning=rigid)
        about[k] = marks[k, own].mean(axis=0)
        shift[k] = turn_matrix(turn[k]) @ about[k] + move - about[k]
    return Motion(about, shift, turn)


def _check_seen(seen: Seen, names: Sequence[str], need: int) -> None:
    few = [k for k, own in enumerate(seen) if own.sum() < need]
    if few:
        k = few[0]
        raise InputError(
            "its fiducial marks are not all there",
            where=names[k],
            found=f"{int(seen[k].sum())} of {seen.shape[1]}",
            expected=f"at least {need}, whole, apart from the body and the picture's edge",
            fix="set skip = true for it in stack.toml, or leave --align out",
        )


def _usual_places(marks: FloatArray, seen: Seen, *, rigid: bool) -> FloatArray:
    """Return where the marks lie in the mean of all slices, laid on each other (Procrustes), (k, 2).

    The mean is laid so that the slices are moved and turned by nothing on the whole.
    """
    usual = marks[int(np.argmax(seen.sum(axis=1)))]
    for _ in range(4):
        laid = np.full_like(marks, np.nan)
        for k, own in enumerate(seen & np.isfinite(usual).all(axis=1)):
            angle, shift = rigid_motion(marks[k, own], usual[own], turning=rigid)
            laid[k] = marks[k] @ turn_matrix(angle).T + shift
        usual = np.nanmean(laid, axis=0)
    turns = [rigid_motion(marks[k, own], usual[own], turning=rigid)[0] for k, own in enumerate(seen)]
    usual = (usual - usual.mean(axis=0)) @ turn_matrix(-float(np.mean(turns))).T
    off = [(marks[k, own] - usual[own]).mean(axis=0) for k, own in enumerate(seen)]
    return np.asarray(usual + np.mean(off, axis=0))
