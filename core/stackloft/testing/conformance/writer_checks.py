"""Checks of writers; run them with one pytest call.

::

    @pytest.mark.parametrize("check", writer_checks(WriterCase(MyWriter, read=read_back)), ids=str)
    def test_my_writer(check):
        check()
"""

from __future__ import annotations

import io
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.geometry.closed_mesh import mesh_integrals, unmatched_edges
from stackloft.geometry.tet_integrals import elements_volume, faces_area
from stackloft.model.arrays import frozen_floats
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Figure, Measurement, Result, SectionRow
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry.options_model import validate
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.check import Check, must, must_refuse, suite
from stackloft.testing.conformance.comparing import must_be_same
from stackloft.testing.conformance.moving import emptied, transformed
from stackloft.testing.conformance.option_checks import check_options, check_shape
from stackloft.testing.conformance.reading_back import read_surface, read_tets
from stackloft.testing.conformance.watching import watching


@dataclass(frozen=True, slots=True)
class WriterCase:
    """One writer, and how what it wrote is read back."""

    writer: type[Any]
    read: Callable[[Path], Any] | None = None
    """From a file to what `expected` gives; for surfaces a TriMesh, for tetrahedra a TetMesh. None: by
    meshio, where it can."""
    expected: Callable[[Any], Any] | None = None
    """From the product to what `read` must give; needed for products other than solids and surfaces."""
    options: Mapping[str, Any] = field(default_factory=dict)
    tolerance: float = 1e-5
    """Relative difference allowed: what the format's number type keeps."""

    def write(self, product: Any) -> bytes:
        """Return the file's bytes."""
        stream = io.BytesIO()
        values = validate(self.writer, self.options, self.writer.__name__)
        self.writer(**values).write(product, stream)
        must(not stream.closed, "the stream that belongs to the caller is closed")
        return stream.getvalue()

    def read_back(self, content: bytes) -> Any:
        """Return what a reader makes of the bytes."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"written{self.writer.suffixes[0]}"
            path.write_bytes(content)
            if self.read is not None:
                return self.read(path)
            return read_tets(path) if TetMesh in self.writer.accepts else read_surface(path)

    def products(self) -> list[Any]:
        """Return a product of each type that the writer accepts and the kit can make."""
        makers: dict[type, Callable[[], Any]] = {
            kind: lambda make=make: make(2)  # type: ignore[misc]
            for kind, make in ellipsoids.MAKERS.items()
        }
        makers[Result] = result
        fitting = [make() for kind, make in makers.items() if kind in self.writer.accepts]
        must(fitting, f"the kit has no product of a type in {self.writer.accepts}")
        return fitting


def result() -> Result:
    """Return a run's outcome with odd figures, that what was lost or rounded shows."""
    row = SectionRow(1, 2.8125, 101.3 / 7, 41.7 / 3, (12.1 / 3, -7.7 / 9), 1, 0)
    figures = Figure(1234567.0 / 7, "mm^3", "loft"), Figure(76543.0 / 9, "mm^2", "loft")
    return Result(
        {"path": "body", "reader": "photos", "digest": "0"}, (Measurement(1, *figures, sections=(row,)),)
    )


def shape(case: WriterCase) -> None:
    """Check that the registry lets the writer in, and that its suffixes are lower case with a dot."""
    check_shape("writer", case.writer)
    suffixes = case.writer.suffixes
    must(suffixes, "no suffix is announced")
    for suffix in suffixes:
        good = isinstance(suffix, str) and suffix.startswith(".") and suffix == suffix.lower() != "."
        must(good, f"suffix {suffix!r} is not lower case with a dot")


def options(case: WriterCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.writer, case.options)


def writes(case: WriterCase) -> None:
    """Check that something is written, twice the same, and that the product stays as it was."""
    for product, fresh in zip(case.products(), case.products(), strict=True):
        first = case.write(product)
        must(first, f"a {type(product).__name__} leaves an empty file")
        must(first == case.write(product), "the same product gives other bytes when written again")
        must_be_same(product, fresh, "after it was written")


def reads_back(case: WriterCase) -> None:
    """Check that what was written is read back equal; surfaces with place, size and orientation."""
    for product in case.products():
        _must_read_back(case, product, "")


def far_and_small(case: WriterCase) -> None:
    """Check the same of surfaces a thousandth and a thousand times as large."""
    for product in case.products():
        if isinstance(product, (LoftedSolid, TriMesh, TetMesh)):
            for s in (1e-3, 1e3):
                scaled = transformed(product, s * np.eye(3), np.zeros(3))
                if isinstance(scaled, (TriMesh, TetMesh)):  # a solid's tolerance is in mm, whatever its size
                    _must_read_back(case, scaled, f" scaled by {s:g}")


def affine(case: WriterCase) -> None:
    """Check that a solid is written where its affine puts it."""
    move = np.eye(4)
    move[:3, :3] = [[0.0, -0.8, 0.6], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]]
    move[:3, 3] = (10.0, 20.0, -30.0)
    for product in case.products():
        if isinstance(product, LoftedSolid):
            _must_read_back(case, replace(product, affine=frozen_floats(move)), " with an affine")


