"""A ParaVision reconstruction's files: where they are, whether they agree, the numbers mapped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.errors import InputError
from stackloft_plugins.readers.jcamp import read_parameters
from stackloft_plugins.readers.visu_frames import TYPES, VisuFrames

DATA, VISU, RECO = "2dseq", "visu_pars", "reco"
_HEAD = 1 << 14


def check_reconstruction(folder: Path, frames: VisuFrames) -> None:
    """Refuse a ``reco`` beside it that names another type or byte order."""
    if not (folder / RECO).is_file():
        return
    reco = read_parameters(folder / RECO)
    words = {"RECO_wordtype": TYPES, "RECO_byte_order": {"littleEndian": "<", "bigEndian": ">"}}
    said = {name: choices.get(reco.word(name)) for name, choices in words.items() if name in reco}
    kind = said.get("RECO_wordtype") or frames.dtype.str[1:]
    order = said.get("RECO_byte_order") or frames.dtype.str[0]
    single = frames.dtype.itemsize == 1
    if kind != frames.dtype.str[1:] or (order != frames.dtype.str[0] and not single):
        raise InputError(
            "reco and visu_pars contradict each other",
            where=str(folder),
            found=f"{order}{kind} and {frames.dtype.str}",
            fix="copy the whole reconstruction again",
        )


def mapped(path: Path, frames: VisuFrames) -> Any:
    """Return the file's numbers, (frames, …), mapped; nothing is read yet.

    Raises
    ------
    InputError
        The file has another size than ``visu_pars`` says.
    """
    expected = frames.count * int(np.prod(frames.shape, dtype=object)) * frames.dtype.itemsize
    try:
        size = path.stat().st_size
        if size != expected:
            raise InputError(
                "has another size than visu_pars says",
                where=str(path),
                found=f"{size} bytes",
                expected=f"{expected} bytes: {frames.count} frames of "
                f"{' × '.join(map(str, frames.shape[::-1]))} {frames.dtype}",
                fix="copy the file again",
            )
        return np.memmap(path, dtype=frames.dtype, mode="r", shape=(frames.count, *frames.shape))
    except OSError as error:
        raise InputError("cannot be opened", where=str(path), found=error.strerror) from error


def folder_of(path: Path) -> Path:
    """Return the folder of the one reconstruction that `path` means.

    Raises
    ------
    InputError
        There is none, or several.
    """
    found = reconstructions(path)
    if len(found) == 1:
        return found[0]
    if not path.exists():
        raise InputError("no such file or folder", where=str(path))
    raise InputError(
        f"holds {len(found)} reconstructions" if found else "holds no 2dseq with visu_pars",
        where=str(path),
        found=", ".join(folder.relative_to(path).as_posix() for folder in found[:8]),
        fix="name the folder of one" if found else "give the folder pdata/N of a scan",
    )


def describes_frames(path: Path) -> bool:
    """Return whether a parameter file begins to describe frames."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    return b"##" in head and b"##$VisuCore" in head


def reconstructions(path: Path) -> list[Path]:
    """Return the folders with a ``2dseq`` and its ``visu_pars``: this one, or those in ``pdata``."""
    if path.is_file():
        path = path.parent if path.name in {DATA, VISU} else path
    candidates = [path, *sorted((path / "pdata").glob("*"))] if path.is_dir() else []
    return [folder for folder in candidates if (folder / DATA).is_file() and (folder / VISU).is_file()]
