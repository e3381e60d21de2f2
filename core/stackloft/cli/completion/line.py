"""A half-written command line, split as the shells split it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Line:
    """What stands before the cursor."""

    words: tuple[str, ...]
    """The finished words, the command itself included."""
    current: str
    """The word at the cursor, quotes removed; may be empty."""
    raw: str
    """The same as it is typed, an opening quote included."""


def split_line(text: str) -> Line:
    r"""Return the words of `text`, which ends at the cursor; quotes may still be open.

    Examples
    --------
    >>> split_line("stackloft measure 'my apple' --meth")
    Line(words=('stackloft', 'measure', 'my apple'), current='--meth', raw='--meth')
    >>> split_line("stackloft info my\\ app").current
    'my app'
    >>> split_line("stackloft ").current
    ''
    """
    words: list[str] = []
    word, raw, quote, started = "", "", "", False
    marks = iter(text)
    for mark in marks:
        if not quote and mark.isspace():
            if started:
                words.append(word)
            word, raw, started = "", "", False
            continue
        started, raw = True, raw + mark
        if mark == "\\" and quote != "'":
            escaped = next(marks, "")
            word, raw = word + escaped, raw + escaped
        elif quote and mark == quote:
            quote = ""
        elif not quote and mark in {'"', "'"}:
            quote = mark
        else:
            word += mark
    return Line(tuple(words), word, raw)
