"""Slabs of a body as a scanner sees them: grey levels with partial volume, in DICOM, NRRD, NIfTI or TIFF."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.answer import answer
from stackloft.testing.phantoms.files import made_folder, write_json
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.phantoms.scan_bruker import write_bruker
from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft.testing.phantoms.scan_grid import ScanGrid, scan_grid
from stackloft.testing.phantoms.scan_itk import write_nifti, write_nrrd
from stackloft.testing.phantoms.scan_seg import write_dicom_seg
from stackloft.testing.phantoms.scan_tiff import write_tiff
from stackloft.testing.phantoms.scan_volume import ScanVolume

WRITERS: dict[str, Callable[[ScanVolume, Path], list[Path]]] = {
    "dicom": write_dicom,
    "nrrd": write_nrrd,
    "nifti": write_nifti,
    "tiff": write_tiff,
    "dicom-seg": write_dicom_seg,
    "bruker": write_bruker,
}
"""Form to the function that writes a volume into a folder."""
SHEARED = ("dicom", "dicom-seg", "bruker")
"""Forms that can hold a tilted gantry's slices."""


@dataclass(frozen=True, slots=True)
class Scans:
    """How a phantom is scanned.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> scanner = Scans(form="nrrd", sections=5, pixel_size=2.0)
    >>> files = scanner.write(phantoms.make("cone"), Path(tempfile.mkdtemp()))
    >>> [file.name for file in files]
    ['scan.nrrd', 'answer.json']
    """

    form: str = "dicom"
    """dicom, nrrd, nifti or tiff."""
    sections: int = 12
    """Slices across the body, of equal thickness and cut at its middle."""
    empty: int = 1
    """Slices beyond either end of the body."""
    positions: tuple[float, ...] | None = None
    """mm: the slices' middles instead of `sections` and `empty`; DICOM only when they are uneven."""
    pixel_size: float = 0.6
    """mm, along a row"""
    aspect: float | None = None
    """Pitch over the pixel's side, as 10: wins over `pixel_size`."""
    stretch: float = 1.0
    """Row spacing over column spacing."""
    fill: float = 1.0
    """Slab thickness over pitch: below 1 there are gaps."""
    tilt: float = 0.0
    """Degrees of gantry tilt; DICOM only."""
    cosines: int | None = None
    """A seed of the slices' orientation in patient space; None: axial."""
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """mm: where the bench's origin lies in patient space."""
    levels: tuple[float, float] = (-1000.0, 40.0)
    """HU of air and body."""
    noise: float = 0.0
    """Standard deviation of each channel of Rician noise, HU."""
    bias: float = 0.0
    """How much weaker the signal is in the weakest corner, relative (surface coil)."""
    seed: int = 0
    """Of the noise."""
    margin: float = 6.0
    """Air around the body, mm."""
    label: int = 0
    """Above 0: a label map with this number where at least half of a voxel is body; NRRD and NIfTI."""
    slab_points: int = 7
    """Gauss–Legendre points across a slab; odd, or the half-way level falls on a step between two of them."""
    syntax: str = "explicit"
    """DICOM transfer syntax (`scan_dicom.SYNTAXES`)."""
    multiframe: bool = False
    """DICOM: one enhanced file instead of one file for each slice."""

    def __post_init__(self) -> None:
        for name in ("pixel_size", "aspect", "stretch", "fill"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise UsageError("must be above 0", where=name, found=f"{value:g}")
        if self.form not in WRITERS:
            raise UsageError("unknown form", where="form", found=self.form, expected=", ".join(WRITERS))
        if self.form not in SHEARED and self.tilt:
            raise UsageError(
                f"{self.form} cannot hold a sheared grid", where="tilt", found=f"{self.tilt:g}°", fix="dicom"
            )

    def write(self, phantom: Phantom, folder: Path) -> list[Path]:
        """Write the scan and ``answer.json`` into `folder`; return the files, the answer last.

        Raises
        ------
        UsageError
            An option that does not suit the body or the form.
        OutputError
            The system refuses; no half-written file is left.
        """
        volume = self.volume(phantom)
        made_folder(folder)
        files = WRITERS[self.form](volume, folder)
        return [*files, write_json(folder / "answer.json", answer(phantom, volume.grid.positions))]

    def volume(self, phantom: Phantom) -> ScanVolume:
        """Return the scan before it is written."""
        positions, pitch = self._slices(phantom)
        side = self.pixel_size if self.aspect is None else pitch / self.aspect
        spacing = (side * self.stretch, side)
        grid = scan_grid(phantom, positions, self.fill * pitch, spacing, self.margin, self.tilt)
        slices = tuple(self._grey(phantom, grid, k) for k in range(len(positions)))
        return ScanVolume(
            name=phantom.name,
            slices=slices,
            grid=grid,
            turn=np.eye(3) if self.cosines is None else rotation_matrix(self.cosines),
            origin=np.array(self.origin),
            label=self.label > 0,
            syntax=self.syntax,
            multiframe=self.multiframe,
            levels=self.levels,
        )

    def _slices(self, phantom: Phantom) -> tuple[FloatArray, float]:
        """Return the slices' positions and the usual pitch, mm."""
        if self.positions is not None:
            z = phantom.positions(placing=self.positions)
            return z, float(np.median(np.diff(z)))
        z = phantom.positions(self.sections, "mid")
        pitch = phantom.height / self.sections
        beyond = pitch * np.arange(1, self.empty + 1)
        return np.concatenate([z[0] - beyond[::-1], z, z[-1] + beyond]), pitch

    def _grey(self, phantom: Phantom, grid: ScanGrid, k: int) -> NDArray[np.int16]:
        covered = grid.slab(phantom, float(grid.positions[k]), self.slab_points)
        if self.label:
            return np.where(covered >= 0.5, self.label, 0).astype(np.int16)
        air, body = self.levels
        grey = air + (body - air) * covered
        if self.bias:
            grey = air + (grey - air) * self._coil(grid.shape)
        if self.noise:
            rng = np.random.default_rng((self.seed, k))
            real = grey - air + rng.normal(0.0, self.noise, grey.shape)
            grey = air + np.hypot(real, rng.normal(0.0, self.noise, grey.shape))
        return np.round(grey).astype(np.int16)

    def _coil(self, shape: tuple[int, int]) -> FloatArray:
        """Return the coil's sensitivity, 1 at the first corner and 1 − bias at the last."""
        rows, columns = (np.linspace(0.0, 0.5, side) for side in shape)
        return np.asarray(1.0 - self.bias * (rows[:, None] + columns))
