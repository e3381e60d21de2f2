"""Which versions made the figures, and how long each stage took."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from typing import Any

from stackloft.pipeline.plan import Plan

NUMERICS = ("numpy", "scipy")


version_of = cache(version)
"""Version of an installed distribution; its metadata is read once per process."""


def provenance_of(plan: Plan, seconds: Mapping[str, float]) -> dict[str, Any]:
    """Return ``versions`` (by distribution), ``seconds`` (by stage) and stackloft's own version."""
    own = version_of("stackloft")
    plugins = {step.loaded.listing.distribution: step.loaded.listing.version for step in plan.steps()}
    numerics = {name: version_of(name) for name in NUMERICS}
    versions = {"python": platform.python_version(), "stackloft": own, **numerics, **plugins}
    return {"versions": versions, "seconds": dict(seconds), "stackloft": own}
