"""``stackloft mesh``: a solid's surface, or tetrahedra in it, as a file for other programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rich.table import Table

from stackloft.cli.progress import progress_display
from stackloft.cli.screen import console
from stackloft.cli.units import in_unit
from stackloft.geometry.closed_mesh import mesh_integrals
from stackloft.geometry.tet_integrals import elements_volume, faces_area
from stackloft.model.errors import InputError, StackloftError, UsageError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Measurement
from stackloft.model.notices import Notice
from stackloft.model.tet_mesh import TetMesh, mesh_entry
from stackloft.model.tri_mesh import TriMesh
from stackloft.pipeline.every_object import measure_objects
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.progress import Progress
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.workbench import guarded
from stackloft.registry import find, instantiate, validate
from stackloft.report.chosen_writer import Settings
from stackloft.report.mesh_file import wants_tetrahedra, writer_of
from stackloft.report.whole_file import whole_file

MESHERS = ("sweep", "tetwild")
"""Taken in this order when none is named: the first that carries the body."""


@dataclass(frozen=True, slots=True)
class MeshWish:
    """What a person wants to be given."""

    path: Path
    mesher: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    """The mesher's, as text or typed."""
    writer_settings: Settings = field(default_factory=dict)
    quiet: bool = False
    unit: str = "cm"


def mesher_settings(
    settings: Settings, flags: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, Mapping[str, Any]]]:
    """Return the mesher's options that ``--set`` and `flags` give, and the settings of everybody else.

    Examples
    --------
    >>> mesher_settings({"mesher.tetwild": {"epsilon": "0.1mm"}, "loft": {"points": 40}}, {"order": None})
    ({'epsilon': '0.1mm'}, {'loft': {'points': 40}})
    """
    names = {"mesher", *MESHERS, *(f"mesher.{name}" for name in MESHERS)}
    said = {key: value for name in sorted(names & settings.keys()) for key, value in settings[name].items()}
    said |= {key: value for key, value in flags.items() if value is not None}
    return said, {name: options for name, options in settings.items() if name not in names}


def run(request: MeasureRequest, wish: MeshWish) -> None:
    """Measure the source, mesh the solid when the format holds tetrahedra, write it, and say what it is.

    Raises
    ------
    StackloftError
        An unknown format or mesher; a source that cannot be measured, a solid that cannot be meshed, a file
        that cannot be written.
    """
    if request.shared.get("object") == "all":
        raise UsageError("a file holds one body", where="--object all", fix="--object largest or its label")
    writer = writer_of(wish.path, wish.writer_settings)
    tets = wants_tetrahedra(writer)
    if not tets and (wish.mesher or wish.options):
        raise UsageError(
            f"{wish.path.suffix} holds a surface, which no mesher makes",
            where=f"-o {wish.path}",
            fix="give .vtu, .msh, .inp or .mphtxt",
        )
    if not wish.path.parent.is_dir():
        raise UsageError("no such folder", where=str(wish.path.parent))
    with progress_display(quiet=wish.quiet) as progress:
        outcome = measure_objects(request, progress=progress)
        solid = _solid(outcome)
        product, told = _meshed(solid, wish, progress) if tets else (solid, ())
        progress.begin("write", None)
        with whole_file(wish.path) as stream:
            writer.write(product, stream)
        progress.end()
    if not wish.quiet:
        tolerance = float(getattr(writer.instance, "tolerance", 0.02))
        shown = product.tessellate(tolerance) if isinstance(product, LoftedSolid) else product
        _show(shown, outcome.result.objects[0], wish)
    _tell((*outcome.result.warnings, *told))


def _solid(outcome: Outcome) -> LoftedSolid | TriMesh:
    for product in outcome.products:
        if isinstance(product, (LoftedSolid, TriMesh)):
            return product
    raise InputError("the method made no solid", where="--method", fix="mesh with --method loft")


def _meshed(
    solid: LoftedSolid | TriMesh, wish: MeshWish, progress: Progress
) -> tuple[TetMesh, tuple[Notice, ...]]:
    """Return the tetrahedra, and what there is to say about them."""
    names = [wish.mesher] if wish.mesher else list(MESHERS)
    told: list[Notice] = []
    for name in names:
        loaded = find("mesher", name)
        options = dict(wish.options)
        if wish.mesher is None:  # an option that only the other mesher has is that one's
            options = {key: value for key, value in options.items() if key in _names(loaded.plugin)}
        mesher = instantiate(loaded, validate(loaded.plugin, options, loaded.key))
        last = name == names[-1]
        if not isinstance(solid, tuple(loaded.plugin.accepts)):
            if last and wish.mesher:
                need = " or ".join(kind.__name__ for kind in loaded.plugin.accepts)
                raise UsageError(f"mesher {name} cannot take a {type(solid).__name__}", where="--mesher",
                                 expected=need, fix="--mesher tetwild")  # fmt: skip
            continue
        progress.begin(f"mesher.{name}", None)
        try:
            mesh: TetMesh = guarded(loaded, mesher.mesh, solid)
        except StackloftError as error:
            if last:
                raise
            told.append(Notice("mesher-changed", f"{name} does not carry this body ({error.what})"))
            continue
        finally:
            progress.end()
        return mesh, (*told, *mesh.notices)
    raise InputError("no mesher takes this solid")


def _names(plugin: Any) -> set[str]:
    return set(plugin.__dataclass_fields__)


def _show(product: TriMesh | TetMesh, body: Measurement, wish: MeshWish) -> None:
    table = Table.grid(padding=(0, 2))
    if isinstance(product, TetMesh):
        entry = mesh_entry(product)
        figures = (
            elements_volume(product.nodes, product.elements, 6),
            faces_area(product.nodes, product.faces, 10),
        )
        table.add_row("elements", f"{entry['elements']} tetrahedra of order {entry['order']}")
        table.add_row("nodes", str(entry["nodes"]))
        worst = f"{entry['min_scaled_jacobian']:.3f}, {entry['inverted']} elements turned over"
        table.add_row("smallest scaled Jacobian", worst)
    else:
        figures = mesh_integrals(product.vertices, product.faces)
        table.add_row("triangles", str(len(product.faces)))
        table.add_row("vertices", str(len(product.vertices)))
    for name, power, found, figure in (
        ("volume", 3, figures[0], body.volume),
        ("area", 2, figures[1], body.area),
    ):
        beside = ""
        if figure is not None:
            off = 100.0 * (found / figure.value - 1.0)
            beside = f"; {figure.method} {in_unit(figure.value, wish.unit, power)}: {off:+.2g} %"
        table.add_row(name, f"{in_unit(found, wish.unit, power)}{beside}")
    table.add_row("file", str(wish.path))
    console().print(table)


def _tell(notices: tuple[Notice, ...]) -> None:
    screen = console(stderr=True)
    for notice in dict.fromkeys(notices):
        screen.print(f"warning {notice.code}: {notice.message}", soft_wrap=True, markup=False)
