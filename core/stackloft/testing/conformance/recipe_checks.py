"""Checks of recipes: named chains of plug-ins."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from stackloft.model.contour_stack import ContourStack
from stackloft.model.segmentation import Segmentation
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry.find import find
from stackloft.registry.loading import Loaded
from stackloft.registry.member_checks import RUN
from stackloft.registry.options_model import validate
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.check import Check, must, suite
from stackloft.testing.conformance.option_checks import check_shape


@dataclass(frozen=True, slots=True)
class RecipeCase:
    """One recipe and what may be asked of it."""

    recipe: Any
    volume_tolerance: float = 0.15
    """Relative error allowed on the kit's ellipsoid of some 24 sections or slices."""
    area_tolerance: float = 0.15

    def steps(self) -> list[Loaded]:
        """Return its plug-ins."""
        parts = [step.partition(".") for step in self.recipe.steps]
        return [find(family, name) for family, _, name in parts]


def shape(case: RecipeCase) -> None:
    """Check that the registry lets the recipe in, and that it says what it does."""
    check_shape("recipe", case.recipe)
    must(case.recipe.summary.strip(), "it has no summary: what is done, what is assumed, which way it errs")


def chain(case: RecipeCase) -> None:
    """Check that each step is installed, takes what the one before gives, and that the last integrates."""
    steps = case.steps()
    must(steps[-1].family == "integrator", f"its last step is {steps[-1].key}, not an integrator")
    for before, after in pairwise(steps):
        fits = any(issubclass(kind, tuple(after.plugin.accepts)) for kind in before.plugin.produces)
        must(fits, f"{after.key} does not take what {before.key} gives")


def options(case: RecipeCase) -> None:
    """Check that the options it sets are options of its steps, within their bounds."""
    steps = {step.key: step.plugin for step in case.steps()}
    for address, values in case.recipe.options.items():
        must(address in steps, f"it sets options of {address}, which is none of its steps")
        validate(steps[address], values, address)


def measures(case: RecipeCase) -> None:
    """Check that the kit's ellipsoid gets its volume (and area, when the method has one)."""
    steps = case.steps()
    kinds = [kind for kind in (Segmentation, ContourStack, TriMesh) if kind in steps[0].plugin.accepts]
    must(kinds, f"it starts from {steps[0].plugin.accepts}, which no run comes to")
    product = ellipsoids.MAKERS[kinds[0]](3)
    for step in steps:
        values = validate(step.plugin, case.recipe.options.get(step.key, {}), step.key)
        product = getattr(step.plugin(**values), RUN[step.family])(product)
    for name, exact, tolerance in (
        ("volume", ellipsoids.VOLUME, case.volume_tolerance),
        ("area", ellipsoids.AREA, case.area_tolerance),
    ):
        found = getattr(product, name)
        off = 0.0 if found is None else found / exact - 1.0
        must(abs(off) <= tolerance, f"the ellipsoid's {name} is {off:+.1%} off")


CHECKS = {"plugin-shape": shape, "chain": chain, "options": options, "measures": measures}


def recipe_checks(case: RecipeCase, expected_failures: Mapping[str, str] | None = None) -> list[Check]:
    """Return the checks of one recipe (as for the other families)."""
    return suite(CHECKS, case, expected_failures or {})
