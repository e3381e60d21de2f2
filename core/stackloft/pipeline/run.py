r"""A run: read, section, reconstruct, integrate, hand over.

::

    source --reader--> product --(segmenter, one decoding pass)--> contours
                          \--> steps of each method --> integral --> Measurement
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from stackloft.contracts.sink import Sink
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import StackloftError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Integral, Measurement, MethodRow, Result, SectionRow
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Hints, SliceStack
from stackloft.model.tet_mesh import TetMesh, mesh_entry
from stackloft.pipeline.agreement import disagreements
from stackloft.pipeline.blame import guarded
from stackloft.pipeline.digest import DigestMeanwhile, PictureDigest, digest_of_value
from stackloft.pipeline.figures import derived_figures, method_row, require_volume
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.plan import Method, Plan, make_plan
from stackloft.pipeline.progress import Progress, Silence
from stackloft.pipeline.provenance import provenance_of
from stackloft.pipeline.recipe_file import recipe_of
from stackloft.pipeline.request import ALL_METHODS, MeasureRequest
from stackloft.pipeline.section_rows import section_rows
from stackloft.pipeline.suspects import with_suspects
from stackloft.pipeline.workbench import Workbench


def measure(
    request: MeasureRequest,
    *,
    progress: Progress | None = None,
    sinks: Sequence[Sink] = (),
    product: Any = None,
) -> Outcome:
    """Measure what `request` names.

    Parameters
    ----------
    request : MeasureRequest
        Source, reader, method and options.
    progress : Progress, optional
        Told about each stage.
    sinks : sequence of Sink
        Fed with every slice in the one decoding pass; not called when the source has no slices.
    product : object, optional
        A product already read; ``request.source`` is then only its name.

    Raises
    ------
    StackloftError
        The source cannot be measured by the primary method, or the request makes no sense.

    Examples
    --------
    >>> from pathlib import Path
    >>> measure(MeasureRequest(Path("no-such-folder")))
    Traceback (most recent call last):
    stackloft.model.errors.InputError: no-such-folder: no such file or folder
    """
    start = time.perf_counter()
    listener = progress or Silence()
    plan = make_plan(request, product)
    with _reading(plan, request, product, listener) as reading:
        bench = Workbench(plan, reading.product, listener, sinks)
        rows, measured = _run_methods(plan.methods, bench, every=request.method == ALL_METHODS)
        sections, skipped = _sections(bench)
        body = _measurement(rows, measured, sections, reading.product)
        digest = reading.digest()
    products = _in_order(measured, bench)
    again = replace(plan, methods=tuple(sorted(plan.methods, key=lambda x: x.name != body.volume.method)))
    seconds = {**reading.seconds, **bench.stages, "total": time.perf_counter() - start}
    result = Result(
        source={"path": str(request.source), "reader": reading.name, "digest": digest},
        objects=(body,),
        warnings=_warnings(plan, products, (*skipped, *measured.notices, *disagreements(measured.found))),
        recipe=recipe_of(again, segmented=any(isinstance(item, Segmentation) for item in products)),
        provenance=provenance_of(plan, seconds),
    )
    return Outcome(result, products, bench.sink_products)


@dataclass(frozen=True, slots=True)
class _Reading:
    product: Any
    name: str
    digest: Callable[[], str]
    """Returns the source's fingerprint, once the run is through with it."""
    seconds: dict[str, float]


@dataclass(frozen=True, slots=True)
class _Measured:
    """The primary method's products by identity, for the order of products and the ends."""

    identities: tuple[str, ...]
    solid: LoftedSolid | None
    mesh: TetMesh | None = None
    found: tuple[tuple[Method, Integral], ...] = ()
    """Every method's figures as its integrator gave them, for comparing them."""
    notices: tuple[Notice, ...] = ()


@contextmanager
def _reading(plan: Plan, request: MeasureRequest, product: Any, progress: Progress) -> Iterator[_Reading]:
    """Give what the run starts from; the fingerprint of files is taken meanwhile, from their headers on."""
    if plan.reader is None:
        yield _in_memory(product)
        return
    with DigestMeanwhile(request.source) as meanwhile:
        progress.begin("read", None)
        start = time.perf_counter()
        try:
            found = guarded(plan.reader.loaded, plan.reader.instance.read, request.source)
        finally:
            progress.end()
        seconds = {"read": time.perf_counter() - start}

        def digest() -> str:
            value = meanwhile.value()
            seconds["digest"] = meanwhile.seconds
            return value

        yield _Reading(found, plan.reader.loaded.name, digest, seconds)


