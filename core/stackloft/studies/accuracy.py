"""Every installed method on every body, along every axis, against exact answers.

A plug-in takes part by being installed: the study asks the registry for all methods, and one that cannot
take a body is a row with its reason.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stackloft.model.errors import StackloftError
from stackloft.model.measurement import Integral
from stackloft.pipeline.figures import method_row
from stackloft.pipeline.plan import Method, make_plan, method_names
from stackloft.pipeline.progress import Progress, Silence
from stackloft.pipeline.request import ALL_METHODS, MeasureRequest
from stackloft.pipeline.workbench import Workbench
from stackloft.registry import Loaded, catalogue, fields_of, load
from stackloft.studies.accuracy_axes import AXES, FULL, REFINED, Case, Levels, cases, subject_of
from stackloft.studies.accuracy_bodies import BODIES, AccuracyBody
from stackloft.studies.accuracy_table import (
    NOT_APPLICABLE,
    Accuracy,
    AccuracyRow,
    ObservedOrder,
    observed_order,
)
from stackloft.studies.theory import expected_volume_error, order_of


@dataclass(frozen=True, slots=True)
class AccuracyRequest:
    """What is studied."""

    bodies: tuple[AccuracyBody, ...] = BODIES
    axes: tuple[str, ...] = AXES
    levels: Levels = FULL
    methods: tuple[str, ...] = (ALL_METHODS,)
    """Recipes by name; ``all``: every one that is installed."""


def study_accuracy(
    request: AccuracyRequest | None = None,
    *,
    progress: Progress | None = None,
    tell: Callable[[Sequence[AccuracyRow]], None] | None = None,
) -> Accuracy:
    """Return the errors of the methods on the bodies.

    Parameters
    ----------
    request : AccuracyRequest, optional
        None: everything.
    progress : Progress, optional
        Told after each body.
    tell : callable, optional
        Given the rows of each body once they are there.

    Raises
    ------
    UsageError
        A method that is not installed.

    Examples
    --------
    >>> from stackloft.studies.accuracy_axes import QUICK
    >>> from stackloft.studies.accuracy_bodies import BODIES
    >>> found = study_accuracy(AccuracyRequest(BODIES[:1], ("sections",), QUICK, ("cavalieri",)))
    >>> [round(row.volume_error * row.value**2, 3) for row in found.rows]  # % × m²: 100/2
    [50.0, 50.0]
    """
    asked = request or AccuracyRequest()
    listener = progress or Silence()
    listener.begin("bodies", len(asked.bodies))
    rows: list[AccuracyRow] = []
    orders: list[ObservedOrder] = []
    for body in asked.bodies:
        found = list(_rows(body, asked))
        rows += found
        orders += _orders(found, body)
        if tell is not None:
            tell(found)
        listener.advance()
    listener.end()
    return _in_order(rows, orders)


def _in_order(rows: Sequence[AccuracyRow], orders: Sequence[ObservedOrder]) -> Accuracy:
    """Return the study by method as the registry lists them, then by axis, then by body."""
    methods = dict.fromkeys(row.method for row in rows)
    keys = ((method, axis) for method in methods for axis in AXES)
    rank = {key: number for number, key in enumerate(keys)}
    return Accuracy(
        tuple(sorted(rows, key=lambda row: rank[row.method, row.axis])),
        tuple(sorted(orders, key=lambda order: rank[order.method, order.axis])),
    )


def _rows(body: AccuracyBody, asked: AccuracyRequest) -> Iterator[AccuracyRow]:
    subject = subject_of(body)
    for axis in asked.axes:
        for one in cases(body, axis, asked.levels, subject):
            yield from run_case(one, asked.methods)


def run_case(one: Case, methods: Sequence[str] = (ALL_METHODS,)) -> tuple[AccuracyRow, ...]:
    """Return a row of `one` for each of `methods`; each takes the first product that it can start from."""
    names = studied_methods() if ALL_METHODS in methods else tuple(methods)
    rows: dict[str, AccuracyRow] = {}
    for make in one.products:
        left = [name for name in names if name not in rows or rows[name].failure is not None]
        if left:
            rows |= _run(one, make, left)
    return tuple(rows[name] for name in names if name in rows)


def studied_methods() -> tuple[str, ...]:
    """Return the methods studied when none is named: all but those that take long for each body."""
    slow = {
        loaded.listing.qualified if loaded.listing.clash else loaded.name
        for loaded in map(load, catalogue("recipe"))
        if isinstance(loaded, Loaded) and loaded.plugin.slow
    }
    return tuple(name for name in method_names(ALL_METHODS) if name not in slow)


def _run(one: Case, make: Callable[[], Any], names: Sequence[str]) -> Mapping[str, AccuracyRow]:
    """Run methods on one product; what they have in common is made once."""
    try:
        product = make()
    except StackloftError as error:
        return {name: replace(_plain(one, name), failure=str(error)) for name in names}
    plan = make_plan(MeasureRequest(Path(one.body.label), method=ALL_METHODS, shared=one.shared), product)
    planned = {method.name: method for method in plan.methods}
    bench = Workbench(plan, product, Silence())
    return {name: _row(one, planned[name], bench) for name in names if name in planned}


def _plain(one: Case, method: str) -> AccuracyRow:
    return AccuracyRow(method, one.body.label, one.axis, one.value, one.step)


def _row(one: Case, method: Method, bench: Workbench) -> AccuracyRow:
    """Return the row of one method; a failure is its reason."""
    plain = _plain(one, method.name)
    if one.axis == "points" and not _takes_points(method):
        return replace(plain, failure=f"{NOT_APPLICABLE}: it takes no contours, or has no option points")
    start = time.perf_counter()
    try:
        if method.error is not None:
            raise method.error
        integral: Integral = bench.run(method.steps)[0]
        method_row(method.name, integral, 0.0)  # refuses what cannot be true
    except StackloftError as error:
        return replace(plain, failure=str(error))
    return replace(
        plain,
        volume_error=_percent(integral.volume, one.phantom.volume),
        area_error=_percent(integral.area, one.phantom.area),
        expected_volume_error=expected_volume_error(method.name, one.axis, one.body, one.value),
        seconds=time.perf_counter() - start,
    )


def _takes_points(method: Method) -> bool:
    return any(item.name == "points" for step in method.steps for item in fields_of(step.loaded.plugin))


def _percent(value: float | None, exact: float) -> float | None:
    return None if value is None else (value / exact - 1.0) * 100.0


def _orders(rows: Sequence[AccuracyRow], body: AccuracyBody) -> Iterator[ObservedOrder]:
    """Yield the order of each method along each axis that is refined."""
    for method, axis in dict.fromkeys((row.method, row.axis) for row in rows if row.axis in REFINED):
        mine = [row for row in rows if (row.method, row.axis) == (method, axis)]
        if all(row.failure is not None for row in mine):
            continue
        steps = [row.step for row in mine]
        yield ObservedOrder(
            method, body.label, axis,
            observed_order(steps, [row.volume_error for row in mine]),
            observed_order(steps, [row.area_error for row in mine]),
            order_of(method, axis, body.ending),
        )  # fmt: skip
