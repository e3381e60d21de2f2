"""ParaVision's reconstructed pictures (Bruker): a ``2dseq`` with its ``visu_pars`` beside it.

::

    study/3/pdata/1/2dseq        the numbers, frame after frame
                   /visu_pars    what they mean: type, byte order, scale, where every frame lies
                   /reco         the reconstruction's own record of type and byte order, which must agree

Of a subject nothing is read. A scan's slices may be in several packages (slices of several directions), and
each place may have several frames (echoes, time points); one of each is measured.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import IntArray, frozen_floats, read_only
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft_plugins.readers.dicom_series import PARALLEL
from stackloft_plugins.readers.jcamp import read_parameters
from stackloft_plugins.readers.slab_notices import slab_notices
from stackloft_plugins.readers.slice_geometry import place_slices
from stackloft_plugins.readers.visu_frames import TYPES, VisuFrames, visu_frames
from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack

_CONFIDENCE = 0.95
_HEAD = 1 << 14
DATA, VISU, RECO = "2dseq", "visu_pars", "reco"
_COMPLEX = "COMPLEX_IMAGE"


@dataclass(frozen=True, slots=True)
class BrukerReader:
    """Reads a ParaVision reconstruction into a `SliceStack` of slabs; slices are read on demand.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = phantoms.write_phantom("cone", "bruker", folder, sections=5, pixel_size=2.0)
    >>> stack = BrukerReader().read(folder)
    >>> len(stack), stack.kind.value, stack.provenance["grey scale"]
    (7, 'slab', 'stored values by VisuCoreDataSlope and VisuCoreDataOffs')
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)

    package: int | None = option(
        None, "which package of parallel slices, from 1; the largest if not given", ge=1
    )
    volume: int | None = option(
        None, "which of several frames at the same places (echoes, time points), from 1", ge=1
    )
    allow_gaps: bool = option(False, "keep a gap that looks like a missing slice")

    def probe(self, path: Path) -> float:
        """Return 0.95 for a ``2dseq`` or ``visu_pars``, or a folder with one reconstruction; 0 otherwise."""
        try:
            found = _reconstructions(path)
            return _CONFIDENCE if len(found) == 1 and _describes_frames(found[0] / VISU) else 0.0
        except OSError:
            return 0.0

    def read(self, path: Path) -> SliceStack:
        """Return the stack.

        Parameters
        ----------
        path : Path
            The ``2dseq``, its folder, or the scan's folder when it has one reconstruction.

        Raises
        ------
        InputError
            Parameters that are missing, impossible or contradict each other (each is named); numbers that
            are cut off; a missing or doubled slice; several frames at the same places.
        """
        folder = _folder(path)
        visu = read_parameters(folder / VISU)
        frames = visu_frames(visu)
        kind = visu.words("VisuCoreFrameType") if "VisuCoreFrameType" in visu else []
        if _COMPLEX in kind:
            raise InputError(
                "holds complex numbers", where=str(folder / VISU), found=_COMPLEX, expected="MAGNITUDE_IMAGE",
                fix="reconstruct magnitude pictures",
            )  # fmt: skip
        _check_reconstruction(folder, frames)
        values = _mapped(folder / DATA, frames)
        own = {
            "positions": "VisuCorePosition along the normal",
            "pixel size": "VisuCoreExtent over VisuCoreSize",
            "grey scale": "stored values by VisuCoreDataSlope and VisuCoreDataOffs",
        }
        if len(frames.shape) == 3:
            return self._block(frames, values, folder, own)
        return self._slices(frames, values, folder, own)

    def _block(self, frames: VisuFrames, values: Any, folder: Path, own: dict[str, str]) -> SliceStack:
        """Return the stack of one three-dimensional frame."""
        number, notices = self._one_of(frames.count, "volumes", folder)
        turn = frames.axes[number]
        count = frames.shape[0]
        grid = VoxelGrid(
            shape=(count, frames.shape[1], frames.shape[2]),
            spacing=(frames.spacing[1], frames.spacing[2]),
            positions=frozen_floats(frames.spacing[0] * np.arange(count)),
            origin=frames.positions[number],
            direction=turn.T,
        )
        order = np.arange(count)[::-1] if frames.backwards else np.arange(count)
        slope, offset = frames.slope[number], frames.offset[number]
        return volume_stack(
            grid, lambda k: _scaled(values[number, order[k]], slope, offset), folder / DATA, own, notices
        )

    def _slices(self, frames: VisuFrames, values: Any, folder: Path, own: dict[str, str]) -> SliceStack:
        """Return the stack of two-dimensional frames."""
        slices, repeats = frames.grid()
        repeat, notices = self._one_of(int(repeats.max()) + 1, "frames at each place", folder)
        chosen = np.flatnonzero(repeats == repeat)
        chosen = chosen[np.argsort(slices[chosen], kind="stable")]
        packages = _packages(frames, chosen)
        package, more = self._package(packages, folder)
        mine = packages[package]
        stored = _stored_frames(frames, chosen, mine, len(packages), folder)
        if len(mine) < 2:
            raise InputError(
                "one slice makes no body", where=str(folder / DATA), expected="at least 2 slices"
            )
        names = [f"{DATA}[{number + 1}]" for number in stored]
        slab = frames.thickness
        thickness = None if slab is None else np.full(len(mine), slab)
        axes = frames.axes[mine[0], :2]
        placed = place_slices(
            frames.positions[mine], axes, names, thickness, min(frames.spacing), allow_gaps=self.allow_gaps
        )
        slabs = None if slab is None else frozen_floats(np.full(len(mine), slab))
        count = len(mine)
        return SliceStack(
            decode=_decoder(values, stored[placed.order], frames, mine[placed.order]),
            names=tuple(names[k] for k in placed.order),
            shape=(frames.shape[0], frames.shape[1]),
            positions=placed.positions,
            pixel_spacing=frozen_floats(np.tile(frames.spacing, (count, 1))),
            kind=SectionKind.SLAB,
            thickness=slabs,
            affine=placed.affine,
            hints=load_stack_file(folder).hints(folder, {k: k for k in range(1, count + 1)}),
            notices=(*notices, *more, *placed.notices, *slab_notices(placed.positions, slabs)),
            provenance=own,
        )

    def _one_of(self, count: int, what: str, folder: Path) -> tuple[int, tuple[Notice, ...]]:
        if self.volume is not None and self.volume > count:
            raise UsageError(
                "no such volume",
                where="--set bruker.volume",
                found=str(self.volume),
                expected=f"1 to {count}",
            )
        if count == 1:
            return 0, ()
        if self.volume is None:
            raise InputError(
                f"holds {count} {what} (echoes, time points)",
                where=str(folder / DATA),
                fix=f"choose one: --set bruker.volume=1 … {count}",
            )
        text = f"volume {self.volume} of {count} at the same places was taken"
        return self.volume - 1, (Notice("one-volume", text),)

    def _package(self, packages: list[IntArray], folder: Path) -> tuple[int, tuple[Notice, ...]]:
        counts = ", ".join(f"{k}: {len(mine)} slices" for k, mine in enumerate(packages, start=1))
        if self.package is not None:
            if self.package > len(packages):
                raise UsageError(
                    "no such package", where="--set bruker.package", found=str(self.package), expected=counts
                )
            return self.package - 1, ()
        largest = max(range(len(packages)), key=lambda k: len(packages[k]))
        if len(packages) == 1:
            return largest, ()
        text = (
            f"{folder.name}: {len(packages)} packages of parallel slices are here ({counts}); the largest "
            f"was taken: choose with --set bruker.package={largest + 1}"
        )
        return largest, (Notice("several-packages", text),)


