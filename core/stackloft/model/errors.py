"""Errors a person can act on: what is wrong, where, and the fix."""

from __future__ import annotations


class StackloftError(Exception):
    """Base of every error that stackloft raises on purpose.

    Parameters
    ----------
    what : str
        What is wrong, in one sentence.
    where : str, optional
        The file, folder or option it is about; printed first.
    found, expected : str, optional
        What was met and what was needed.
    fix : str, optional
        What the person can do about it.

    Examples
    --------
    >>> print(InputError("no body found", where="slice_03.png", fix="give --set segmenter.threshold"))
    slice_03.png: no body found; fix: give --set segmenter.threshold
    """

    exit_status = 1

    def __init__(
        self,
        what: str,
        *,
        where: str | None = None,
        found: str | None = None,
        expected: str | None = None,
        fix: str | None = None,
    ) -> None:
        self.what = what
        self.where = where
        self.found = found
        self.expected = expected
        self.fix = fix
        super().__init__(str(self))

    def __str__(self) -> str:
        head = f"{self.where}: {self.what}" if self.where else self.what
        parts = [head]
        parts += [f"{key}: {value}" for key, value in self._details() if value]
        return "; ".join(parts)

    def _details(self) -> tuple[tuple[str, str | None], ...]:
        return (("found", self.found), ("expected", self.expected), ("fix", self.fix))


class InputError(StackloftError):
    """The input cannot be measured (exit status 1)."""


class UsageError(StackloftError):
    """The command or an option was used wrongly (exit status 2)."""

    exit_status = 2


class PluginError(StackloftError):
    """A plug-in is missing, broken or ambiguous (exit status 1)."""


class OutputError(StackloftError):
    """A result cannot be written (exit status 1)."""
