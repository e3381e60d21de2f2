"""Which reader is meant for a path: each one looks at the content and says how sure it is."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from stackloft.model.errors import InputError, PluginError
from stackloft.registry.find import find, nearest
from stackloft.registry.loading import Loaded, Quarantined, load
from stackloft.registry.scan import catalogue
from stackloft.registry.work_notes import at_work


@dataclass(frozen=True, slots=True)
class Probe:
    """What one reader said of a path."""

    reader: Loaded
    confidence: float
    """0 to 1"""
    fault: str | None = None
    """Why its answer does not count: it raised, or answered outside 0 to 1."""


def choose_reader(path: Path, name: str | None = None) -> Loaded:
    """Return the reader for `path`: the one named, or the surest.

    Raises
    ------
    InputError
        There is nothing at `path`, or no reader knows what is there.
    PluginError
        Two readers are equally sure, or the one named is unknown or broken.
    """
    if name is not None:
        return _named(path, name)
    probes = probe_all(path)
    top = max((probe.confidence for probe in probes), default=0.0)
    if top <= 0:
        _must_exist(path)
        raise _nobody(path, probes)
    surest = [probe.reader for probe in probes if probe.confidence == top]
    if len(surest) > 1:
        names = [reader.listing.qualified if reader.listing.clash else reader.name for reader in surest]
        raise PluginError(
            f"readers {' and '.join(names)} are equally sure that this is theirs (confidence {top:g})",
            where=str(path),
            fix=f"choose one: {' or '.join(f'--reader {choice}' for choice in names)}",
        )
    return surest[0]


def _named(path: Path, name: str) -> Loaded:
    """Return the reader called `name`; a path that is not there may be a pattern that it knows."""
    reader = find("reader", name)
    if _probe(reader, path).confidence <= 0:
        _must_exist(path)
    return reader


def probe_all(path: Path) -> tuple[Probe, ...]:
    """Return every usable reader's answer about `path`, the surest first; raises nothing."""
    loaded = [load(listing) for listing in catalogue("reader")]
    probes = [_probe(reader, path) for reader in loaded if isinstance(reader, Loaded)]
    return tuple(sorted(probes, key=lambda probe: -probe.confidence))


def _probe(reader: Loaded, path: Path) -> Probe:
    try:
        with at_work(reader.listing, "probe"):
            confidence = float(reader.plugin().probe(path))
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a stranger's probe may raise anything
        return Probe(reader, 0.0, f"its probe failed: {type(error).__name__}: {error}")
    if not 0 <= confidence <= 1 or math.isnan(confidence):
        return Probe(reader, 0.0, f"its probe answered {confidence:g}, which is not within 0 to 1")
    return Probe(reader, confidence)


def _must_exist(path: Path) -> None:
    if path.exists():
        return
    parent = path.parent
    names = sorted(item.name for item in parent.iterdir()) if parent.is_dir() else []
    hint = nearest(path.name, names) if names else None
    fix = hint if hint and hint.startswith("did") else None
    raise InputError("no such file or folder", where=str(path), fix=fix)


def _nobody(path: Path, probes: tuple[Probe, ...]) -> InputError:
    found = describe(path)
    if found.startswith("an empty"):
        return InputError(f"nothing to read: {found}", where=str(path), expected="slices or a volume")
    faults = [f"{probe.reader.key}: {probe.fault}" for probe in probes if probe.fault]
    outcomes = [load(listing) for listing in catalogue("reader")]
    faults += [f"{x.listing.key}: {x.reason}" for x in outcomes if isinstance(x, Quarantined)]
    known = ", ".join(probe.reader.name for probe in probes if not probe.fault) or "none"
    return InputError(
        "no reader knows what is there",
        where=str(path),
        found="; ".join([found, *faults]),
        expected=f"input for one of the readers: {known}",
        fix="name one with --reader, or install a plug-in for this format",
    )


def describe(path: Path) -> str:
    """Return what is at `path` in a few words.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "a.xyz").write_text("")
    ...     describe(Path(folder))
    '1 file: 1 × .xyz'
    """
    if path.is_file():
        size = path.stat().st_size
        return "an empty file" if size == 0 else f"a file {path.suffix or 'without suffix'} of {size} bytes"
    items = list(path.iterdir())
    files = Counter(item.suffix.lower() or "without suffix" for item in items if not item.is_dir())
    folders = sum(item.is_dir() for item in items)
    parts = [f"{count} × {suffix}" for suffix, count in sorted(files.items(), key=_rank)[:5]]
    if folders:
        parts.append(f"{folders} folder{'s' if folders > 1 else ''}")
    if not parts:
        return "an empty folder"
    count = files.total()
    return f"{count} file{'s' if count != 1 else ''}: {', '.join(parts)}" if count else parts[0]


def _rank(counted: tuple[str, int]) -> tuple[int, str]:
    """Most frequent first, then by name, whatever order the folder is listed in."""
    return -counted[1], counted[0]
