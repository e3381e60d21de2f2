"""A named check: what it proves, whether it holds, and why not."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from stackloft.model.errors import StackloftError, UsageError
from stackloft.registry.find import nearest

NOT_HELD = "the format cannot hold "


class NonconformingError(AssertionError):
    """A plug-in breaks its contract; the message says how."""


class NotHeldError(Exception):
    """A format cannot hold what a check is about; the message says what."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What one check found."""

    check: str
    passed: bool
    reason: str
    """Why it failed, for what reason failing was expected, or what the format cannot hold (after
    `NOT_HELD`); empty when it simply passed."""


@dataclass(frozen=True, slots=True)
class Check:
    """One check of one plug-in; calling it raises `NonconformingError` when it does not hold.

    Examples
    --------
    >>> def odd():
    ...     raise NonconformingError("3 is odd")
    >>> Check("even", odd).finding()
    Finding(check='even', passed=False, reason='3 is odd')
    """

    name: str
    run: Callable[[], None]
    expected_failure: str | None = None
    """Why this plug-in may break this check; it must then really break it."""

    def __call__(self) -> None:
        """Run the check, as pytest wants it."""
        finding = self.finding()
        if not finding.passed:
            raise NonconformingError(f"{self.name}: {finding.reason}")

    def __str__(self) -> str:
        return self.name

    def finding(self) -> Finding:
        """Run the check and return what it found; raises nothing."""
        try:
            reason = self._failure()
        except NotHeldError as error:
            return Finding(self.name, True, f"{NOT_HELD}{error}")
        if self.expected_failure is None:
            return Finding(self.name, reason is None, reason or "")
        if reason is None:
            return Finding(self.name, False, f"passes, although expected to fail: {self.expected_failure}")
        return Finding(self.name, True, self.expected_failure)

    def _failure(self) -> str | None:
        try:
            self.run()
        except NonconformingError as error:
            return str(error)
        except NotHeldError:
            raise
        except Exception as error:  # noqa: BLE001 - whatever a plug-in raises is its failure
            return f"{type(error).__name__}: {error}"
        return None


def suite(
    checks: Mapping[str, Callable[[Any], None]], case: Any, expected_failures: Mapping[str, str]
) -> list[Check]:
    """Return `checks` bound to `case`.

    Raises
    ------
    UsageError
        `expected_failures` names no check, or gives no reason.
    """
    for name, reason in expected_failures.items():
        if name not in checks:
            raise UsageError(f"no check is called {name!r}", fix=nearest(name, list(checks)))
        if not reason.strip():
            raise UsageError(f"the expected failure of {name!r} needs a reason")
    return [Check(name, _bound(run, case), expected_failures.get(name)) for name, run in checks.items()]


def _bound(run: Callable[[Any], None], case: Any) -> Callable[[], None]:
    return lambda: run(case)


def findings(checks: Sequence[Check]) -> list[Finding]:
    """Run every check and return what each one found."""
    return [check.finding() for check in checks]


def must(condition: object, reason: str) -> None:
    """Raise `NonconformingError` with `reason` unless `condition` holds."""
    if not condition:
        raise NonconformingError(reason)


def must_refuse(action: Callable[[], Any], what: str) -> StackloftError:
    """Return the StackloftError that `action` raises; anything else is a failure.

    Examples
    --------
    >>> must_refuse(lambda: 3, "a number")
    Traceback (most recent call last):
    stackloft.testing.conformance.check.NonconformingError: a number is accepted
    """
    try:
        action()
    except StackloftError as error:
        return error
    except Exception as error:
        message = f"{what} ends in {type(error).__name__}, not in a StackloftError: {error}"
        raise NonconformingError(message) from error
    raise NonconformingError(f"{what} is accepted")
