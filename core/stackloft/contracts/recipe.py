"""A method: a named chain of plug-ins from a product to figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from stackloft.model.bias import Bias


@dataclass(frozen=True, slots=True)
class Recipe:
    """A named method.

    Examples
    --------
    >>> Recipe(steps=("reconstructor.loft", "integrator.surface-gauss"), summary="loft, Gauss").steps[-1]
    'integrator.surface-gauss'
    """

    steps: tuple[str, ...]
    """``family.name`` of each plug-in in order; the last is an integrator."""
    summary: str
    """One sentence for people: what is done, what it assumes, which way it errs."""
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Options that this method sets, by ``family.name``; the person's own settings win."""
    volume_bias: Bias | None = None
    """Where its volumes may lie, by what is known of the method; None: it has no say when methods differ."""
    area_bias: Bias | None = None
    """Likewise for its areas. What an integrator says of one body (`Integral`) wins."""
    slow: bool = False
    """Takes minutes for a body: ``all`` and studies of many bodies have it only when it is named."""
    api: str = "1"
