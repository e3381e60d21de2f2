"""Checks of ``Reader.probe``: by content, cheap, without side effects, never raising."""

from __future__ import annotations

import random
import tempfile
from pathlib import Path
from typing import Any

from stackloft.testing.conformance.check import NonconformingError, must
from stackloft.testing.conformance.reader_case import ReaderCase, files_of
from stackloft.testing.conformance.watching import watching

MANY = 60
"""Slices of the source on which cheapness is judged."""
MOST_OPENED = 20
"""Files that a probe may open of those."""
MOST_SECONDS = 0.25
"""A probe's time; every installed reader is asked before anything is read."""


def confidence(case: ReaderCase, path: Path, what: str) -> float:
    """Return the probe's answer about `path`; it must be a number from 0 to 1."""
    try:
        answer: Any = case.reader().probe(path)
    except Exception as error:
        raise NonconformingError(f"probing {what} raises {type(error).__name__}: {error}") from error
    number = isinstance(answer, (int, float)) and not isinstance(answer, bool)
    must(number and 0 <= answer <= 1, f"probing {what} answers {answer!r}, not a number from 0 to 1")
    return float(answer)


def knows_its_own(case: ReaderCase) -> None:
    """Check that the reader is sure, at least a little, of a source that it reads."""
    with case.source() as source:
        must(confidence(case, source, "a valid source") > 0, "a valid source is answered with 0")


def missing(case: ReaderCase) -> None:
    """Check that a path that is not there is answered with 0."""
    with tempfile.TemporaryDirectory() as folder:
        must(confidence(case, Path(folder) / "gone", "a missing path") == 0, "a missing path is claimed")


def empty(case: ReaderCase) -> None:
    """Check that an empty folder and an empty file are answered with 0."""
    with tempfile.TemporaryDirectory() as folder:
        must(confidence(case, Path(folder), "an empty folder") == 0, "an empty folder is claimed")
        path = Path(folder) / "empty"
        path.touch()
        must(confidence(case, path, "an empty file") == 0, "an empty file is claimed")


def rubbish(case: ReaderCase) -> None:
    """Check that random bytes, text and folders in folders are answered with 0."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "noise.bin").write_bytes(random.Random(7).randbytes(4096))
        (root / "note.txt").write_text("a letter about apples\n" * 20)
        (root / "deep").mkdir()
        must(confidence(case, root, "rubbish") == 0, "a folder of rubbish is claimed")
        must(confidence(case, root / "noise.bin", "noise") == 0, "random bytes are claimed")


def by_content(case: ReaderCase) -> None:
    """Check that the right names around wrong content count for less than the right content."""
    with case.source() as source:
        real = confidence(case, source, "a valid source")
        for number, path in enumerate(files_of(source)):
            path.write_bytes(random.Random(number).randbytes(2000))
        pretended = confidence(case, source, "noise under the right names")
    must(pretended < real, f"noise under the right names is answered with {pretended:g}, as the real thing")


def cheap(case: ReaderCase) -> None:
    """Check that a probe opens few files of a long series and answers at once."""
    with case.source(MANY) as source:
        case.reader().probe(source)  # imports what it needs
        folder = source if source.is_dir() else source.parent
        watches = []
        for _ in range(3):  # the quickest counts: the machine may be busy with something else
            with watching(folder) as watch:
                case.reader().probe(source)
            watches.append(watch)
    many, seconds = len(watches[0].opened), min(watch.seconds for watch in watches)
    must(many <= MOST_OPENED, f"probing a series of {MANY} slices opens {many} files")
    must(seconds <= MOST_SECONDS, f"probing a series of {MANY} slices takes {seconds:.2f} s")


def no_side_effects(case: ReaderCase) -> None:
    """Check that a probe writes nothing, asks no network, starts nothing, changes no global state."""
    with case.source() as source:
        folder = source if source.is_dir() else source.parent
        with watching(folder) as watch:
            case.reader().probe(source)
    must(not watch.deeds, f"probing {'; '.join(watch.deeds)}")


CHECKS = {
    "probe-knows-its-own": knows_its_own,
    "probe-missing-path": missing,
    "probe-empty": empty,
    "probe-rubbish": rubbish,
    "probe-by-content": by_content,
    "probe-cheap": cheap,
    "probe-no-side-effects": no_side_effects,
}
