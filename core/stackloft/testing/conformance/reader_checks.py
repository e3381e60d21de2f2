"""Checks of readers; run them with one pytest call.

::

    @pytest.mark.parametrize("check", reader_checks(ReaderCase(MyReader, write=write_sample)), ids=str)
    def test_my_reader(check):
        check()
"""

from __future__ import annotations

from collections.abc import Mapping

from stackloft.testing.conformance import probe_checks, read_checks, refusal_checks, told_checks
from stackloft.testing.conformance.check import Check, suite
from stackloft.testing.conformance.option_checks import check_options, check_shape
from stackloft.testing.conformance.reader_case import ReaderCase


def shape(case: ReaderCase) -> None:
    """Check that the registry lets the reader in."""
    check_shape("reader", case.reader)


def options(case: ReaderCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.reader, case.options)


CHECKS = {
    "plugin-shape": shape,
    # first, because a deed done once (a variable set, a seed) does not show when it is done again
    "probe-no-side-effects": probe_checks.no_side_effects,
    "read-no-side-effects": read_checks.no_side_effects,
    "options-validated": options,
    **probe_checks.CHECKS,
    **read_checks.CHECKS,
    **refusal_checks.CHECKS,
}


def reader_checks(case: ReaderCase, expected_failures: Mapping[str, str] | None = None) -> list[Check]:
    """Return the checks of one reader; those against a known volume when the case can write one.

    Parameters
    ----------
    case : ReaderCase
        The reader and how to write something that it reads.
    expected_failures : mapping, optional
        Reasons by check for those that this reader may break; it must then really break them.
    """
    told = told_checks.CHECKS if case.write_told is not None else {}
    return suite({**CHECKS, **told}, case, expected_failures or {})
