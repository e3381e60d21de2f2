"""How volume and area settle as boundary points and sections are added.

Goñi, Purlis & Salvadori (2007), Figures 6 to 8: one body, lofted again and again; the model with all sections
and 400 points each is what the others are held against. It says how far the figures still move, not how far
they are from the truth: what all models share (scale, threshold, the shape of the ends) stays in all of them.
The stack is decoded once; only the chosen method runs again.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError, StackloftError, UsageError
from stackloft.model.measurement import Integral
from stackloft.model.notices import Notice
from stackloft.pipeline.plan import Method, Plan, Step, make_plan
from stackloft.pipeline.progress import Progress, Silence
from stackloft.pipeline.request import DEFAULT_METHOD, MeasureRequest
from stackloft.pipeline.workbench import Workbench, guarded
from stackloft.registry import fields_of, instantiate
from stackloft.studies.bisection import bisection_order, section_counts
from stackloft.studies.convergence_table import Convergence, Model

POINTS = (5, 7, 9, 11, 13, 17, 21, 25, 29, 33, 45, 65, 91, 129, 181, 257, 400)
"""Boundary points per section; the last is the reference's."""


def convergence(
    source: Any,
    method: str = DEFAULT_METHOD,
    *,
    reader: str | None = None,
    segmenter: str | None = None,
    settings: Mapping[str, Mapping[str, Any]] | None = None,
    **options: Any,
) -> Convergence:
    """Return how volume and area of a file, a folder or a product settle with points and sections.

    Parameters
    ----------
    source : path or product
        As for `stackloft.measure`.
    method : str
        One method that starts from sections.
    reader, segmenter, settings, **options
        As for `stackloft.measure`.

    Raises
    ------
    StackloftError
        The source cannot be measured with all its sections and 400 points.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> found = convergence(phantoms.make("ellipsoid").contour_stack(sections=9, points=60))
    >>> found.suffices(1.0)
    (7, 4)
    """
    is_path = isinstance(source, (str, os.PathLike))
    name = Path(source) if is_path else Path(type(source).__name__)
    request = MeasureRequest(name, reader, segmenter, method, settings or {}, options)
    return study_convergence(request, product=None if is_path else source)


def study_convergence(
    request: MeasureRequest, *, product: Any = None, progress: Progress | None = None
) -> Convergence:
    """Run the study that `request` names (errors as for `convergence`)."""
    listener = progress or Silence()
    plan = make_plan(request, product)
    steps = _steps(plan)
    contours = _contours(plan, request, product, listener)
    if len(contours) < 2:
        raise InputError(
            "a study needs at least 2 sections", where=str(request.source), found=str(len(contours))
        )
    lofted = _Evaluator(plan.methods[0].name, steps)
    most = POINTS[-1] if lofted.knows_points else None
    whole = lofted.integral(contours, most)
    notices = tuple(dict.fromkeys([*plan.notices, *lofted.notices]))
    reference = _held_against(whole, Model(len(contours), most, whole.volume, whole.area))
    listener.begin("convergence", None)
    by_points = _by_points(lofted, contours, reference, listener) if most else ()
    by_sections = _by_sections(lofted, contours, reference, listener)
    listener.end()
    return Convergence(str(request.source), lofted.name, reference, by_points, by_sections, notices)


def _steps(plan: Plan) -> tuple[Step, ...]:
    """Return the steps of the one method, which must start from sections."""
    method = plan.methods[0]
    if len(plan.methods) > 1:
        raise UsageError("a study follows one method", where="--method", fix=f"--method {method.name}")
    if not any(issubclass(ContourStack, kind) for kind in method.steps[0].loaded.plugin.accepts):
        raise UsageError(
            "the study needs a method that starts from sections", where=f"--method {method.name}",
            found=f"{method.steps[0].key}, which does not take them", fix="--method loft",
        )  # fmt: skip
    return method.steps


def _contours(plan: Plan, request: MeasureRequest, product: Any, listener: Progress) -> ContourStack:
    """Return the sections, from one decoding pass."""
    if plan.reader is not None:
        product = guarded(plan.reader.loaded, plan.reader.instance.read, request.source)
    contours = Workbench(plan, product, listener).contours()
    if contours is None:
        raise InputError(
            "has no sections to leave out", where=str(request.source), found=type(product).__name__
        )
    return contours


class _Evaluator:
    """Runs one method on sections, with any number of points."""

    def __init__(self, name: str, steps: Sequence[Step]) -> None:
        self.name = name
        self._steps = tuple(steps)
        self._pointed = [any(item.name == "points" for item in fields_of(x.loaded.plugin)) for x in steps]
        self.knows_points = any(self._pointed)
        self.notices: tuple[Notice, ...] = ()
        """What the last run noticed, the sections' own notices included."""

    def integral(self, contours: ContourStack, points: int | None) -> Integral:
        """Return what the method makes of `contours`; an integrator's failure is a StackloftError."""
        steps = [
            _with_points(step, points) if pointed and points is not None else step
            for step, pointed in zip(self._steps, self._pointed, strict=True)
        ]
        bench = Workbench(Plan(None, None, (Method(self.name, tuple(steps)),)), contours, Silence())
        integral: Integral = bench.run(steps)[0]
        self.notices = tuple(
            notice for made in bench.made.values() for notice in getattr(made, "notices", ())
        )
        return integral


def _with_points(step: Step, points: int) -> Step:
    options = {**step.options, "points": points}
    return replace(step, options=options, instance=instantiate(step.loaded, options))


def _by_points(
    lofted: _Evaluator, contours: ContourStack, reference: Model, listener: Progress
) -> tuple[Model, ...]:
    def model(points: int) -> Model:
        listener.advance()
        return _model(lofted, contours, Model(len(contours), points), reference)

    return (*(model(points) for points in POINTS[:-1]), reference)


def _by_sections(
    lofted: _Evaluator, contours: ContourStack, reference: Model, listener: Progress
) -> tuple[Model, ...]:
    order = bisection_order(contours.positions)

    def model(count: int) -> Model:
        listener.advance()
        kept = tuple(contours.sections[k] for k in sorted(order[:count]))
        return _model(lofted, replace(contours, sections=kept), Model(count, reference.points), reference)

    return (*(model(count) for count in section_counts(len(contours))[:-1]), reference)


def _model(lofted: _Evaluator, contours: ContourStack, empty: Model, reference: Model) -> Model:
    """Return `empty` with its figures, or with the reason why there are none."""
    try:
        found = lofted.integral(contours, empty.points)
    except StackloftError as error:
        return replace(empty, failure=str(error))
    return _held_against(found, replace(empty, volume=found.volume, area=found.area), reference)


def _held_against(found: Integral, model: Model, reference: Model | None = None) -> Model:
    whole = reference or model
    return replace(
        model,
        volume_error=_percent(found.volume, whole.volume),
        area_error=_percent(found.area, whole.area),
    )


def _percent(value: float | None, whole: float | None) -> float | None:
    return None if value is None or not whole else (value / whole - 1.0) * 100.0
