"""Which DICOM files are no pictures: structure sets and segmentations, told by their SOP class.

The class stands in the first elements of the file, as text; no element need be parsed to find it.
"""

from __future__ import annotations

import re
from pathlib import Path

from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft_plugins.readers.dicom_files import walked
from stackloft_plugins.readers.dicom_sniff import begins_as_dicom, first_bytes

RTSTRUCT, SEGMENTATION = "RTSTRUCT", "SEG"
_HEAD = 2048
_PROBED = 40
_NAMED = 5
_CLASS = rb"1\.2\.840\.10008\.5\.1\.4\.1\.1\."
_KINDS = re.compile(_CLASS + rb"(?:(481\.3)|66\.[47])(?![0-9.])")
CONFIDENCE = 0.95
"""Of a reader whose kind a file is: surer than the reader of pictures is of any DICOM file."""


def object_kind(path: Path) -> str:
    """Return ``RTSTRUCT``, ``SEG``, or nothing for any other file.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a"
    >>> _ = path.write_bytes(bytes(128) + b"DICM...1.2.840.10008.5.1.4.1.1.481.3" + bytes(9))
    >>> object_kind(path)
    'RTSTRUCT'
    """
    try:
        head = first_bytes(path, _HEAD)
    except OSError:
        return ""
    if not begins_as_dicom(head):
        return ""
    found = _KINDS.findall(head)
    return "" if not found else RTSTRUCT if any(found) else SEGMENTATION


def objects_at(source: Path, kind: str) -> tuple[Path, ...]:
    """Return the files of that kind: `source`, or those in the folder and below it, in natural order."""
    files = (source,) if source.is_file() else tuple(walked(source))
    return tuple(path for path in files if object_kind(path) == kind)


def object_confidence(source: Path, kind: str) -> float:
    """Return 0.95 for a file of that kind, or a folder of such files alone; 0 otherwise.

    A folder that holds pictures as well is a scan with something drawn on it: the scan is measured unless
    the other file is named itself.
    """
    try:
        if source.is_file():
            return CONFIDENCE if object_kind(source) == kind else 0.0
        files = [path for _, path in zip(range(_PROBED), walked(source), strict=False)]
        kinds = {object_kind(path) for path in files if _is_dicom(path)}
    except (OSError, ValueError):
        return 0.0
    return CONFIDENCE if kinds == {kind} else 0.0


def without_objects(files: tuple[Path, ...]) -> tuple[tuple[Path, ...], tuple[Notice, ...]]:
    """Return the files that may be pictures, and a notice of those that are not.

    Raises
    ------
    InputError
        None may be a picture.
    """
    kinds = {path: object_kind(path) for path in files}
    pictures = tuple(path for path in files if not kinds[path])
    others = [path for path in files if kinds[path]]
    if not others:
        return pictures, ()
    named = ", ".join(f"{path.name} ({kinds[path]})" for path in others[:_NAMED])
    if not pictures:
        raise InputError(
            "holds no pictures",
            where=str(others[0].parent),
            found=named,
            fix="leave out --reader dicom: structure sets and segmentations have readers of their own",
        )
    text = f"{len(others)} files are no pictures and are left out: {named}; measure them by naming the file"
    return pictures, (Notice("left-out", text),)


def _is_dicom(path: Path) -> bool:
    return begins_as_dicom(first_bytes(path, _HEAD))
