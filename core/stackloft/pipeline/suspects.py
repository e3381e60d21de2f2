"""A refusal that comes from a stack's mistakes names the slices that were already suspected."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError, StackloftError

SUSPECT = (
    *("border-contact", "background-unsure", "slice-odd", "wrong-order", "slice-doubled", "motion"),
    *("misaligned", "low-contrast", "flesh-unsure", "edge-object"),
)
"""Codes of warnings that may say why sections cannot be joined, the likeliest first."""
_TOLD = 2


def with_suspects(error: StackloftError, products: Iterable[Any]) -> StackloftError:
    """Return the error with what the sections' own warnings say of slices; itself where they say nothing.

    Examples
    --------
    >>> from stackloft.model.notices import Notice
    >>> from stackloft.testing import phantoms
    >>> from dataclasses import replace
    >>> cuts = phantoms.make("apple").contour_stack(5)
    >>> notice = Notice("border-contact", "b.jpg: is cut off there; photograph it whole")
    >>> suspected = replace(cuts, notices=(notice,))
    >>> print(with_suspects(InputError("cannot be joined", fix="cut thinner"), [suspected]))
    cannot be joined; fix: look first at b.jpg: is cut off there; else cut thinner
    """
    stacks = [item for item in products if isinstance(item, ContourStack)]
    notices = [notice for stack in stacks for notice in stack.notices if notice.code in SUSPECT]
    if not isinstance(error, InputError) or not notices:
        return error
    likeliest = sorted(notices, key=lambda notice: SUSPECT.index(notice.code))[:_TOLD]
    told = " and ".join(dict.fromkeys(notice.message.partition(";")[0] for notice in likeliest))
    fix = f"look first at {told}" + (f"; else {error.fix}" if error.fix else "")
    return InputError(error.what, where=error.where, found=error.found, expected=error.expected, fix=fix)
