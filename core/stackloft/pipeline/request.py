"""What is asked for in one run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

DEFAULT_METHOD = "loft"
"""The method used when nobody names one, and the primary one of ``all``."""

SURFACE_METHOD = "polyhedral"
"""The method used when nobody names one and what is read is a surface, which has no sections."""

ALL_METHODS = "all"


@dataclass(frozen=True, slots=True)
class MeasureRequest:
    """A run of `stackloft.pipeline.run.measure`.

    An option of a plug-in is looked up in this order, later ones winning: its default, the method's
    own `Recipe.options`, `base`, `shared`, `settings`.

    Examples
    --------
    >>> request = MeasureRequest(Path("apple"), shared={"pixel_size": "0.3mm"},
    ...                          settings={"segmenter": {"threshold": "isodata"}})
    >>> request.shared["pixel_size"]
    '0.3mm'
    """

    source: Path
    """File or folder."""
    reader: str | None = None
    """Reader by name; None: the one whose probe knows the source."""
    segmenter: str | None = None
    """Segmenter by name; None: the one that fits what was read."""
    method: str | None = None
    """A recipe's name, several with commas (the first is the primary one), or ``all``; None: ``loft``, or
    ``polyhedral`` when what is read is a surface."""
    settings: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Options by ``family``, ``name`` or ``family.name`` (the more particular wins); text or typed values."""
    shared: Mapping[str, Any] = field(default_factory=dict)
    """General flags (``pixel_size``, ``thickness``, ``ends``, ``points``, …) for every plug-in of the
    chain that has such an option; one that none has is an error."""
    base: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Options of a recipe file, keyed as `settings`; everything else said in the request wins."""
