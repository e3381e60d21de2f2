"""A file is written whole or not at all.

The bytes go to a hidden neighbour in the same folder, are forced to the disk, and take the file's name in
one step. Whatever happens before that step (an error, a full disk, Ctrl-C) leaves an older file of that name
untouched and the neighbour removed.
"""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from stackloft.model.errors import OutputError
from stackloft.registry.work_notes import note

_FIXES = {
    errno.ENOSPC: "free some disk space or give --out another disk",
    errno.EDQUOT: "free some disk space or give --out another disk",
    errno.EFBIG: "free some disk space or give --out another disk",
    errno.EROFS: "give --out a folder that can be written",
    errno.EACCES: "give --out a folder that you may write",
    errno.EPERM: "give --out a folder that you may write",
}


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Open a stream whose bytes become `path` when the block ends well and vanish otherwise.

    Raises
    ------
    OutputError
        The system refuses: no space, no permission, no such folder.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with whole_file(folder / "a.txt") as stream:
    ...     _ = stream.write(b"all of it")
    >>> (folder / "a.txt").read_text(), len(list(folder.iterdir()))
    ('all of it', 1)
    """
    neighbour = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    note("part", str(neighbour.absolute()))
    try:
        with neighbour.open("xb") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        neighbour.replace(path)
    except OSError as error:
        raise refusal(error, path) from error
    finally:
        with suppress(OSError):
            neighbour.unlink(missing_ok=True)
        note("gone", str(neighbour.absolute()))


def writable_folder(path: Path) -> Path:
    """Make the folder `path` if it is missing, prove that a file can be made in it, and return it.

    Asked before a measurement, so that nobody waits for figures that cannot be written.

    Raises
    ------
    OutputError
        The folder cannot be made or written.
    """
    probe = path / f".{secrets.token_hex(4)}.part"
    try:
        path.mkdir(parents=True, exist_ok=True)
        probe.touch(exist_ok=False)
        probe.unlink()
    except OSError as error:
        raise refusal(error, path) from error
    return path


def refusal(error: OSError, path: Path | str) -> OutputError:
    """Return the OutputError that says what the system refused about `path`, and the fix."""
    if isinstance(error, (FileExistsError, NotADirectoryError)):
        return OutputError("is a file, not a folder", where=str(path), fix="give --out a folder")
    reason = (error.strerror or str(error)).lower()
    return OutputError(f"cannot be written: {reason}", where=str(path), fix=_FIXES.get(error.errno or 0))
