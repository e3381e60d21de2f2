"""What is said of the bodies found in a scan."""

from __future__ import annotations

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.notices import Notice


def stray_notice(k: int, kind: IntArray, volumes: FloatArray) -> tuple[Notice, ...]:
    """Return a notice when a label has voxels away from its largest piece."""
    if not kind[k]:
        return ()
    stray = float(volumes[kind == kind[k]].sum() - volumes[k])
    if not stray:
        return ()
    share = 100 * stray / float(volumes[k])
    text = f"label {kind[k]}: left out {stray:.4g} mm³ of stray voxels ({share:.2g} %) away from its body"
    return (Notice("stray-voxels", text),)


def cut_notice(neck: float | None, count: int) -> tuple[Notice, ...]:
    """Return a notice when bodies that touch were cut apart."""
    if neck is None or count < 2:
        return ()
    text = (
        f"bodies that touch were cut apart where the neck is below {neck:g} of the thinner one's width:"
        f" {count} bodies; a waist counts as a neck, so look at the overview"
    )
    return (Notice("bodies-cut", text),)
