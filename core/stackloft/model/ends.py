"""How a body ends beyond its first and last section.

::

      z ->      |  |  |  |  |)      round: a pole beyond the last section
                |  |  |  |  |>      point: a tip beyond it
                |  |  |  |  |_|     flat:LEN: a plane face LEN beyond it
                |  |  |  |  |       face: the last section is the face
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length


class EndKind(StrEnum):
    """Kinds of end."""

    AUTO = "auto"
    """Decided from the stack's kind and the section areas."""
    FACE = "face"
    """Plane, on the last section itself."""
    FLAT = "flat"
    """Plane, a known length beyond the last section."""
    ROUND = "round"
    """A smooth pole beyond the last section."""
    POINT = "point"
    """A sharp tip beyond the last section."""


@dataclass(frozen=True, slots=True)
class End:
    """One end of a body.

    Examples
    --------
    >>> End.parse("round:2.5mm")
    End(kind=<EndKind.ROUND: 'round'>, length=2.5)
    >>> [str(end) for end in End.parse_pair("face,round")]
    ['face', 'round']
    """

    kind: EndKind = EndKind.AUTO
    length: float | None = None
    """Distance in mm from the last section to the body's end; None when not known."""

    @classmethod
    def parse(cls, text: str) -> End:
        """Return the end written as ``auto|face|flat:LEN|round[:LEN]|point[:LEN]``.

        Raises
        ------
        UsageError
            Unknown kind, a missing or forbidden length, or a length that is not positive.
        """
        name, _, rest = text.strip().partition(":")
        if name not in set(EndKind):
            raise UsageError("unknown end", where="--ends", found=repr(text), expected=_FORMS)
        kind = EndKind(name)
        length = parse_length(rest, "--ends") if rest else None
        if kind in {EndKind.AUTO, EndKind.FACE} and length is not None:
            raise UsageError(f"{kind} takes no length", where="--ends", found=repr(text), expected=_FORMS)
        if length is not None and length <= 0:
            raise UsageError("an end's length must be positive", where="--ends", found=repr(text))
        return cls(kind, length)

    @classmethod
    def parse_pair(cls, text: str) -> tuple[End, End]:
        """Return both ends from ``FIRST[,LAST]``; one alone serves both."""
        first, comma, last = text.partition(",")
        return cls.parse(first), cls.parse(last if comma else first)

    def __str__(self) -> str:
        return self.kind.value if self.length is None else f"{self.kind.value}:{self.length:g}mm"


_FORMS = "auto, face, flat:LEN, round, round:LEN, point, point:LEN (LEN as in 2.5mm)"
