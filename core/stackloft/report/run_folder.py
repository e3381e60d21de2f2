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

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from stackloft.model.errors import InputError, UsageError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.recipe_file import write_recipe
from stackloft.registry import build, catalogue
from stackloft.report.overview import write_overview
from stackloft.report.thumbnails import Thumbnail
from stackloft.report.whole_file import whole_file

Settings = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True, slots=True)
class RunFolder:
    """Where a run's files go and which solids are wanted; built before the run, so that it fails early."""

    path: Path
    solids: Mapping[str, Any]
    """Writers of the solid by name."""

    @classmethod
    def plan(cls, path: Path, solids: Sequence[str], settings: Settings) -> RunFolder:
        """Return the folder's plan.

        Parameters
        ----------
        path : Path
            An existing folder.
        solids : sequence of str
            Names of the writers that shall write the solid.
        settings : mapping
            Options of writers, by ``writer``, name or ``writer.name``.

        Raises
        ------
        PluginError, UsageError
            An unknown writer, or an option it does not have.
        """
        _must_be_used(settings, solids)
        return cls(path, {name: solid_writer(name, settings) for name in solids})

    def write(self, outcome: Outcome) -> Iterator[Path]:
        """Write every file, each whole or not at all, and name it once it is there.

        Raises
        ------
        OutputError
            A file cannot be written; those already named stay.
        """
        for name, fill in self._files(outcome):
            with whole_file(self.path / name) as stream:
                fill(stream)
            yield self.path / name

    def _files(self, outcome: Outcome) -> Iterator[tuple[str, Callable[[BinaryIO], None]]]:
        yield "measurement.json", partial(build("writer", "json").write, outcome.result)
        yield "recipe.toml", partial(write_recipe, outcome.result.recipe)
        yield "sections.csv", partial(build("writer", "csv").write, outcome.result)
        if outcome.contours is not None:
            yield "overview.png", partial(write_overview, outcome.contours, thumbnails_of(outcome))
        for name, chosen in self.solids.items():
            yield f"solid{chosen.suffixes[0]}", partial(chosen.write, _solid_for(chosen, name, outcome))


def solid_writer(name: str, settings: Settings) -> Any:
    """Return the writer `name` with its options from `settings`, the more particular winning.

    Raises
    ------
    PluginError, UsageError
        No such writer, it writes no solid, or an option is not allowed.
    """
    options = {**settings.get("writer", {}), **settings.get(name, {}), **settings.get(f"writer.{name}", {})}
    built = build("writer", name, options)
    if not any(issubclass(kind, (LoftedSolid, TriMesh)) for kind in built.accepts):
        raise UsageError(f"writer {name} writes no solid", where="--write")
    return built


def split_settings(settings: Settings) -> tuple[dict[str, Mapping[str, Any]], dict[str, Mapping[str, Any]]]:
    """Return the settings that address writers, and the rest, which are the measurement's.

    Examples
    --------
    >>> split_settings({"writer.stl": {"tolerance": "0.1mm"}, "segmenter": {"threshold": "otsu"}})
    ({'writer.stl': {'tolerance': '0.1mm'}}, {'segmenter': {'threshold': 'otsu'}})
    """
    names = {listing.name for listing in catalogue("writer")}
    addressed = {key for key in settings if key in names or key.partition(".")[0] == "writer"}
    return (
        {key: options for key, options in settings.items() if key in addressed},
        {key: options for key, options in settings.items() if key not in addressed},
    )


def _must_be_used(settings: Settings, solids: Sequence[str]) -> None:
    used = {*solids, *(f"writer.{name}" for name in solids), *(["writer"] if solids else [])}
    for key in settings:
        if key not in used:
            name = key.removeprefix("writer.")
            raise UsageError("this writer writes no solid", where=f"--set {key}", fix=f"add --write {name}")


def thumbnails_of(outcome: Outcome) -> tuple[Thumbnail, ...]:
    """Return the thumbnails that a `ThumbnailSink` kept during the run; empty when no slice was decoded."""
    kept = (product for product in outcome.sink_products if isinstance(product, tuple))
    return next((item for item in kept if item and isinstance(item[0], Thumbnail)), ())


def _solid_for(chosen: Any, name: str, outcome: Outcome) -> Any:
    solid = next((item for item in outcome.products if isinstance(item, chosen.accepts)), None)
    if solid is None:
        raise InputError(
            "the method made no solid to write", where=f"--write {name}", fix="measure with --method loft"
        )
    return solid
