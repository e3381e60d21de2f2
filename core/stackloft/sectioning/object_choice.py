"""Which of a scan's bodies is measured: the largest, or one by its label or rank."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from stackloft.model.errors import UsageError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.sectioning.seed_point import SEED, body_at, seed_of

if TYPE_CHECKING:
    from stackloft.sectioning.objects import BodyObject

LARGEST = "largest"
OBJECTS = "objects"
"""Key of a stack's provenance: the names of all its bodies, separated by commas."""
OBJECT = "object"
"""Key of a stack's provenance: the body that was chosen."""
KIND = "object kind"
"""Key of a stack's provenance: what such a body is called (label, segment, region), if anything."""
_LISTED = 12


def one_object(whole: Segmentation, wanted: str) -> Segmentation:
    """Return one body of a scan, alone on its own slices.

    Parameters
    ----------
    whole : Segmentation
        Of a scan's slices; all of them are decoded once.
    wanted : str
        ``largest``, a label of a label map, a rank by size, from 1, or ``seed:X,Y,Z``: the body at
        that point in patient millimetres.

    Raises
    ------
    InputError
        There is no body.
    UsageError
        There is no such body; those that are there are listed.

    Examples
    --------
    >>> import numpy as np
    >>> from stackloft.model.segmentation import SectionField
    >>> from stackloft.model.slice_stack import SectionKind, SliceStack
    >>> picture = np.zeros((20, 40))
    >>> picture[4:16, 4:16], picture[4:10, 24:30] = 100.0, 100.0
    >>> stack = SliceStack(lambda k: picture, ("a", "b"), (20, 40), np.arange(2.0), np.ones((2, 2)),
    ...                    SectionKind.SLAB)
    >>> both = Segmentation(stack, lambda k, picture: SectionField(picture, 50.0))
    >>> one_object(both, "largest").notices[0].message
    '2 bodies are here (1: 288 mm³, 2: 72 mm³); measured is 1: choose another with --object'
    >>> int((one_object(both, "2").field_of(0, picture).values > 50).sum())
    36
    """
    from stackloft.sectioning.objects import find_objects  # noqa: PLC0415 - it needs OpenCV

    found = find_objects(whole)
    names = [_name(body, rank) for rank, body in enumerate(found, start=1)]
    if wanted == LARGEST:
        number = max(range(len(found)), key=lambda k: found[k].size)
    elif wanted.startswith(SEED):
        number = body_at([body.segmentation for body in found], seed_of(wanted))
    elif wanted in names:
        number = names.index(wanted)
    else:
        raise UsageError("no such object", where="--object", found=wanted, expected=_listing(found, names))
    chosen = found[number].segmentation
    notices = chosen.notices
    if wanted == LARGEST and len(found) > 1:
        text = f"{len(found)} bodies are here ({_listing(found, names)}); measured is {names[number]}"
        notices = (*notices, Notice("several-objects", f"{text}: choose another with --object"))
    told = {**chosen.stack.provenance, OBJECT: names[number], OBJECTS: ",".join(names)}
    if found[number].label is not None:
        told.setdefault(KIND, "label")
    return replace(chosen, stack=replace(chosen.stack, provenance=told), notices=notices)


def _name(body: BodyObject, rank: int) -> str:
    return str(rank if body.label is None else body.label)


def _listing(found: Sequence[BodyObject], names: Sequence[str]) -> str:
    pairs = [f"{name}: {body.size:.4g} mm³" for name, body in zip(names, found, strict=True)]
    more = f" and {len(pairs) - _LISTED} more" if len(pairs) > _LISTED else ""
    return ", ".join(pairs[:_LISTED]) + more
