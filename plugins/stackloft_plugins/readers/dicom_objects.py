"""Which DICOM files are no pictures: structure sets and segmentations, told by their SOP class.

The class stands in the first elements of the file, as text; no element need be parsed to find it.
"""

from __future__ import annotations

import re
from pathlib import Path

from stackloft_plugins.readers.dicom_files import walked
from stackloft_plugins.readers.dicom_sniff import begins_as_dicom

RTSTRUCT, SEGMENTATION = "RTSTRUCT", "SEG"
_HEAD = 2048
_PROBED = 40
_CLASS = rb"1\.2\.840\.10008\.5\.1\.4\.1\.1\."
_KINDS = {
    RTSTRUCT: re.compile(_CLASS + rb"481\.3(?![0-9.])"),
    SEGMENTATION: re.compile(_CLASS + rb"66\.[47](?![0-9.])"),
}
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
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError:
        return ""
    if not begins_as_dicom(head):
        return ""
    return next((kind for kind, pattern in _KINDS.items() if pattern.search(head)), "")


def objects_at(source: Path, kind: str) -> tuple[Path, ...]:
    """Return the files of that kind: `source` itself, or those in the folder and below it, in natural order."""
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


def _is_dicom(path: Path) -> bool:
    with path.open("rb") as stream:
        return begins_as_dicom(stream.read(_HEAD))
