"""The built-in methods."""

from __future__ import annotations

from stackloft.contracts.recipe import Recipe

loft = Recipe(
    steps=("reconstructor.loft", "integrator.surface-gauss"),
    summary="B-spline loft through the sections, closed at its ends, integrated by the divergence theorem; "
    "assumes a surface that is smooth across sections",
)

cavalieri = Recipe(
    steps=("integrator.cavalieri",),
    summary="section areas times pitch; volume only; with sections at mid-thickness high by 1/(2m²) "
    "on an ellipsoid of m sections",
)

frustum = Recipe(
    steps=("integrator.frustum",),
    summary="conical frusta between neighbouring sections (Sabliov et al. 2002; Zheng & Sun 2006); "
    "sees no more than each section's area and perimeter",
)