def _in_memory(product: Any) -> _Reading:
    if not isinstance(product, (SliceStack, Segmentation)):
        return _Reading(product, "python", lambda: digest_of_value(product), {})
    seen = PictureDigest()
    return _Reading(seen.tapped(product), "python", lambda: seen.value(product), {})


def _run_methods(
    methods: Sequence[Method], bench: Workbench, *, every: bool
) -> tuple[dict[str, MethodRow], _Measured]:
    """Return every method's row, the primary one first.

    The primary method is the first one asked for, and its failure is raised; when `every` method was asked
    for it is the first that gives both figures (or a volume at least), and only the failure of all is raised.
    """
    rows: dict[str, MethodRow] = {}
    works: dict[str, list[str]] = {}
    errors: list[StackloftError] = []
    for method in methods:
        try:
            rows[method.name], works[method.name] = _run_method(method, bench)
        except StackloftError as error:
            errors.append(error)
            if (not every and not rows) or len(errors) == len(methods):
                raise with_suspects(errors[0], bench.made.values()) from None
            rows[method.name] = MethodRow(None, None, 0.0, str(error))
    primary = _primary(rows) if every else methods[0].name
    made = [bench.made[name] for name in works[primary]]
    solid = next((item for item in made if isinstance(item, LoftedSolid)), None)
    mesh = next((item for item in made if isinstance(item, TetMesh)), None)
    found = [(method, bench.made[works[method.name][-1]]) for method in methods if method.name in works]
    first = methods[0].name
    told = Notice(
        "main-method",
        f"{first} gives no figures ({rows[first].error}); the main figures are those of {primary}",
    )
    notices = () if primary == first else (told,)
    ordered = {primary: rows[primary]} | rows
    return ordered, _Measured(tuple(works[primary]), solid, mesh, tuple(found), notices)


def _primary(rows: dict[str, MethodRow]) -> str:
    """Return the first method with both figures, or with a volume, or with any."""
    given = {name: row for name, row in rows.items() if row.error is None}
    both = [name for name, row in given.items() if row.volume is not None and row.area is not None]
    volumes = [name for name, row in given.items() if row.volume is not None]
    return (*both, *volumes, *given)[0]


def _run_method(method: Method, bench: Workbench) -> tuple[MethodRow, list[str]]:
    """Run one method; its seconds are those of its own steps, shared ones included."""
    if method.error is not None:
        raise method.error
    integral, work = bench.run(method.steps)
    seconds = sum(bench.seconds[name] for name in work)
    return method_row(method.name, integral, seconds), work


def _sections(bench: Workbench) -> tuple[tuple[SectionRow, ...], tuple[Notice, ...]]:
    """Return the section table; a method that needs no contours is not stopped by contours that fail."""
    try:
        contours = bench.contours()
    except StackloftError as error:
        return (), (Notice("no-sections", f"the section table is empty: {error}"),)
    return (section_rows(contours) if contours is not None else ()), ()


def _measurement(
    rows: dict[str, MethodRow], measured: _Measured, sections: tuple[SectionRow, ...], source: Any
) -> Measurement:
    names = tuple(rows)
    volume = require_volume(tuple(rows.values()), names)
    area = rows[names[0]].area
    hints = _hints(source)
    return Measurement(
        id=1,
        volume=volume,
        area=area,
        methods=rows,
        derived=derived_figures(volume.value, area.value if area else None, hints.measured_weight),
        ends=measured.solid.ends if measured.solid is not None else (),
        sections=sections,
        mesh=mesh_entry(measured.mesh) if measured.mesh is not None else None,
    )


def _hints(source: Any) -> Hints:
    holder = source.stack if isinstance(source, Segmentation) else source
    return holder.hints if isinstance(holder, (SliceStack, ContourStack)) else Hints()


def _in_order(measured: _Measured, bench: Workbench) -> tuple[Any, ...]:
    """Return what was read, what the primary method made, then everything else."""
    first = ["source", *measured.identities]
    rest = [name for name in bench.made if name not in first]
    return tuple(bench.made[name] for name in [*first, *rest])


def _warnings(plan: Plan, products: Sequence[Any], more: tuple[Notice, ...]) -> tuple[Notice, ...]:
    """Return every notice once, in the order in which they arose."""
    own = [notice for product in products for notice in getattr(product, "notices", ())]
    return tuple(dict.fromkeys([*plan.notices, *own, *more]))
