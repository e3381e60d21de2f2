r"""JCAMP-DX parameter files as ParaVision writes them (``visu_pars``, ``reco``): names, sizes and values.

::

    ##$VisuCoreSize=( 2 )                      a size in brackets, the values on the lines that follow
    128 96
    ##$VisuCoreDataSlope=( 12 )
    @12*(2.5)                                  twelve times 2.5
    ##$VisuFGOrderDesc=( 1 )
    (12, <FG_SLICE>, <a comment>, 0, 2)        a structure; text stands in angle brackets
    ##$VisuCoreWordType=_16BIT_SGN_INT         a value on the same line
    $$ a comment

Source: McDonald & Wilks, JCAMP-DX (1988), and what ParaVision 5 to 360 make of it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError

_MOST_BYTES = 1 << 25
_MOST_VALUES = 1 << 22
_LONGEST_RUN, _LONGEST_VALUE = 8, 40  # characters
_ENTRY = re.compile(r"^##\$?([A-Za-z0-9_]+)\s*=", re.MULTILINE)
_SIZE = re.compile(r"\A\s*\(\s*(\d+(?:\s*,\s*\d+)*)\s*\)\s*(?:\n|\Z)")
_RUN = re.compile(r"@(\d+)\*\(([^()]*)\)")


@dataclass(frozen=True, slots=True)
class Parameters:
    """A parameter file's entries, as text; each is turned into numbers or words when it is asked for."""

    path: Path
    entries: Mapping[str, str]

    def __contains__(self, name: str) -> bool:
        return name in self.entries

    def text(self, name: str) -> str:
        """Return an entry's values as one text, the size before them taken off.

        Raises
        ------
        InputError
            The entry is missing.
        """
        if name not in self.entries:
            raise InputError(
                f"does not say {name}", where=str(self.path), fix="copy the whole scan folder again"
            )
        return _SIZE.sub("", self.entries[name], count=1).strip()

    def word(self, name: str) -> str:
        """Return an entry's only word, without angle brackets.

        Raises
        ------
        InputError
            Missing, or several words.
        """
        words = self.words(name)
        if len(words) != 1:
            raise self._wrong(name, "one word")
        return words[0]

    def words(self, name: str) -> list[str]:
        """Return an entry's words; text in angle brackets is one word."""
        return [a or b for a, b in re.findall(r"<([^<>]*)>|([^\s<>]+)", self.text(name))]

    def numbers(self, name: str) -> FloatArray:
        """Return an entry's numbers, runs written out, (n).

        Raises
        ------
        InputError
            Missing, no finite numbers, or another count than the size before them says.
        """
        parts = self._written_out(name).split()
        try:
            values = np.array([float(part) for part in parts])
        except ValueError:
            raise self._wrong(name, "numbers") from None
        if not np.isfinite(values).all():
            raise self._wrong(name, "finite numbers")
        size = _SIZE.match(self.entries[name])
        said = int(np.prod([int(part) for part in size[1].split(",")], dtype=object)) if size else 1
        if len(values) != said:
            raise self._wrong(name, f"{said} numbers, not {len(values)}")
        return values

    def whole(self, name: str) -> int:
        """Return an entry's only number, which is whole."""
        values = self.numbers(name)
        if len(values) != 1 or values[0] != round(values[0]):
            raise self._wrong(name, "one whole number")
        return int(values[0])

    def structures(self, name: str) -> list[list[str]]:
        """Return an entry's structures, each as its members' text, angle brackets taken off."""
        found = re.findall(r"\(((?:<[^<>]*>|[^()<>])*)\)", self.text(name))
        return [
            [
                a if a or not b else b.strip()
                for a, b in re.findall(r"<([^<>]*)>|([^,<>]*[^,<>\s][^,<>]*)", each)
            ]
            for each in found
        ]

    def _written_out(self, name: str) -> str:
        text = self.text(name)
        runs = _RUN.findall(text)
        if any(len(count) > _LONGEST_RUN or len(value) > _LONGEST_VALUE for count, value in runs) or (
            sum(int(count) for count, _ in runs) > _MOST_VALUES
        ):
            raise self._wrong(name, "a plausible number of values")
        return _RUN.sub(lambda run: f" {run[2]} " * int(run[1]), text)

    def _wrong(self, name: str, expected: str) -> InputError:
        return InputError(f"is damaged: {name} is wrong", where=str(self.path), expected=expected)


def read_parameters(path: Path) -> Parameters:
    """Return the entries of a parameter file.

    Raises
    ------
    InputError
        Missing, too large, or no such file.
    """
    try:
        if path.stat().st_size > _MOST_BYTES:
            raise InputError("is no parameter file", where=str(path), found="more than 32 MB")
        content = path.read_bytes()
    except OSError as error:
        raise InputError("cannot be opened", where=str(path), found=error.strerror) from error
    return parse_parameters(content.decode("utf-8", "replace"), path)


def parse_parameters(text: str, path: Path) -> Parameters:
    r"""Return the entries in a parameter file's text.

    Raises
    ------
    InputError
        There are none, or one is there twice.

    Examples
    --------
    >>> text = "##$Size=( 2 )\n128 96\n$$ note\n##$Slope=( 3 )\n@3*(0.5)\n##END=\n"
    >>> read = parse_parameters(text, Path("visu_pars"))
    >>> read.numbers("Size"), read.numbers("Slope")
    (array([128.,  96.]), array([0.5, 0.5, 0.5]))
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    clean = "\n".join(line for line in lines if not line.lstrip().startswith("$$"))
    places = list(_ENTRY.finditer(clean))
    if not places:
        raise InputError("is no parameter file", where=str(path), expected="entries such as ##$VisuCoreDim=2")
    ends = [place.start() for place in places[1:]] + [len(clean)]
    entries: dict[str, str] = {}
    for place, end in zip(places, ends, strict=True):
        if place[1] in entries:
            raise InputError(f"is damaged: {place[1]} is there twice", where=str(path))
        entries[place[1]] = clean[place.end() : end].lstrip(" ").rstrip()
    return Parameters(path, entries)
