"""A run's folder: what ``--out`` receives.

=====================  =====================================================
``measurement.json``   the result (``docs/measurement.md``)
``recipe.toml``        everything that was chosen; run again it gives the same numbers
``sections.csv``       the sections' own figures
``overview.png``       every section's contour over its photograph
``solid.<suffix>``     the solid, in the formats asked for
=====================  =====================================================
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import BinaryIO

from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.recipe_file import write_recipe
from stackloft.report.chosen_writer import ChosenWriter
from stackloft.report.overview import write_overview
from stackloft.report.thumbnails import Thumbnail
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
        for writer in self.solids:
            yield f"solid{writer.suffix}", partial(writer.write, writer.fitting(outcome.products))


def thumbnails_of(outcome: Outcome) -> tuple[Thumbnail, ...]:
    """Return the thumbnails that a `ThumbnailSink` kept during the run; empty when no slice was decoded."""
    kept = (product for product in outcome.sink_products if isinstance(product, tuple))
    return next((item for item in kept if item and isinstance(item[0], Thumbnail)), ())
