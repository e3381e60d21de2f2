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
from stackloft_plugins.readers.bruker_files import (
    DATA,
    VISU,
    check_reconstruction,
    describes_frames,
    folder_of,
    mapped,
    reconstructions,
)
from stackloft_plugins.readers.jcamp import read_parameters
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.slab_notices import slab_notices
from stackloft_plugins.readers.slice_geometry import place_slices
from stackloft_plugins.readers.visu_frames import VisuFrames, visu_frames
from stackloft_plugins.readers.visu_packages import packages_of, stored_frames
from stackloft_plugins.readers.volume_stack import VoxelGrid, volume_stack

_CONFIDENCE = 0.95
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
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.95 for a ``2dseq`` or ``visu_pars``, or a folder with one reconstruction; 0 otherwise."""
        try:
            found = reconstructions(path)
            return _CONFIDENCE if len(found) == 1 and describes_frames(found[0] / VISU) else 0.0
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
        folder = folder_of(path)
        visu = read_parameters(folder / VISU)
        frames = visu_frames(visu)
        kind = visu.words("VisuCoreFrameType") if "VisuCoreFrameType" in visu else []
        if _COMPLEX in kind:
            raise InputError(
                "holds complex numbers", where=str(folder / VISU), found=_COMPLEX, expected="MAGNITUDE_IMAGE",
                fix="reconstruct magnitude pictures",
            )  # fmt: skip
        check_reconstruction(folder, frames)
        values = mapped(folder / DATA, frames)
        own = {
            "positions": "VisuCorePosition along the normal",
            "pixel size": "VisuCoreExtent over VisuCoreSize",
            "grey scale": "stored values by VisuCoreDataSlope and VisuCoreDataOffs",
        }
        if len(frames.shape) == 3:
            return with_scale(self._block(frames, values, folder, own), self.scale_uncertainty, path)
        return with_scale(self._slices(frames, values, folder, own), self.scale_uncertainty, path)

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
        packages = packages_of(frames, chosen)
        package, more = self._package(packages, folder)
        mine = packages[package]
        stored = stored_frames(frames, chosen, mine, len(packages), folder)
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
