"""The rows of an accuracy study, the orders seen in them, and what they come to for each method and axis."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

SCHEMA = "stackloft.accuracy/1"
NOT_APPLICABLE = "not applicable"
"""How the reason of a row begins whose method has no such axis; it is no failure."""
ROUNDING = 1e-9
"""%: errors below it are rounding and show no order."""


@dataclass(frozen=True, slots=True)
class AccuracyRow:
    """One method on one body at one value of an axis."""

    method: str
    body: str
    axis: str
    value: int
    step: float
    """What goes to zero (`stackloft.studies.accuracy_axes.Case`)."""
    volume_error: float | None = None
    """%, signed, against the exact answer."""
    area_error: float | None = None
    """%, signed."""
    expected_volume_error: float | None = None
    """%, where theory fixes it."""
    seconds: float = 0.0
    failure: str | None = None
    """Why there are no figures."""

    @property
    def applicable(self) -> bool:
        """Whether the method has this axis at all."""
        return self.failure is None or not self.failure.startswith(NOT_APPLICABLE)


@dataclass(frozen=True, slots=True)
class ObservedOrder:
    """How fast a method converges on a body: error ~ step^order, by least squares in logarithms."""

    method: str
    body: str
    axis: str
    volume: float | None
    """None: fewer than two errors above rounding."""
    area: float | None
    theory: float | None
    """What theory gives for the volume."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A method along one axis, over all bodies, at the finest value (all values for poses)."""

    method: str
    axis: str
    measured: int
    """Cases with figures."""
    failed: int
    volume_rms: float | None
    """%"""
    volume_worst: float | None
    """%"""
    area_rms: float | None
    area_worst: float | None
    volume_order: float | None
    """Median over bodies."""
    area_order: float | None
    theory: float | None
    """Median over bodies of the volume's theoretical order."""


@dataclass(frozen=True, slots=True)
class Accuracy:
    """A whole study."""

    rows: tuple[AccuracyRow, ...]
    orders: tuple[ObservedOrder, ...]

    def summaries(self) -> tuple[Summary, ...]:
        """Return one line for each method and axis, in the order in which they were run."""
        keys = dict.fromkeys((row.method, row.axis) for row in self.rows)
        return tuple(self._summary(method, axis) for method, axis in keys)

    def failures(self) -> dict[tuple[str, str], list[AccuracyRow]]:
        """Return the rows without figures by method and reason."""
        found: dict[tuple[str, str], list[AccuracyRow]] = {}
        for row in self.rows:
            if row.failure is not None and row.applicable:
                found.setdefault((row.method, row.failure), []).append(row)
        return found

    def as_json(self) -> dict[str, Any]:
        """Return everything in JSON's types."""
        return {
            "schema": SCHEMA,
            "units": {"volume_error": "%", "area_error": "%", "seconds": "s"},
            "summaries": [asdict(line) for line in self.summaries()],
            "orders": [asdict(order) for order in self.orders],
            "rows": [asdict(row) for row in self.rows],
        }

    def _summary(self, method: str, axis: str) -> Summary:
        mine = [row for row in self.rows if (row.method, row.axis) == (method, axis)]
        last = [row for row in mine if axis == "pose" or row.value == mine[-1].value]
        orders = [order for order in self.orders if (order.method, order.axis) == (method, axis)]
        volumes = [row.volume_error for row in last]
        areas = [row.area_error for row in last]
        failed = [row for row in mine if row.failure is not None and row.applicable]
        return Summary(
            method, axis, sum(row.failure is None for row in mine), len(failed),
            _rms(volumes), _worst(volumes), _rms(areas), _worst(areas),
            _median(order.volume for order in orders), _median(order.area for order in orders),
            _median(order.theory for order in orders),
        )  # fmt: skip


def finest(rows: Sequence[AccuracyRow]) -> Iterator[AccuracyRow]:
    """Yield the last row of each method, body and axis; of poses the one with the largest volume error."""
    groups: dict[tuple[str, str, str], list[AccuracyRow]] = {}
    for row in rows:
        groups.setdefault((row.method, row.body, row.axis), []).append(row)
    for (_, _, axis), group in groups.items():
        yield max(group, key=lambda row: abs(row.volume_error or 0.0)) if axis == "pose" else group[-1]


def observed_order(steps: Sequence[float], errors: Sequence[float | None]) -> float | None:
    """Return p of error ~ step^p by least squares in logarithms, None when it cannot be seen.

    Parameters
    ----------
    steps : sequence of float
        Positive, decreasing under refinement.
    errors : sequence of float or None
        %, signed; those within rounding or missing say nothing.

    Examples
    --------
    >>> round(observed_order([1 / 7, 1 / 14, 1 / 28], [4.9, -1.225, 0.30625]), 6)
    2.0
    """
    seen = [
        (step, abs(error))
        for step, error in zip(steps, errors, strict=True)
        if error is not None and abs(error) > ROUNDING
    ]
    if len({step for step, _ in seen}) < 2:
        return None
    x, y = np.log(np.array(seen)).T
    x = x - x.mean()
    return float(x @ (y - y.mean()) / (x @ x))


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _rms(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return float(np.sqrt(np.mean(np.square(known)))) if known else None


def _worst(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return max(map(abs, known)) if known else None


def _median(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return float(np.median(known)) if known else None
