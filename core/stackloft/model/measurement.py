"""What is handed to the person: figures with their uncertainty, method and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from stackloft.model.bias import Bias
from stackloft.model.notices import Notice


@dataclass(frozen=True, slots=True)
class Figure:
    """One measured quantity."""

    value: float
    unit: str
    """``mm^3`` or ``mm^2``"""
    method: str
    standard_uncertainty: float | None = None
    interval95: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Integral:
    """What an integrator returns; a quantity it cannot give is None."""

    volume: float | None
    """mm³"""
    area: float | None
    """mm²"""
    notices: tuple[Notice, ...] = ()
    volume_uncertainty: float | None = None
    """mm³: standard uncertainty of the volume, where the method itself tells one."""
    area_uncertainty: float | None = None
    """mm²: likewise of the area."""
    volume_bias: Bias | None = None
    """Where the volume may lie, when this body tells more than the method in general (`Recipe`)."""
    area_bias: Bias | None = None
    """Likewise for the area."""
    details: Mapping[str, float] = field(default_factory=dict)
    """What else the method found, by name (``coefficient_of_error`` 1, ``smoothness`` 1, …)."""


@dataclass(frozen=True, slots=True)
class MethodRow:
    """One method's outcome on one object; failures are rows with their reason."""

    volume: Figure | None
    area: Figure | None
    seconds: float
    error: str | None = None


@dataclass(frozen=True, slots=True)
class EndReport:
    """How an end was closed, and why so."""

    kind: str
    length: float
    """mm beyond the outermost section"""
    reason: str
    guessed: bool = False
    volume_effect: float | None = None
    """mm³: half the difference between flat and closed, when the position was guessed."""
    area_effect: float | None = None
    """mm²: likewise for the area."""


@dataclass(frozen=True, slots=True)
class SectionRow:
    """One section's own figures."""

    index: int
    z: float
    area: float
    perimeter: float
    centroid: tuple[float, float]
    loops: int
    holes: int


@dataclass(frozen=True, slots=True)
class Measurement:
    """One object's figures."""

    id: int
    volume: Figure
    area: Figure | None
    """None when the primary method gives a volume alone (cavalieri)."""
    label: str | None = None
    methods: Mapping[str, MethodRow] = field(default_factory=dict)
    derived: Mapping[str, float | None] = field(default_factory=dict)
    """equivalent_diameter mm, sphericity 1, specific_surface 1/mm, density g/cm³ or None"""
    uncertainty_budget: tuple[Mapping[str, Any], ...] = ()
    ends: tuple[EndReport, ...] = ()
    sections: tuple[SectionRow, ...] = ()
    mesh: Mapping[str, Any] | None = None


@dataclass(frozen=True, slots=True)
class Result:
    """A run's outcome: what ``measurement.json`` holds."""

    source: Mapping[str, str]
    """path, reader, digest"""
    objects: tuple[Measurement, ...]
    warnings: tuple[Notice, ...] = ()
    recipe: Mapping[str, Any] = field(default_factory=dict)
    provenance: Mapping[str, Any] = field(default_factory=dict)
