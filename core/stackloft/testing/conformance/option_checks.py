"""Checks of options that every family shares."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.member_checks import faults_of
from stackloft.registry.options_model import plain, validate
from stackloft.testing.conformance.check import must, must_refuse


def check_shape(family: str, plugin: Any) -> None:
    """Raise `NonconformingError` when the registry would quarantine the plug-in."""
    faults = faults_of(family, plugin)
    must(not faults, "; ".join(faults))


def check_options(plugin: Any, options: Mapping[str, Any]) -> None:
    """Raise `NonconformingError` when options are not declared, refused or kept as they should be."""
    values = validate(plugin, options, "case")
    document = {name: plain(value) for name, value in values.items()}
    must(validate(plugin, document, "case") == values, "options do not survive JSON")
    must_refuse(lambda: validate(plugin, {"no_such_option_": 1}, "case"), "an unknown option")
    for item in fields_of(plugin):
        must(item.help, f"option {item.name} has no help: declare it with stackloft.contracts.options.option")
        for value in _outside(item):
            asked = {item.name: value}
            must_refuse(lambda asked=asked: validate(plugin, asked, "case"), f"option {asked}")  # type: ignore[misc]
    must(plugin() == plugin(), "two instances with the same options are not equal")


def _outside(item: OptionField) -> list[Any]:
    """Return values just outside the bounds and choices that an option declares."""
    steps = {"ge": -1.0, "gt": 0.0, "le": 1.0, "lt": 0.0}
    values: list[Any] = [bound + steps[kind] for kind, bound in item.bounds.items()]
    if item.choices:
        values.append("no-such-choice-")
    if item.annotation is float and not item.choices:
        values += [math.nan, "not a number"]
    return values
