"""Reading a DICOM file's elements safely: bounded, quiet, and without a word of what is private.

pydicom asks for as many bytes as a length field claims; `ClampedFile` gives no more than there are.
Its warnings and exceptions may quote a patient's name; neither leaves this module.
"""

from __future__ import annotations

import io
import logging
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from stackloft.model.errors import InputError

if TYPE_CHECKING:
    from pydicom import Dataset

_LARGE = 1 << 16
_LOGGERS = ("pydicom", "pylibjpeg", "openjpeg", "libjpeg")
DEFLATED = "1.2.840.10008.1.2.1.99"
_MOST_INFLATED = 1 << 29
"""Bytes: a deflated data set that grows beyond this is refused."""


class ClampedFile(io.BufferedReader):
    """A file opened for reading that never makes room for more bytes than it holds.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "short"
    >>> _ = path.write_bytes(b"four")
    >>> with ClampedFile(path) as stream:
    ...     stream.read(4_000_000_000)
    b'four'
    """

    def __init__(self, path: Path) -> None:
        super().__init__(io.FileIO(path))
        self.path = path
        self.size = path.stat().st_size
        """Bytes in the file."""

    def read(self, size: int | None = -1, /) -> bytes:
        """Return the next `size` bytes, or what is left."""
        if size is not None and size > _LARGE:
            size = min(size, max(0, self.size - self.tell()))
        return super().read(size)


class _Quiet:
    """Silences warnings and the decoders' logs while any thread is inside; both are the process's own."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._inside = 0
        self._catcher: warnings.catch_warnings[None] | None = None
        self._levels: dict[str, int] = {}

    def __enter__(self) -> None:
        with self._lock:
            if self._inside == 0:
                self._catcher = warnings.catch_warnings()
                self._catcher.__enter__()
                warnings.simplefilter("ignore")
                self._levels = {name: logging.getLogger(name).level for name in _LOGGERS}
                self._log_at(dict.fromkeys(_LOGGERS, logging.CRITICAL + 1))
            self._inside += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0 and self._catcher is not None:
                self._catcher.__exit__(None, None, None)
                self._catcher = None
                self._log_at(self._levels)

    def _log_at(self, levels: dict[str, int]) -> None:
        for name, level in levels.items():
            logging.getLogger(name).setLevel(level)


_QUIET = _Quiet()


@contextmanager
def safely(path: Path, doing: str) -> Iterator[None]:
    """Turn whatever goes wrong inside into an InputError that quotes nothing of the file.

    Parameters
    ----------
    path : Path
        The file, named in the message.
    doing : str
        What was being done, for example ``its header``.

    Examples
    --------
    >>> with safely(Path("7.dcm"), "its header"):
    ...     raise ValueError("Invalid name 'Doe^Jane'")
    Traceback (most recent call last):
    stackloft.model.errors.InputError: 7.dcm: is damaged: its header cannot be read; found: ValueError; \
fix: copy it again from the scanner, or move it out of the folder
    """
    try:
        with _QUIET:
            yield
    except InputError:
        raise
    except OSError as error:
        raise InputError("cannot be opened", where=str(path), found=error.strerror) from None
    except Exception as error:  # noqa: BLE001 - damaged files raise anything; the text may be private
        raise InputError(
            f"is damaged: {doing} cannot be read",
            where=str(path),
            found=type(error).__name__,
            fix="copy it again from the scanner, or move it out of the folder",
        ) from None


def read_elements(stream: ClampedFile, keywords: tuple[str, ...]) -> Dataset:
    """Return the named top-level elements before the pixel data; nothing else is kept.

    The stream is left at the pixel data element where the file is not deflated.

    Raises
    ------
    Exception
        Whatever pydicom raises; call it within `safely`.
    """
    from pydicom import dcmread  # noqa: PLC0415 - slow to import, needed where DICOM is read

    _check_inflation(stream)
    stream.seek(0)
    return dcmread(stream, stop_before_pixels=True, force=True, specific_tags=list(keywords))


def _check_inflation(stream: ClampedFile) -> None:
    """Refuse a deflated data set that would take more than `_MOST_INFLATED` bytes."""
    import zlib  # noqa: PLC0415 - for the rare deflated file

    from pydicom.filereader import read_file_meta_info  # noqa: PLC0415

    stream.seek(0)
    if DEFLATED.encode() not in stream.read(2048):
        return
    meta = read_file_meta_info(stream.path)
    start = 144 + int(meta.FileMetaInformationGroupLength)
    stream.seek(start)
    inflater, grown = zlib.decompressobj(-zlib.MAX_WBITS), 0
    while block := stream.read(_LARGE):
        while block and not inflater.eof:
            grown += len(inflater.decompress(block, 1 << 20))
            block = inflater.unconsumed_tail
        if grown > _MOST_INFLATED:
            raise InputError("inflates beyond all measure", where=str(stream.path), found=f"{grown} bytes")
