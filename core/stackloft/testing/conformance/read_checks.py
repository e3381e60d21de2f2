"""Checks of ``Reader.read`` on valid sources."""

from __future__ import annotations

import os
import random
import tempfile
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from stackloft.model.slice_stack import SliceStack
from stackloft.testing.conformance.check import must, must_refuse
from stackloft.testing.conformance.comparing import (
    must_be_frozen,
    must_be_same,
    must_hand_out_fresh_slices,
)
from stackloft.testing.conformance.reader_case import ReaderCase, files_of
from stackloft.testing.conformance.watching import watching

MANY = 40
"""Slices of the single-file source whose reading must not take the memory of the whole volume."""


def produces(case: ReaderCase) -> None:
    """Check that what is read is of an announced type, with as many slices or sections as were written."""
    with case.source() as source:
        product = case.make().read(source)
        kinds = ", ".join(kind.__name__ for kind in case.reader.produces)
        must(isinstance(product, case.reader.produces), f"{type(product).__name__} is not one of {kinds}")
        if hasattr(product, "__len__"):
            must(len(product) == case.slices, f"{len(product)} slices of {case.slices} were read")
        if isinstance(product, SliceStack):
            for k, name in enumerate(product.names):
                found = product.decode(k).shape
                must(found[:2] == product.shape, f"slice {name} is {found}, announced was {product.shape}")


def frozen(case: ReaderCase) -> None:
    """Check that neither the product nor its arrays can be changed."""
    with case.source() as source:
        product = case.make().read(source)
        must_be_frozen(product)
        if isinstance(product, SliceStack):
            must_hand_out_fresh_slices(product)


def repeatable(case: ReaderCase) -> None:
    """Check that reading twice gives the same."""
    with case.source() as source:
        must_be_same(case.make().read(source), case.make().read(source), "when read again")


def no_side_effects(case: ReaderCase) -> None:
    """Check that reading and decoding write nothing, ask no network, change no global state."""
    with case.source() as source:
        folder = source if source.is_dir() else source.parent
        with watching(folder) as watch:
            product = case.make().read(source)
            if isinstance(product, SliceStack):
                product.decode(0)
    must(not watch.deeds, f"reading {'; '.join(watch.deeds)}")


def file_order(case: ReaderCase) -> None:
    """Check that the order in which a folder is listed, and the files' dates, change nothing."""
    with case.source() as source:
        expected = case.make().read(source)
        for seed in range(3):
            files = files_of(source)
            random.Random(seed).shuffle(files)
            for date, path in enumerate(files):
                os.utime(path, (1e9 + date, 1e9 + date))
            with _listed_in_order(seed):
                must_be_same(expected, case.make().read(source), "when files are listed in another order")


def independent_slices(case: ReaderCase) -> None:
    """Check that a slice is decoded when it is asked for, from its own file and no other."""
    with case.source() as source:
        product = case.make().read(source)
        if not isinstance(product, SliceStack) or not source.is_dir():
            return
        files = {path.name: path for path in files_of(source)}
        if not all(name in files for name in product.names):
            return
        kept = product.decode(len(product) - 1)
        for name in product.names[:-1]:
            _replace(files[name], b"not a slice any more")
        must_refuse(lambda: product.decode(0), "a slice whose file was ruined after read() (decoded early?)")
        same = np.array_equal(product.decode(len(product) - 1), kept)
        must(same, "decoding one slice depends on the files of others")


def small_memory(case: ReaderCase) -> None:
    """Check that reading takes less than half of the memory that all decoded slices would take."""
    with case.source(MANY) as source:
        case.make().read(source)  # imports what it needs
        tracemalloc.start()
        try:
            product = case.make().read(source)
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        if isinstance(product, SliceStack):
            whole = sum(product.decode(k).nbytes for k in range(len(product)))
            message = f"reading takes {peak} bytes, all slices decoded are {whole}: they are decoded early"
            must(peak < max(whole / 2, 1 << 18), message)


def from_elsewhere(case: ReaderCase) -> None:
    """Check that where the source lies, and what the folder is called, changes nothing."""
    with case.source() as source, tempfile.TemporaryDirectory(prefix="Ärger mit [x] ") as other:
        moved = case.write(Path(other), case.slices)
        must_be_same(case.make().read(source), case.make().read(moved), "when it lies in another folder")


def _replace(path: Path, content: bytes) -> None:
    """Put another file in the place of `path`; who has the old one open or mapped keeps it."""
    fresh = path.with_name(f"{path.name}.new")
    fresh.write_bytes(content)
    fresh.replace(path)


@contextmanager
def _listed_in_order(seed: int) -> Iterator[None]:
    """Make every listing of a folder come in an order of its own."""
    listdir, scandir = os.listdir, os.scandir

    def shuffled_names(*arguments: Any) -> list[Any]:
        names = listdir(*arguments)
        random.Random(seed).shuffle(names)
        return names

    class Shuffled:
        def __init__(self, *arguments: Any) -> None:
            with scandir(*arguments) as entries:
                listed = list(entries)
            random.Random(seed).shuffle(listed)
            self._entries = iter(listed)

        def __enter__(self) -> Iterator[Any]:
            return self._entries

        def __exit__(self, *_: object) -> None:
            pass

        def __iter__(self) -> Iterator[Any]:
            return self._entries

        def __next__(self) -> Any:  # os.walk asks for one entry after the other
            return next(self._entries)

        def close(self) -> None:
            pass

    with mock.patch("os.listdir", shuffled_names), mock.patch("os.scandir", Shuffled):
        yield


CHECKS = {
    "read-produces": produces,
    "read-frozen": frozen,
    "read-repeatable": repeatable,
    "read-no-side-effects": no_side_effects,
    "read-file-order": file_order,
    "read-lazy-slices": independent_slices,
    "read-small-memory": small_memory,
    "read-from-elsewhere": from_elsewhere,
}