def _scaled(stored: Picture, slope: float, offset: float) -> Picture:
    """Return the numbers by their scale.

    Raises
    ------
    InputError
        Some are no numbers, or leave all bounds.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        picture = stored.astype(np.float32) * np.float32(slope) + np.float32(offset)
    if not np.isfinite(picture).all():
        raise InputError("is damaged: it holds values that are no numbers", where=DATA)
    return read_only(picture)


def _decoder(values: Any, stored: IntArray, frames: VisuFrames, meant: IntArray) -> Callable[[int], Picture]:
    def decode(number: int) -> Picture:
        frame = int(meant[number])
        return _scaled(values[int(stored[number])], float(frames.slope[frame]), float(frames.offset[frame]))

    return decode


def _packages(frames: VisuFrames, chosen: IntArray) -> list[IntArray]:
    """Return the frames of each package: slices that follow each other and are parallel."""
    turns = frames.axes[chosen, :2]
    apart = np.abs(np.diff(turns, axis=0)).max(axis=(1, 2)) > PARALLEL
    return list(np.split(chosen, np.flatnonzero(apart) + 1))


def _stored_frames(
    frames: VisuFrames, chosen: IntArray, mine: IntArray, packages: int, folder: Path
) -> IntArray:
    """Return where the frames that are described lie in the file: elsewhere when slices are stored backwards.

    Raises
    ------
    InputError
        Backwards, with several packages: programs differ over what that means.
    """
    if not frames.backwards:
        return mine
    if packages > 1:
        raise InputError(
            "several packages of slices are stored backwards, and it is not settled which frame is which",
            where=str(folder / VISU),
            found="VisuCoreDiskSliceOrder=disk_reverse_slice_order",
            fix="export the scan as DICOM",
        )
    return chosen[::-1]


def _check_reconstruction(folder: Path, frames: VisuFrames) -> None:
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


def _mapped(path: Path, frames: VisuFrames) -> Any:
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


def _folder(path: Path) -> Path:
    found = _reconstructions(path)
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


def _describes_frames(path: Path) -> bool:
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    return b"##" in head and b"##$VisuCore" in head


def _reconstructions(path: Path) -> list[Path]:
    """Return the folders with a ``2dseq`` and its ``visu_pars``: this one, or those in ``pdata``."""
    if path.is_file():
        path = path.parent if path.name in {DATA, VISU} else path
    candidates = [path, *sorted((path / "pdata").glob("*"))] if path.is_dir() else []
    return [folder for folder in candidates if (folder / DATA).is_file() and (folder / VISU).is_file()]
