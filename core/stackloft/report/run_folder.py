"""A run's folder: what ``--out`` receives.

=====================  =====================================================
``measurement.json``   the result (``docs/measurement.md``)
``recipe.toml``        everything that was chosen; run again it gives the same numbers
``sections.csv``       the sections' own figures
``overview.png``       every section's contour over its photograph
``figure_slice.png``   one slice step by step: grey, histogram, binary, B-spline, overlay
``views.png``          the solid from three sides and from a corner
``solid.<suffix>``     the solid, in the formats asked for
=====================  =====================================================
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.tri_mesh import TriMesh
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.recipe_file import write_recipe
from stackloft.report.chosen_writer import ChosenWriter
from stackloft.report.figure_sink import SliceFigure
from stackloft.report.loft_lines import LoftLine, lines_at, to_bench
from stackloft.report.overview import write_overview
from stackloft.report.slice_figure import write_slice_figure
from stackloft.report.thumbnails import Thumbnail
from stackloft.report.views import write_views
from stackloft.report.whole_file import whole_file


@dataclass(frozen=True, slots=True)
class RunFolder:
    """Where a run's files go and which solids are wanted; made before the run, so that it fails early."""

    path: Path
    """An existing folder."""
    solids: tuple[ChosenWriter, ...] = ()
    """Writers of the solid."""

    def write(self, outcome: Outcome) -> Iterator[Path]:
        """Write every file, each whole or not at all, and name it once it is there.

        Raises
        ------
        OutputError
            A file cannot be written; those already named stay.
        InputError
            A solid is wanted and the run made none.
        """
        for name, fill in self._files(outcome):
            with whole_file(self.path / name) as stream:
                fill(stream)
            yield self.path / name

    def _files(self, outcome: Outcome) -> Iterator[tuple[str, Callable[[BinaryIO], None]]]:
        yield "measurement.json", partial(ChosenWriter.of("json").write, outcome.result)
        yield "recipe.toml", partial(write_recipe, outcome.result.recipe)
        yield "sections.csv", partial(ChosenWriter.of("csv").write, outcome.result)
        if outcome.contours is not None:
            yield "overview.png", partial(write_overview, outcome.contours, thumbnails_of(outcome))
        figure = next((item for item in outcome.sink_products if isinstance(item, SliceFigure)), None)
        if figure is not None:
            yield "figure_slice.png", partial(write_slice_figure, figure, _lines(outcome, figure.z))
        surface = _surface(outcome)
        if surface is not None:
            yield "views.png", partial(write_views, surface, _section_lines(outcome))
        for writer in self.solids:
            yield f"solid{writer.suffix}", partial(writer.write, writer.fitting(outcome.products))


def _lines(outcome: Outcome, z: float) -> tuple[LoftLine, ...]:
    """Return the curves measured at `z`: the loft's, or the traced loops of a method without one."""
    lines = lines_at(outcome.solid, z) if outcome.solid is not None else ()
    sections = outcome.contours.sections if outcome.contours is not None else ()
    loops = [loop for section in sections if abs(section.z - z) < 1e-9 for loop in section.loops]
    return lines or tuple(LoftLine(loop.points, loop.points[:0]) for loop in loops)


def _surface(outcome: Outcome) -> TriMesh | None:
    """Return what the first method that made a surface made, fine enough for a picture."""
    solid = outcome.solid
    if solid is None:
        mesh = outcome.product(TriMesh)
        return mesh if mesh is not None and len(mesh.faces) else None
    corners = np.concatenate([shell.patches.reshape(-1, 3) for shell in solid.shells])
    return solid.tessellate(float(np.ptp(corners, axis=0).max()) / 2000)


def _section_lines(outcome: Outcome) -> list[FloatArray]:
    """Return the sections' curves on the solid, in bench millimetres."""
    solid, contours = outcome.solid, outcome.contours
    if solid is None or contours is None:
        return []
    lines = [line for z in contours.positions for line in lines_at(solid, float(z))]
    return [to_bench(line.curve, solid.affine) for line in lines]


def thumbnails_of(outcome: Outcome) -> tuple[Thumbnail, ...]:
    """Return the thumbnails that a `ThumbnailSink` kept during the run; empty when no slice was decoded."""
    kept = (product for product in outcome.sink_products if isinstance(product, tuple))
    return next((item for item in kept if item and isinstance(item[0], Thumbnail)), ())