def refusals(case: WriterCase) -> None:
    """Check that an empty surface, and one with vertices that are not finite, are refused."""
    for product in case.products():
        if isinstance(product, TriMesh):
            must_refuse(lambda: case.write(emptied(ellipsoids.tri_mesh(1))), "an empty surface")
            vertices = product.vertices.copy()
            vertices[3] = np.nan
            spoilt = replace(product, vertices=frozen_floats(vertices))
            must_refuse(lambda spoilt=spoilt: case.write(spoilt), "a vertex that is not finite")  # type: ignore[misc]
        if isinstance(product, TetMesh):
            must_refuse(lambda mesh=product: case.write(emptied(mesh)), "a mesh without elements")  # type: ignore[misc]
            nodes = product.nodes.copy()
            nodes[3] = np.nan
            odd = replace(product, nodes=frozen_floats(nodes))
            must_refuse(lambda odd=odd: case.write(odd), "a node that is not finite")  # type: ignore[misc]


def no_side_effects(case: WriterCase) -> None:
    """Check that writing opens no file, asks no network, changes no global state: the stream is all."""
    for product in case.products():
        case.write(product)  # imports what it needs
        with tempfile.TemporaryDirectory() as folder, watching(Path(folder)) as watch:
            case.write(product)
        must(not watch.deeds, f"writing {'; '.join(watch.deeds)}")


def _must_read_back(case: WriterCase, product: Any, how: str) -> None:
    what = f"a {type(product).__name__}{how}"
    content = case.write(product)
    if not isinstance(product, (LoftedSolid, TriMesh, TetMesh)) or case.expected is not None:
        must(case.read is not None and case.expected is not None, "the case tells no `read` and `expected`")
        back, wanted = case.read_back(content), (case.expected or (lambda x: x))(product)
        must(back == wanted, f"{what} comes back as {str(back)[:80]}, written was {str(wanted)[:80]}")
        return
    back = case.read_back(content)
    if isinstance(product, TetMesh):
        must(isinstance(back, TetMesh), f"{what} comes back as {type(back).__name__}, not as a TetMesh")
        must_match_tets(case, back, product, what)
        return
    must(isinstance(back, TriMesh), f"{what} comes back as {type(back).__name__}, not as a TriMesh")
    loose = unmatched_edges(back.faces)
    must(loose == 0, f"{what} comes back with {loose} edges open")
    _must_match(case, back, product, what)


def _must_match(case: WriterCase, back: TriMesh, product: Any, what: str) -> None:
    exact = isinstance(product, TriMesh)
    wanted = product if exact else product.tessellate(0.005)
    slack = case.tolerance if exact else 1e-2
    for name, found, said in zip(("volume", "area"), _figures(back), _figures(wanted), strict=True):
        change = found / said - 1.0
        must(abs(change) <= slack, f"{what} comes back with {name} changed by {change:.1e}")
    size = float(np.abs(wanted.vertices).max())
    for name, corner in (("lowest", np.min), ("highest", np.max)):
        found, said = corner(back.vertices, axis=0), corner(wanted.vertices, axis=0)
        off = float(np.abs(found - said).max())
        must(off <= slack * size, f"{what} comes back with its {name} corner {off:.3g} mm off")


def must_match_tets(case: WriterCase, back: TetMesh, product: TetMesh, what: str) -> None:
    """Check order, count, volume, area and place of tetrahedra that were read back."""
    must(back.order == product.order, f"{what} comes back of order {back.order}, written was {product.order}")
    must(len(back.elements) == len(product.elements), f"{what} comes back with {len(back.elements)} elements")
    found, said = (
        (elements_volume(mesh.nodes, mesh.elements, 4), faces_area(mesh.nodes, mesh.faces, 4))
        for mesh in (back, product)
    )
    for name, one, other in zip(("volume", "area"), found, said, strict=True):
        change = one / other - 1.0
        must(abs(change) <= case.tolerance, f"{what} comes back with {name} changed by {change:.1e}")
    size = float(np.abs(product.nodes).max())
    off = float(np.abs(back.nodes.mean(axis=0) - product.nodes.mean(axis=0)).max())
    must(off <= case.tolerance * size, f"{what} comes back {off:.3g} mm off")


def _figures(mesh: TriMesh) -> tuple[float, float]:
    return mesh_integrals(mesh.vertices, mesh.faces)


CHECKS = {
    "plugin-shape": shape,
    "options-validated": options,
    "writes": writes,
    "reads-back": reads_back,
    "far-and-small": far_and_small,
    "affine": affine,
    "refuses-spoilt": refusals,
    "no-side-effects": no_side_effects,
}


def writer_checks(case: WriterCase, expected_failures: Mapping[str, str] | None = None) -> list[Check]:
    """Return the checks of one writer.

    Parameters
    ----------
    case : WriterCase
        The writer and how its files are read back.
    expected_failures : mapping, optional
        Reasons by check for those that this writer may break; it must then really break them.
    """
    return suite(CHECKS, case, expected_failures or {})
