"""What the author of a reader tells the conformance kit."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from stackloft.registry.options_model import validate
from stackloft.testing.conformance.told_volume import ToldVolume


@dataclass(frozen=True, slots=True)
class ReaderCase:
    """One reader, and how to make something that it reads."""

    reader: type[Any]
    """The plug-in class."""
    write: Callable[[Path, int], Path]
    """``write(folder, slices)`` makes a valid source in an empty folder and returns what is to be read.

    Slices must differ from each other, so that their order shows."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """What the reader needs beyond the source, for example the pixel size of photographs."""
    spacing_options: tuple[str, ...] = ()
    """Those of `options` without which the spacing is not known."""
    without_spacing: Callable[[Path, int], Path] | None = None
    """As `write`, but the source does not say its spacing; for formats that usually do."""
    slices: int = 5
    write_told: Callable[[Path, ToldVolume], Path] | None = None
    """``write_told(folder, volume)`` writes a volume that the kit makes up and returns what is to be read;
    it raises NotImplementedError, with what it is, on what the format cannot hold. None: for formats that do
    not say where their slices lie, such as photographs."""

    def make(self, **changes: Any) -> Any:
        """Return the reader with its options; a change to None leaves that option out."""
        merged = {**self.options, **changes}
        given = {name: value for name, value in merged.items() if value is not None}
        return self.reader(**validate(self.reader, given, self.reader.__name__))

    @contextmanager
    def source(self, slices: int | None = None) -> Iterator[Path]:
        """Yield a fresh valid source, the only thing in its folder."""
        with tempfile.TemporaryDirectory(prefix="stackloft-check-") as folder:
            yield self.write(Path(folder), self.slices if slices is None else slices)


def files_of(source: Path) -> list[Path]:
    """Return the files that make up a source, sorted."""
    return [source] if source.is_file() else sorted(path for path in source.rglob("*") if path.is_file())
