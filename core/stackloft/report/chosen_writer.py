"""A writer plug-in that a run uses: found, built from its settings, answerable for its failures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, BinaryIO

from stackloft.model.errors import InputError, StackloftError, UsageError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry import Loaded, catalogue, failure, find, instantiate, validate
from stackloft.registry.work_notes import at_work

Settings = Mapping[str, Mapping[str, Any]]
"""Options by ``writer``, name or ``writer.name``; the more particular wins."""


@dataclass(frozen=True, slots=True)
class ChosenWriter:
    """One writer, ready to write."""

    loaded: Loaded
    instance: Any

    @classmethod
    def of(cls, name: str, settings: Settings | None = None) -> ChosenWriter:
        """Return the writer `name`.

        Raises
        ------
        PluginError, UsageError
            No such writer, or an option that it does not have or allow.
        """
        said = settings or {}
        options = {**said.get("writer", {}), **said.get(name, {}), **said.get(f"writer.{name}", {})}
        loaded = find("writer", name)
        return cls(loaded, instantiate(loaded, validate(loaded.plugin, options, loaded.key)))

    @property
    def suffix(self) -> str:
        """The usual suffix of its files, with the dot."""
        return str(self.instance.suffixes[0])

    def write(self, product: Any, stream: BinaryIO) -> None:
        """Write `product`; a failure that the writer does not explain names its distribution.

        Raises
        ------
        StackloftError, OSError
            As the writer says, or as the system refuses.
        """
        try:
            with at_work(self.loaded.listing, "write"):
                self.instance.write(product, stream)
        except (StackloftError, OSError):
            raise
        except (Exception, SystemExit) as error:
            raise failure(self.loaded, error) from error

    def fitting(self, products: Sequence[Any]) -> Any:
        """Return the first of `products` that it accepts.

        Raises
        ------
        InputError
            There is none.
        """
        kinds = tuple(self.instance.accepts)
        found = next((product for product in products if isinstance(product, kinds)), None)
        if found is None:
            raise InputError(
                "the method made no solid to write",
                where=f"--write {self.loaded.name}",
                fix=f"measure with --method {'fem' if kinds == (TetMesh,) else 'loft'}",
            )
        return found


def solid_writers(names: Sequence[str], settings: Settings) -> tuple[ChosenWriter, ...]:
    """Return the writers of the solid called `names`.

    Raises
    ------
    PluginError, UsageError
        No such writer, it writes no solid, an option is not allowed, or is set for a writer not named.
    """
    chosen = tuple(ChosenWriter.of(name, settings) for name in names)
    for one in chosen:
        if not any(issubclass(kind, (LoftedSolid, TriMesh, TetMesh)) for kind in one.instance.accepts):
            raise UsageError(f"writer {one.loaded.name} writes no solid", where="--write")
    used = {*names, *(f"writer.{name}" for name in names), *(["writer"] if names else [])}
    for key in settings:
        if key not in used:
            fix = f"add --write {key.removeprefix('writer.')}"
            raise UsageError("this writer writes nothing here", where=f"--set {key}", fix=fix)
    return chosen


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
