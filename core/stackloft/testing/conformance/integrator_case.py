"""One integrator, and what the kit may ask of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from stackloft.model.measurement import Integral
from stackloft.registry.options_model import validate
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.check import must


@dataclass(frozen=True, slots=True)
class IntegratorCase:
    """One integrator and what may be asked of it."""

    integrator: type[Any]
    options: Mapping[str, Any] = field(default_factory=dict)
    exactness: float = 1e-9
    """Relative change allowed where nothing should change."""
    volume_tolerance: float = 0.01
    """Relative error allowed at the finest resolution."""
    area_tolerance: float = 0.02

    def integrate(self, product: Any) -> Integral:
        """Return the figures of `product`."""
        values = validate(self.integrator, self.options, self.integrator.__name__)
        integral: Integral = self.integrator(**values).integrate(product)
        return integral

    def figures(self, product: Any) -> tuple[float | None, float | None]:
        """Return volume and area of `product`."""
        integral = self.integrate(product)
        return integral.volume, integral.area

    def bodies(self, fineness: int = 2) -> list[Any]:
        """Return the ellipsoid as each product type that the integrator accepts and the kit can make."""
        fitting = [make for kind, make in ellipsoids.MAKERS.items() if kind in self.integrator.accepts]
        must(fitting, f"the kit has no body of a type in {self.integrator.accepts}")
        return [make(fineness) for make in fitting]
