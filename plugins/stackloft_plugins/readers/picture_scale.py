"""The pixel size of every picture: told, from the files' resolution tags, or from a reference object.

::

    told for all / for each        s_k as told; told for the first face of a receding stack: s_0 · D_k / D_0
    flatbed scan                   25.4 mm / dpi
    reference in every picture     s_k = size / pixels_k · D_k / (D_k - h)
    reference in some              f = (D_k - h) · pixels_k / size there, s_k = D_k / f elsewhere

D_k is the distance from the lens to face k, h the object's height above it. Where D is needed and nobody
tells it, the object is taken to lie in the face's plane, and a notice says what that may cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stackloft.geometry.pinhole import face_scale, shared_origins
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.scale import ScaleUncertainty
from stackloft_plugins.readers.picture_decode import PictureHeader
from stackloft_plugins.readers.reference_sighting import EDGE_PLACE, Found
from stackloft_plugins.readers.scale_said import ScaleSaid

_INCH = 25.4


@dataclass(frozen=True, slots=True, eq=False)
class PictureScale:
    """The scale of a stack's pictures."""

    spacing: FloatArray
    """(m, 2) mm: row, column"""
    source: str
    uncertainty: ScaleUncertainty | None = None
    origins: FloatArray | None = None
    """(m, 2) mm: x, y of pixel (0, 0); None: 0 in all."""
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Bench:
    """Where the cut faces of the used pictures lie."""

    travelled: FloatArray
    """(m) mm: how far each face lies beyond that of the folder's first picture, along the axis."""
    said: ScaleSaid

    @property
    def distances(self) -> FloatArray | None:
        """(m) mm from the lens to each face; None when they are not known."""
        if self.said.distance is None or self.said.plane is None:
            return None
        moved = self.travelled if self.said.plane == "receding" else np.zeros_like(self.travelled)
        distances: FloatArray = self.said.distance + moved
        return distances

    @property
    def heights(self) -> FloatArray | None:
        """(m) mm: the reference object above each face; None when it stays and nobody says where they go."""
        heights = np.full(len(self.travelled), self.said.height)
        if not self.said.stays or self.said.plane == "fixed":
            return heights
        return heights + self.travelled if self.said.plane == "receding" else None

    @property
    def relative(self) -> FloatArray | None:
        """(m): each face's distance by that of the first; None when that is not known."""
        if self.distances is not None and self.said.distance is not None:
            return self.distances / self.said.distance
        return np.ones(len(self.travelled)) if self.said.plane == "fixed" else None

    @property
    def face_by_reference(self) -> FloatArray | None:
        """(m): pixel size on each face by that on the reference object's plane; None when not known."""
        heights = self.heights
        if heights is not None and not heights.any():
            return np.ones(len(heights))
        distances = self.distances
        if distances is None and self.said.distance is not None and not self.said.stays:
            distances = np.full(len(self.travelled), self.said.distance)  # nearly so: only h / D counts
        return None if heights is None or distances is None else face_scale(distances, heights)


def told_scale(headers: Sequence[PictureHeader], bench: Bench, told: Sequence[float | None]) -> PictureScale:
    """Return the scale that was told, by one size, one for each picture, or the files' resolution.

    Parameters
    ----------
    headers : sequence of PictureHeader
    bench : Bench
    told : sequence of float or None
        What is said of each picture by itself, mm; it wins.
    """
    said = bench.said
    if said.dpi:
        spacing = np.array([_from_dpi(header) for header in headers])
    else:
        size = np.full(len(headers), said.pixel_size or np.nan)
        size = size * (1.0 if bench.relative is None else bench.relative)
        spacing = np.column_stack([size, size])
    for k, own in enumerate(told):
        if own is not None:
            spacing[k] = own
    source = f"{said.source} (resolution tags)" if said.dpi else said.source
    return PictureScale(
        frozen_floats(spacing), source, _stated(said, len(headers)), _origins(spacing, headers, said)
    )


def measured_scale(
    headers: Sequence[PictureHeader], bench: Bench, found: Sequence[Found | None]
) -> PictureScale:
    """Return the scale that the reference object tells; it was found in one picture at least.

    Raises
    ------
    InputError
        A height above the face that would put the object behind the lens.
    """
    said = bench.said
    if said.reference is None:
        message = "there is no reference object"
        raise ValueError(message)
    pixels = np.array([np.nan if one is None else one.size.size for one in found])
    ratio = bench.face_by_reference
    if ratio is not None and not (np.isfinite(ratio).all() and (ratio > 0).all()):
        raise InputError(
            "the reference object lies behind the lens",
            where="reference_height",
            found=f"{said.height:g} mm",
            expected=f"less than {said.distance or 0:g} mm",
        )
    size = said.reference.size / pixels * (1.0 if ratio is None else ratio)
    relative = np.ones(len(pixels)) if bench.relative is None else bench.relative
    first = float(np.nanmedian(size / relative))
    size = np.where(np.isnan(size), first * relative, size)
    spacing = np.column_stack([size, size])
    return PictureScale(
        frozen_floats(spacing),
        f"{said.reference} in {np.count_nonzero(~np.isnan(pixels))} of {len(pixels)} pictures",
        _stated(said, len(headers)) or _of_reference(found, pixels),
        _origins(spacing, headers, said),
    )


def _from_dpi(header: PictureHeader) -> tuple[float, float]:
    dpi = header.tags.dpi
    if header.tags.by_camera or dpi is None:
        raise InputError(
            "its resolution tag tells no scale, for a camera took it"
            if header.tags.by_camera
            else "has no resolution tag",
            where=str(header.path),
            expected="a flatbed scan with its dots per inch",
            fix="give --pixel-size, or --reference disc:24.25mm",
        )
    across, down = dpi if header.orientation < 5 else dpi[::-1]
    return _INCH / down, _INCH / across


def _origins(spacing: FloatArray, headers: Sequence[PictureHeader], said: ScaleSaid) -> FloatArray | None:
    if np.ptp(spacing, axis=0).max() == 0:
        return None
    rows, columns = headers[0].size
    principal = said.principal or ((columns - 1) / 2, (rows - 1) / 2)
    return frozen_floats(shared_origins(spacing, principal))


def _stated(said: ScaleSaid, count: int) -> ScaleUncertainty | None:
    if said.uncertainty is None:
        return None
    return ScaleUncertainty(said.uncertainty, frozen_floats(np.zeros(count)), "stated")


def _of_reference(found: Sequence[Found | None], pixels: FloatArray) -> ScaleUncertainty:
    """Return the uncertainty of the object's own edge: its place for all, its scatter for each.

    A picture that does not show the object has its scale from the others, whose scatter counts as common.
    """
    scatter = np.array([0.0 if one is None else one.size.uncertainty / one.size.size for one in found])
    seen = ~np.isnan(pixels)
    shared = float(np.sqrt((scatter[seen] ** 2).mean() / seen.sum())) if not seen.all() else 0.0
    edge = float(np.median([2 * EDGE_PLACE * one.size.grain / one.size.size for one in found if one]))
    source = f"edge of the reference object, {np.nanmedian(pixels):.0f} pixels across"
    return ScaleUncertainty(float(np.hypot(edge, shared)), frozen_floats(scatter), source)
