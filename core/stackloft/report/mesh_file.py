"""One file with a solid's surface or its tetrahedra, in the format of its suffix."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stackloft.model.errors import UsageError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry import Loaded, catalogue, load
from stackloft.report.chosen_writer import ChosenWriter, Settings

SOLIDS = (LoftedSolid, TriMesh, TetMesh)


def writer_of(path: Path, settings: Settings) -> ChosenWriter:
    """Return the writer of solids or tetrahedra whose format has the suffix of `path`.

    Raises
    ------
    UsageError
        No writer has it; those that are there are named.
    """
    known: dict[str, str] = {}
    for listing in catalogue("writer"):
        loaded = load(listing)
        if isinstance(loaded, Loaded) and _takes(loaded, SOLIDS):
            known |= dict.fromkeys(loaded.plugin.suffixes, listing.name)
    suffix = path.suffix.lower()
    if suffix not in known:
        raise UsageError(
            "no writer has this format",
            where=f"-o {path}",
            found=suffix or "no suffix",
            expected=", ".join(sorted(known)),
        )
    return ChosenWriter.of(known[suffix], settings)


def wants_tetrahedra(writer: ChosenWriter) -> bool:
    """Return whether a writer takes tetrahedra and no surface."""
    return not _takes(writer.loaded, (LoftedSolid, TriMesh))


def _takes(loaded: Loaded, kinds: tuple[type[Any], ...]) -> bool:
    return any(issubclass(kind, kinds) for kind in loaded.plugin.accepts)
