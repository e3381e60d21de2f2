"""Files of a phantom: written whole or not at all, refusals in the house's words."""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from stackloft.model.errors import OutputError


def made_folder(folder: Path) -> Path:
    """Make `folder` if it is missing and return it.

    Raises
    ------
    OutputError
        It cannot be made, or a file is in its way.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _refusal(error, folder) from error
    return folder


def write_whole(path: Path, content: bytes) -> Path:
    """Write `content` to a hidden neighbour, then give it the file's name in one step; return `path`.

    Raises
    ------
    OutputError
        The system refuses; an older file of that name is left as it was.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "answer.json"
    >>> write_whole(path, b"{}").read_bytes()
    b'{}'
    """
    neighbour = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        neighbour.write_bytes(content)
        neighbour.replace(path)
    except OSError as error:
        raise _refusal(error, path) from error
    finally:
        with suppress(OSError):
            neighbour.unlink(missing_ok=True)
    return path


def write_json(path: Path, content: Mapping[str, Any]) -> Path:
    """Write `content` as indented JSON; return `path`."""
    return write_whole(path, (json.dumps(content, indent=2, allow_nan=False) + "\n").encode())


def _refusal(error: OSError, path: Path) -> OutputError:
    if isinstance(error, (FileExistsError, NotADirectoryError)):
        return OutputError("is a file, not a folder", where=str(path), fix="give another folder")
    reason = (error.strerror or str(error)).lower()
    return OutputError(
        f"cannot be written: {reason}", where=str(path), fix="give a folder with space that you may write"
    )
