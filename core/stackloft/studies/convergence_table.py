"""What a study of convergence finds: models with fewer points or sections, held against the whole one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from stackloft.model.notices import Notice

SCHEMA = "stackloft.convergence/1"


@dataclass(frozen=True, slots=True)
class Model:
    """One reconstruction of the body."""

    sections: int
    points: int | None
    """Per section; None when the method knows no points."""
    volume: float | None = None
    """mm³"""
    area: float | None = None
    """mm²"""
    volume_error: float | None = None
    """% of the reference's, signed."""
    area_error: float | None = None
    """% of the reference's, signed."""
    failure: str | None = None
    """Why it could not be made."""

    def within(self, tolerance: float) -> bool:
        """Tell whether both figures are within `tolerance` % of the reference's."""
        errors = [error for error in (self.volume_error, self.area_error) if error is not None]
        return self.failure is None and all(abs(error) <= tolerance for error in errors)


@dataclass(frozen=True, slots=True)
class Convergence:
    """A body's figures by number of points and of sections."""

    source: str
    method: str
    reference: Model
    """All sections, 400 points."""
    by_points: tuple[Model, ...]
    """All sections, points increasing; empty when the method knows no points."""
    by_sections: tuple[Model, ...]
    """The reference's points, sections increasing."""
    warnings: tuple[Notice, ...] = ()

    def suffices(self, tolerance: float) -> tuple[int | None, int | None]:
        """Return the fewest points and the fewest sections from which on V and S stay within `tolerance` %.

        None where the method knows no points, or where the reference alone does it.

        Examples
        --------
        >>> errors = {2: 9.0, 3: 0.4, 4: 0.6, 5: 0.1, 6: 0.0}
        >>> rows = [Model(n, None, 1.0, 1.0, e, e) for n, e in errors.items()]
        >>> Convergence("x", "loft", rows[-1], (), tuple(rows)).suffices(0.5)
        (None, 5)
        """
        points = _settled(self.by_points, tolerance)
        sections = _settled(self.by_sections, tolerance)
        return (points.points if points else None), (sections.sections if sections else None)

    def as_json(self, tolerance: float | None = None) -> dict[str, Any]:
        """Return everything in JSON's types; with `tolerance` (%) also what suffices for it."""
        units = {"volume": "mm^3", "area": "mm^2", "volume_error": "%", "area_error": "%"}
        found: dict[str, Any] = {"schema": SCHEMA, "units": units, **asdict(self)}
        if tolerance is not None:
            points, sections = self.suffices(tolerance)
            found["suffices"] = {"tolerance": tolerance, "points": points, "sections": sections}
        return found


def _settled(rows: Sequence[Model], tolerance: float) -> Model | None:
    """Return the first model within `tolerance` with all that follow; the reference alone does not count."""
    first = len(rows)
    while first > 0 and rows[first - 1].within(tolerance):
        first -= 1
    return rows[first] if first < len(rows) - 1 else None
