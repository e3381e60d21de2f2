"""The checks of a plug-in by its name alone: what its package tells about it is found beside it.

A package tells what the kit cannot know (how to write a file that a reader reads, tolerances, expected
failures with their reasons) in a mapping ``CASES`` in its module ``conformance``, or in the plug-in's own
module, by ``family.name``::

    CASES = {"reader.acme-xct": {"write": write_sample, "without_spacing": write_bare}}

The keys of a case are the fields of `ReaderCase`, `SegmenterCase`, … and ``expected_failures``.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from stackloft.contracts.recipe import Recipe
from stackloft.model.errors import PluginError, UsageError
from stackloft.registry.find import find, nearest
from stackloft.registry.glance import source_of
from stackloft.registry.member_checks import METHODS
from stackloft.registry.scan import catalogue
from stackloft.testing.conformance.check import Check
from stackloft.testing.conformance.integrator_case import IntegratorCase
from stackloft.testing.conformance.integrator_checks import integrator_checks
from stackloft.testing.conformance.mesher_checks import MesherCase, mesher_checks
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import reader_checks
from stackloft.testing.conformance.recipe_checks import RecipeCase, recipe_checks
from stackloft.testing.conformance.reconstructor_case import ReconstructorCase
from stackloft.testing.conformance.reconstructor_checks import reconstructor_checks
from stackloft.testing.conformance.segmenter_checks import SegmenterCase, segmenter_checks
from stackloft.testing.conformance.writer_checks import WriterCase, writer_checks


@dataclass(frozen=True, slots=True)
class Kit:
    """One family's kit."""

    case: type[Any]
    checks: Callable[..., list[Check]]


KITS: dict[str, Kit] = {
    "reader": Kit(ReaderCase, reader_checks),
    "segmenter": Kit(SegmenterCase, segmenter_checks),
    "reconstructor": Kit(ReconstructorCase, reconstructor_checks),
    "mesher": Kit(MesherCase, mesher_checks),
    "integrator": Kit(IntegratorCase, integrator_checks),
    "writer": Kit(WriterCase, writer_checks),
    "recipe": Kit(RecipeCase, recipe_checks),
}
"""Kits by family."""


def checks_of(name: str) -> list[Check]:
    """Return the checks of a plug-in.

    Parameters
    ----------
    name : str
        ``family.name`` of one that is installed, or ``module:Class`` of one that need not be.

    Raises
    ------
    PluginError
        No such plug-in, or it is broken.
    UsageError
        Its family has no kit, or its package does not tell what the kit must know.

    Examples
    --------
    >>> [check.name for check in checks_of("recipe.cavalieri")]
    ['plugin-shape', 'chain', 'options', 'measures']
    """
    key, family, plugin = _subject(name)
    if family not in KITS:
        raise UsageError(f"there is no conformance kit for a {family}", expected=", ".join(KITS))
    kit, said = KITS[family], dict(_said_of(plugin, key, name.partition(":")[0]))
    failures = said.pop("expected_failures", None)
    known = [item.name for item in dataclasses.fields(kit.case)][1:]
    for word in said:
        if word not in known:
            raise UsageError(f"the case of {key} says {word!r}", fix=nearest(word, known))
    if family == "reader" and "write" not in said:
        raise UsageError(
            f"the kit does not know how to write a file that {key} reads",
            expected=f"CASES = {{{key!r}: {{'write': …}}}} in the module conformance of its package",
        )
    return kit.checks(kit.case(plugin, **said), failures)


def _subject(name: str) -> tuple[str, str, Any]:
    """Return the key, the family and the plug-in that `name` means."""
    family, _, rest = name.partition(".")
    if family in KITS and ":" not in family:
        return name, family, find(family, rest).plugin
    module, colon, attribute = name.partition(":")
    if not colon:
        raise UsageError(f"{name!r} names no plug-in", expected="family.name or module:Class")
    registered = [item for item in catalogue() if item.target == name]
    plugin = _imported(module, attribute)
    family = registered[0].family if registered else family_of(plugin)
    return (registered[0].key if registered else f"{family}.{attribute}"), family, plugin


def _imported(module: str, attribute: str) -> Any:
    try:
        return getattr(importlib.import_module(module), attribute)
    except Exception as error:
        raise PluginError(
            f"{module}:{attribute} cannot be imported", found=f"{type(error).__name__}: {error}"
        ) from error


def family_of(plugin: Any) -> str:
    """Return the family whose methods a plug-in has.

    Raises
    ------
    UsageError
        It has those of none, or of several.
    """
    if isinstance(plugin, Recipe):
        return "recipe"
    fitting = [
        family
        for family, methods in METHODS.items()
        if all(callable(getattr(plugin, method, None)) for method in methods)
    ]
    if len(fitting) != 1:
        found = " and ".join(fitting) or "none of the families' methods"
        raise UsageError("which family a plug-in belongs to cannot be told", found=found)
    return fitting[0]


def _said_of(plugin: Any, key: str, module: str) -> Mapping[str, Any]:
    """Return what the plug-in's package tells about it; nothing when it tells nothing.

    A class that is not registered has no name of its own: the package's only case of its family is meant.
    """
    home = str(getattr(plugin, "__module__", module))
    for place in dict.fromkeys((home, f"{home.partition('.')[0]}.conformance")):
        if source_of(place) is None:
            continue
        cases: Mapping[str, Mapping[str, Any]] = getattr(importlib.import_module(place), "CASES", {})
        if key in cases:
            return cases[key]
        family = key.partition(".")[0]
        same = [name for name in cases if name.startswith(f"{family}.")]
        if len(same) == 1 and not any(item.key == same[0] for item in catalogue(family)):
            return cases[same[0]]
    return {}
