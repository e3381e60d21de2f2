"""A source's fingerprint: the same files give the same figures, and the report says which files.

BLAKE3 (O'Connor, Aumasson, Neves & Wilcox-O'Hearn 2020) takes a quarter of SHA-256's time.
"""

from __future__ import annotations

import dataclasses
import os
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Self

import numpy as np
from blake3 import blake3

from stackloft.model.errors import InputError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Picture, SliceStack

_BLOCK = 1 << 20
RUN_MARK = "measurement.json"
"""A folder below the source with this file in it holds a run's output and is no part of the source."""


def digest_of(source: Path, wanted: Callable[[], bool] = lambda: True) -> str:
    """Return the BLAKE3 over the names (relative, sorted) and contents of the source's files.

    Parameters
    ----------
    source : Path
        A file, a folder (with what is below it; hidden files and earlier runs' output folders left
        out), or a folder with a pattern of file names.
    wanted : callable
        Asked now and then; when it says no, the rest is left out, and what is returned means nothing.

    Raises
    ------
    InputError
        A file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "a.txt").write_text("one")
    ...     digest_of(Path(folder)) == digest_of(Path(folder) / "*.txt")
    True
    """
    whole = blake3()
    block = memoryview(bytearray(_BLOCK))
    for name, path in sorted(_files(source)):
        content = blake3()
        try:
            with Path(path).open("rb", buffering=0) as stream:
                while wanted() and (size := stream.readinto(block)):
                    content.update(block[:size])
        except OSError as error:
            raise InputError("cannot be read", where=path, found=error.strerror) from error
        whole.update(name.encode() + b"\0" + content.digest())
    return whole.hexdigest()


class DigestMeanwhile:
    """Takes a source's fingerprint in a thread of its own while the run goes on.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "a.txt").write_text("one")
    ...     with DigestMeanwhile(Path(folder)) as digest:
    ...         digest.value() == digest_of(Path(folder))
    True
    """

    def __init__(self, source: Path) -> None:
        self.seconds = 0.0
        """How long it took, once `value` has been asked for."""
        self._given_up = False
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="stackloft-digest")
        self._value = self._pool.submit(self._taken, source)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._given_up = True
        self._pool.shutdown()

    def value(self) -> str:
        """Return the fingerprint when it is there.

        Raises
        ------
        InputError
            A file cannot be read.
        """
        return self._value.result()

    def _taken(self, source: Path) -> str:
        start = time.perf_counter()
        try:
            return digest_of(source, lambda: not self._given_up)
        finally:
            self.seconds = time.perf_counter() - start


def _files(source: Path) -> Iterator[tuple[str, str]]:
    """Yield the names, relative to the source's folder, and the paths of its files."""
    if source.is_file():
        yield source.name, str(source)
    elif not source.is_dir():
        yield from ((item.name, str(item)) for item in source.parent.glob(source.name) if item.is_file())
    else:
        for here, folders, names in os.walk(source):
            inside = Path(here).relative_to(source).as_posix()
            before = "" if inside == "." else f"{inside}/"
            folders[:] = [
                x for x in folders if not x.startswith(".") and not Path(here, x, RUN_MARK).exists()
            ]
            paths = ((x, os.path.join(here, x)) for x in names if not x.startswith("."))  # noqa: PTH118 - likewise
            yield from ((before + x, path) for x, path in paths if os.path.isfile(path))  # noqa: PTH113


def digest_of_value(value: Any) -> str:
    """Return the BLAKE3 over what a product in memory holds: arrays, numbers and text, not functions.

    Examples
    --------
    >>> from stackloft.model.contour_stack import ContourStack
    >>> len(digest_of_value(ContourStack(())))
    64
    """
    whole = blake3()
    for part in _parts(value):
        whole.update(part + b"\0")
    return whole.hexdigest()


def _parts(value: Any) -> Iterator[bytes]:
    if isinstance(value, np.ndarray):
        yield f"{value.dtype.str}{value.shape}".encode() + value.tobytes()
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for item in dataclasses.fields(value):
            yield item.name.encode()
            yield from _parts(getattr(value, item.name))
    elif isinstance(value, (tuple, list)):
        yield str(len(value)).encode()
        for part in value:
            yield from _parts(part)
    elif isinstance(value, Mapping):
        yield from _parts(sorted((str(key), item) for key, item in value.items()))
    elif not callable(value):
        yield repr(value).encode()


class PictureDigest:
    """Takes the fingerprint of slices that come from memory while they are decoded for other reasons.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> stack = SliceStack(lambda k: np.full((4, 4), k), ("a", "b"), (4, 4), np.arange(2.0), np.ones((2, 2)),
    ...                    SectionKind.SLAB)
    >>> digest = PictureDigest()
    >>> tapped = digest.tapped(stack)
    >>> _ = tapped.decode(1), tapped.decode(0)
    >>> len(digest.value(stack))
    64
    """

    def __init__(self) -> None:
        self._slices: dict[int, bytes] = {}

    def tapped(self, product: Any) -> Any:
        """Return a SliceStack or Segmentation that tells this one of every slice decoded; else `product`."""
        if isinstance(product, Segmentation):
            return replace(product, stack=self.tapped(product.stack))
        if isinstance(product, SliceStack):
            return replace(product, decode=partial(self._decode, product.decode))
        return product

    def value(self, product: Any) -> str:
        """Return the fingerprint of the stack's geometry and the slices seen."""
        stack: SliceStack = product.stack if isinstance(product, Segmentation) else product
        whole = blake3()
        for array in (stack.positions, stack.pixel_spacing, stack.affine):
            whole.update(array.tobytes())
        for moved in (stack.origins, stack.turns):
            if moved is not None:
                whole.update(moved.tobytes())
        for index in sorted(self._slices):
            whole.update(self._slices[index])
        return whole.hexdigest()

    def _decode(self, decode: Callable[[int], Picture], number: int) -> Picture:
        picture = decode(number)
        if number not in self._slices:
            taken = blake3(f"{number}{picture.dtype.str}{picture.shape}".encode())
            taken.update(np.ascontiguousarray(picture).reshape(-1).view(np.uint8).data)
            self._slices[number] = taken.digest()
        return picture
