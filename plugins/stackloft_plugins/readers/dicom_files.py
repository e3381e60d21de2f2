"""Which files of a source are DICOM: a file, a folder with what is below it, a pattern, or a DICOMDIR."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_file import ClampedFile, read_elements, safely
from stackloft_plugins.readers.dicom_sniff import is_dicom
from stackloft_plugins.readers.picture_kinds import natural_key

DIRECTORY = "DICOMDIR"
RUN_MARK = "measurement.json"
"""A folder with this file holds an earlier run's output."""
_FAMILIAR = frozenset({".dcm", ".dicom", ".ima"})
_PROBED = 8
_FOLDERS_PROBED = 40


def seems_dicom(source: Path) -> bool:
    """Return whether one of the first files at `source` begins as DICOM; opens at most eight."""
    if source.is_file():
        return is_dicom(source)
    return any(is_dicom(path) for path in islice(walked(source, _FOLDERS_PROBED), _PROBED))


def dicom_files(source: Path) -> tuple[Path, ...]:
    """Return the DICOM files that `source` means, in natural order.

    Raises
    ------
    InputError
        Nothing there, no DICOM file, one that only its name says is DICOM, or a file of a DICOMDIR that
        is missing.
    """
    if source.is_file():
        if not is_dicom(source):
            raise _no_dicom(source)
        return _listed_in(source) if source.name.upper() == DIRECTORY else (source,)
    every = sorted(walked(source), key=lambda path: natural_key(path.as_posix()))
    if not every:
        what = "an empty folder" if source.is_dir() else "nothing there"
        raise InputError("no DICOM file", where=str(source), found=what)
    found = tuple(path for path in every if is_dicom(path) and path.name.upper() != DIRECTORY)
    _refuse_pretenders(every, found)
    if not found:
        raise InputError("no DICOM file", where=str(source), found=f"{len(every)} other files")
    return found


def walked(source: Path, most_folders: int | None = None) -> Iterator[Path]:
    """Yield the files of a folder and of those below it, or those that a pattern matches."""
    if not source.is_dir():
        if not source.exists() and source.parent.is_dir() and set(source.name) & set("*?["):
            yield from (path for path in source.parent.glob(source.name) if path.is_file())
        return
    for here, folders, names in islice(os.walk(source), most_folders):
        folders[:] = sorted(
            name for name in folders if name[0] != "." and not Path(here, name, RUN_MARK).exists()
        )
        yield from (Path(here, name) for name in sorted(names, key=natural_key) if name[0] != ".")


def _refuse_pretenders(every: list[Path], found: tuple[Path, ...]) -> None:
    """Refuse files that are named as the DICOM files beside them and hold no DICOM."""
    if len(found) == len(every):
        return
    known = set(found)
    suffixes = {(path.parent, path.suffix.lower()) for path in found}
    for path in every:
        like = (path.parent, path.suffix.lower()) in suffixes or path.suffix.lower() in _FAMILIAR
        if path not in known and path.name.upper() != DIRECTORY and like and not _is_text(path):
            raise _no_dicom(path)


def _no_dicom(path: Path) -> InputError:
    exists = path.is_file()
    size = path.stat().st_size if exists else 0
    return InputError(
        "is no DICOM file" if exists else "does not exist",
        where=str(path),
        found="an empty file" if size == 0 else f"{size} bytes that begin otherwise",
        fix="copy it again from the scanner, or move it out of the folder",
    )


def _is_text(path: Path) -> bool:
    """Return whether a file is a note that somebody put there."""
    try:
        with path.open("rb") as stream:
            head = stream.read(512)
        return bool(head) and b"\0" not in head and head.decode("utf-8", "strict") != ""
    except (OSError, UnicodeDecodeError):
        return False


def _listed_in(directory: Path) -> tuple[Path, ...]:
    """Return the image files that a DICOMDIR names."""
    with safely(directory, "its directory records"), ClampedFile(directory) as stream:
        records = read_elements(stream, ("DirectoryRecordSequence",)).get("DirectoryRecordSequence") or ()
        named = [record.get("ReferencedFileID") for record in records]
    parts = [(name,) if isinstance(name, str) else tuple(name) for name in named if name]
    paths = [_inside(directory, tuple(str(part) for part in item)) for item in parts]
    if not paths:
        raise InputError("names no files", where=str(directory))
    return tuple(dict.fromkeys(paths))


def _inside(directory: Path, parts: tuple[str, ...]) -> Path:
    """Return the file that a DICOMDIR names, in whatever case its name was written to the disk."""
    here = directory.parent
    for part in parts:
        choices = [here / part, here / part.lower(), here / part.upper()]
        safe = part not in {"", ".", ".."} and Path(part).name == part
        there = next((path for path in choices if safe and path.exists()), None)
        if there is None:
            raise InputError(
                "names a file that is not there",
                where=str(directory),
                found="/".join(parts) if safe else "a path that leads out of the folder",
                fix="give the folder instead, to read the files that are there",
            )
        here = there
    return here
