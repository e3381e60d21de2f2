"""A run over every body of a scan: the same request, one body after the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from stackloft.contracts.sink import Sink
from stackloft.model.errors import StackloftError
from stackloft.model.measurement import Measurement
from stackloft.model.notices import Notice
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.progress import Progress
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.sectioning.object_choice import KIND, LARGEST, OBJECT, OBJECTS

ALL = "all"
_SINGLE = "several-objects"
"""The notice that other bodies are there; out of place when they are measured."""


def measure_objects(
    request: MeasureRequest,
    *,
    progress: Progress | None = None,
    sinks: Sequence[Sink] = (),
    product: Any = None,
) -> Outcome:
    """Measure what `request` names; with ``object = "all"`` among its general flags, every body of a scan.

    Parameters
    ----------
    request, progress, sinks, product
        As for `stackloft.pipeline.run.measure`.

    Returns
    -------
    Outcome
        Of the largest body, with the figures of all in ``result.objects``: by size, or by label.

    Raises
    ------
    StackloftError
        The largest body cannot be measured; another one that cannot is a warning.

    Examples
    --------
    >>> from pathlib import Path
    >>> measure_objects(MeasureRequest(Path("no-such-folder")))
    Traceback (most recent call last):
    stackloft.model.errors.InputError: no-such-folder: no such file or folder
    """
    if request.shared.get("object") != ALL:
        return measure(request, progress=progress, sinks=sinks, product=product)
    first = measure(_asking(request, LARGEST), progress=progress, sinks=sinks, product=product)
    told = _told(first)
    names = [name for name in told.get(OBJECTS, "").split(",") if name]
    measured: dict[str, Measurement] = {told.get(OBJECT, ""): first.result.objects[0]}
    warnings = [notice for notice in first.result.warnings if notice.code != _SINGLE]
    for name in names:
        if name in measured:
            continue
        try:
            other = measure(_asking(request, name), progress=progress, product=product).result
        except StackloftError as error:
            warnings.append(Notice("object-failed", f"object {name} is not measured: {error}"))
            continue
        measured[name] = other.objects[0]
        warnings += [
            Notice(each.code, f"object {name}: {each.message}") for each in _own(other.warnings, warnings)
        ]
    if not names:
        return first
    kind = told.get(KIND)
    objects = tuple(
        replace(measured[name], id=number, label=f"{kind} {name}" if kind else None)
        for number, name in enumerate(names, start=1)
        if name in measured
    )
    return replace(first, result=replace(first.result, objects=objects, warnings=tuple(warnings)))


def _told(outcome: Outcome) -> Mapping[str, str]:
    """Return what the run says of the bodies that are there."""
    if outcome.segmentation is not None:
        return outcome.segmentation.stack.provenance
    return outcome.contours.provenance if outcome.contours is not None else {}


def _asking(request: MeasureRequest, name: str) -> MeasureRequest:
    return replace(request, shared={**request.shared, "object": name})


def _own(warnings: Sequence[Notice], known: Sequence[Notice]) -> list[Notice]:
    """Return the warnings that are about this body alone."""
    return [notice for notice in warnings if notice not in known and notice.code != _SINGLE]
