"""Which files of a folder are the slices, in which order."""

from __future__ import annotations

from collections import Counter
from fnmatch import fnmatch
from pathlib import Path

from stackloft.model.errors import InputError
from stackloft_plugins.readers.picture_decode import PictureHeader
from stackloft_plugins.readers.picture_kinds import READABLE, SUFFIXES, natural_key, picture_kind

_WILD = frozenset("*?[")


def split_source(source: Path) -> tuple[Path, str]:
    """Return the folder and the pattern of file names that `source` means.

    Examples
    --------
    >>> split_source(Path("apple/slice_*.png"))[1]
    'slice_*.png'
    """
    if not source.exists() and _WILD & set(source.name):
        return source.parent, source.name
    return source, "*"


def list_pictures(
    source: Path, left_out: frozenset[str] = frozenset()
) -> tuple[tuple[Path, ...], tuple[int, ...]]:
    """Return the pictures of a folder in natural order, and which of them are meant.

    What is a picture is decided by content. Hidden files, folders, and files that neither are nor
    promise to be pictures are passed over.

    Parameters
    ----------
    source : Path
        A folder, or a folder and a pattern such as ``apple/slice_*.png``.
    left_out : frozenset of str
        File names that are no slices (masks).

    Returns
    -------
    pictures : tuple of Path
        Every picture of the folder.
    numbers : tuple of int
        The numbers, from 0, of those that the pattern matches: all of them without a pattern.

    Raises
    ------
    InputError
        No such folder, no picture in it, or a file that promises a picture and cannot be measured.
    """
    folder, pattern = split_source(source)
    if not folder.is_dir():
        raise InputError(
            "is no folder of pictures" if folder.exists() else "does not exist",
            where=str(folder),
            expected="a folder with one picture per slice",
        )
    files = [path for path in _listed(folder) if path.name not in left_out]
    meant = {path for path in files if fnmatch(path.name, pattern)}
    pictures = tuple(path for path in files if _is_slice(path, strict=path in meant))
    numbers = tuple(number for number, path in enumerate(pictures) if path in meant)
    if not numbers:
        raise InputError(
            "no pictures here",
            where=str(source),
            found=f"{len(meant)} other files" if meant else "no file",
            expected="JPEG, PNG, TIFF, BMP or WebP pictures, one per slice",
        )
    return pictures, numbers


def _listed(folder: Path) -> list[Path]:
    try:
        found = [path for path in folder.iterdir() if not path.name.startswith(".") and path.is_file()]
    except OSError as error:
        raise InputError("cannot be listed", where=str(folder), found=error.strerror or str(error)) from error
    return sorted(found, key=lambda path: natural_key(path.name))


def _is_slice(path: Path, *, strict: bool) -> bool:
    """Return whether a file is a picture; when `strict`, one that only promises to be is an error."""
    try:
        kind = picture_kind(path)
    except OSError as error:
        raise InputError("cannot be opened", where=str(path), found=error.strerror or str(error)) from error
    if kind in READABLE or not strict:
        return kind in READABLE
    if kind is not None:
        raise InputError(
            "this picture format is not read",
            where=str(path),
            found=kind,
            expected="JPEG, PNG, TIFF, BMP or WebP",
            fix=_conversion(kind, path),
        )
    if path.suffix.lower() in SUFFIXES:
        size = path.stat().st_size
        raise InputError(
            "is no picture, though its name says so",
            where=str(path),
            found="an empty file" if size == 0 else f"{size} bytes that begin as no known picture",
            fix="copy it again from the camera, or move it out of the folder",
        )
    return False


def _conversion(kind: str, path: Path) -> str:
    if kind == "HEIC":
        return f"heif-convert -q 95 {path.name} {path.stem}.jpg, or set the camera to 'most compatible'"
    return f"magick {path.name} {path.stem}.png"


def check_sizes(headers: tuple[PictureHeader, ...]) -> None:
    """Raise InputError naming the pictures whose size is not that of most others."""
    counts = Counter(header.size for header in headers)
    if len(counts) == 1:
        return
    (usual, number), *_ = counts.most_common()
    odd = [header for header in headers if header.size != usual]
    turned = all(header.size == usual[::-1] for header in odd)
    listed = ", ".join(f"{header.path.name} ({_text(header.size)})" for header in odd[:5])
    more = f" and {len(odd) - 5} more" if len(odd) > 5 else ""
    raise InputError(
        "slices have different sizes",
        where=str(headers[0].path.parent),
        found=listed + more,
        expected=f"{_text(usual)} pixels as the other {number}",
        fix="turn them as the others" if turned else "crop all slices alike, or move what is no slice away",
    )


def _text(size: tuple[int, int]) -> str:
    return f"{size[1]} × {size[0]}"
