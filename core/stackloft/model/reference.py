r"""An object of known size in the picture, which tells the scale.

::

     ___           +-----+        +-------------------+
    /   \          |     |        |                   |
    \___/          +-----+        +-------------------+
    disc:DIAMETER  square:SIDE    ruler:LENGTH of the piece
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length

_FORMS = "disc:24.25mm, square:20mm or ruler:50mm"


class ReferenceKind(StrEnum):
    """Kinds of reference object."""

    DISC = "disc"
    """A coin, a punched disc: its diameter is known."""
    SQUARE = "square"
    """A printed or cut square: its side is known."""
    RULER = "ruler"
    """A straight piece with square ends, such as a scale bar: its length is known."""


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference object.

    Examples
    --------
    >>> Reference.parse("disc:2.425cm")
    Reference(kind=<ReferenceKind.DISC: 'disc'>, size=24.25)
    >>> str(Reference.parse("ruler:50"))
    'ruler:50mm'
    """

    kind: ReferenceKind
    size: float
    """mm"""

    @classmethod
    def parse(cls, text: str) -> Reference:
        """Return the object written as ``disc|square|ruler:LEN``.

        Raises
        ------
        UsageError
            Another form, or a length that is not positive.
        """
        name, _, rest = text.strip().partition(":")
        if name not in set(ReferenceKind) or not rest:
            raise UsageError("no reference object", where="--reference", found=repr(text), expected=_FORMS)
        size = parse_length(rest, "--reference")
        if size <= 0:
            raise UsageError("must be positive", where="--reference", found=repr(text), expected=_FORMS)
        return cls(ReferenceKind(name), size)

    def __str__(self) -> str:
        return f"{self.kind.value}:{self.size:.12g}mm"
