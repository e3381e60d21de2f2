"""Checks of what a reader must refuse: always with a StackloftError that names what is wrong."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.testing.conformance.check import must, must_refuse
from stackloft.testing.conformance.reader_case import ReaderCase, files_of


def drained(case: ReaderCase, source: Path, **changes: Any) -> Callable[[], Any]:
    """Return an action that reads `source` and decodes all of it."""

    def action() -> Any:
        product = case.make(**changes).read(source)
        stack = product.stack if isinstance(product, Segmentation) else product
        for k in range(len(stack) if isinstance(stack, SliceStack) else 0):
            stack.decode(k)
        return product

    return action


def spacing(case: ReaderCase) -> None:
    """Check that a spacing that nobody gave is refused, never invented."""
    with case.source() as source:
        for name in case.spacing_options:
            error = must_refuse(drained(case, source, **{name: None}), f"a source without {name}")
            must(error.fix or error.expected, f"refusing a source without {name} says no fix: {error}")
    if case.without_spacing is not None:
        with tempfile.TemporaryDirectory() as folder:
            bare = case.without_spacing(Path(folder), case.slices)
            must_refuse(drained(case, bare), "a source that does not say its spacing")


def missing(case: ReaderCase) -> None:
    """Check that a path that is not there is refused, by its name."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gone"
        error = must_refuse(drained(case, path), "a missing path")
        must("gone" in str(error), f"the refusal of a missing path does not name it: {error}")


def empty(case: ReaderCase) -> None:
    """Check that an empty folder, an empty file and a source of emptied files are refused."""
    with case.source() as source:
        for path in files_of(source):
            path.write_bytes(b"")
        must_refuse(drained(case, source), "a source whose files are empty")
    with tempfile.TemporaryDirectory() as folder:
        must_refuse(drained(case, Path(folder)), "an empty folder")
        path = Path(folder) / "empty"
        path.touch()
        must_refuse(drained(case, path), "an empty file")


def one_slice(case: ReaderCase) -> None:
    """Check that one slice has no thickness of its own; it is refused."""
    with case.source(1) as source:
        must_refuse(drained(case, source), "a single slice")


def truncated(case: ReaderCase) -> None:
    """Check that each file cut off half way is refused when it is read or decoded, and named."""
    with case.source() as source:
        for path in _largest(source):
            content = path.read_bytes()
            path.write_bytes(content[: len(content) // 2])
            error = must_refuse(drained(case, source), f"{path.name} cut off half way")
            must(path.name in str(error), f"the refusal does not name {path.name}: {error}")
            path.write_bytes(content)


def damaged(case: ReaderCase) -> None:
    """Check that noise in the place of a slice's file is refused."""
    with case.source() as source:
        path = _largest(source)[0]
        path.write_bytes(random.Random(3).randbytes(5000))
        must_refuse(drained(case, source), f"noise in the place of {path.name}")


def _largest(source: Path) -> list[Path]:
    """Return the first and last of the files that hold the bulk of the data."""
    files = files_of(source)
    most = max(path.stat().st_size for path in files)
    bulk = [path for path in files if path.stat().st_size * 4 >= most]
    return list(dict.fromkeys((bulk[0], bulk[-1])))


CHECKS = {
    "refuses-unknown-spacing": spacing,
    "refuses-missing-path": missing,
    "refuses-empty": empty,
    "refuses-one-slice": one_slice,
    "refuses-truncated": truncated,
    "refuses-damaged": damaged,
}
