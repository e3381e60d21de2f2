"""Whether a volume is a label map, and its Segmentation when it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.array_axis import MEMORY, along_axis
from stackloft.sectioning.object_choice import LARGEST, one_object

CHOICES = ("auto", "yes", "no")
MOST_LABELS = 32
"""An integer volume with no more different values than this is taken for labels."""
_SAMPLED = 9


def as_labels(
    stack: SliceStack, wanted: str, body: str = LARGEST, axis: str = "0", memory: float = MEMORY
) -> SliceStack | Segmentation:
    """Return the Segmentation of one label when the pictures are labels, else the stack.

    Parameters
    ----------
    stack : SliceStack
    wanted : {"auto", "yes", "no"}
        ``auto``: whole numbers of few values in a sample of slices, 0 among them, are labels.
    body : str
        ``largest`` or a label.
    axis, memory
        As `stackloft.sectioning.array_axis.along_axis` takes them, or ``auto``.

    Raises
    ------
    InputError
        Labels are wanted and the pictures are no whole numbers from 0, or hold no label.

    Examples
    --------
    >>> from pathlib import Path
    >>> from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack
    >>> picture = np.zeros((8, 8), dtype=np.uint8)
    >>> picture[2:6, 2:6] = 3
    >>> grid = VoxelGrid((2, 8, 8), (1.0, 1.0), np.array([0.0, 1.0]))
    >>> volume = volume_stack(grid, lambda k: picture, Path("a.nrrd"), {})
    >>> as_labels(volume, "auto").stack.provenance["object"]
    '3'
    """
    if wanted == "no" or (wanted == "auto" and not _seem_labels(stack)):
        return stack
    labels: set[int] = set()
    for k in range(len(stack)):
        labels |= _values(stack.decode(k), stack.names[k])
    labels.discard(0)
    if not labels:
        raise InputError("the label map holds no label", where=stack.names[0])
    known = tuple(sorted(labels))
    whole = one_object(_segmentation(stack, known), body)
    number, told = (int(axis), ()) if axis != "auto" else best_axis_of(whole)
    if number:
        whole = one_object(_segmentation(along_axis(stack, number, memory), known), body)
    return replace(whole, notices=(*whole.notices, *told))


def best_axis_of(body: Segmentation) -> tuple[int, tuple[Notice, ...]]:
    """Return the axis that a body is best cut across, and a notice of the choice."""
    from stackloft.sectioning.best_axis import axis_notice, best_axis  # noqa: PLC0415 - it needs OpenCV

    axis, told = best_axis(body)
    return axis, axis_notice(told)


def _segmentation(stack: SliceStack, labels: tuple[int, ...]) -> Segmentation:
    return Segmentation(stack, _field_of, binary=True, labels=labels)


def _field_of(number: int, picture: Picture) -> SectionField:  # noqa: ARG001 - a field_of
    return SectionField((picture > 0).astype(np.float64), 0.5, threshold=0.5)


def _seem_labels(stack: SliceStack) -> bool:
    values: set[int] = set()
    for k in np.unique(np.linspace(0, len(stack) - 1, _SAMPLED).astype(int)):
        picture = stack.decode(int(k))
        if picture.dtype.kind not in "bui" or picture.ndim != 2:
            return False
        values |= set(np.unique(picture).tolist())
        if len(values) > MOST_LABELS or min(values) < 0:
            return False
    return 0 in values and len(values) > 1


def _values(picture: Picture, name: str) -> set[int]:
    found = np.unique(picture)
    if picture.ndim != 2 or found[0] < 0 or not (found == np.round(found)).all():
        raise InputError(
            "a label map holds whole numbers from 0",
            where=name,
            found=f"{found[0]:g} to {found[-1]:g}",
            fix="--set labels=no reads grey levels",
        )
    return {int(value) for value in found}
