"""One closed curve per section, all evaluated together.

A curve is the piecewise cubic through its loop's points: C² between corners, broken at them. The curves
of a stack share one parameter g = section + s, where s in [0, 1) is the fraction of arc length from the
curve's *canonical start*, which depends on the curve's shape alone and not on the vertex it was given
from: the phase of the first Fourier coefficient of the curve (Kuhl & Giardina 1982).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.on_curves import on_curves
from stackloft.geometry.curve_measures import CurveMeasures, along_cubics, curve_measures
from stackloft.geometry.hermite_segments import segment_tangents

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

THREADS = 2
"""Threads that fit curves, where there are many."""
AT_ONCE = 16_000
"""Vertices worked on at once, so that what is in between stays in the processor's cache."""
_FIGURES = ("lengths", "starts", "centroids", "areas", "polygon_areas")


@dataclass(frozen=True, slots=True, eq=False)
class CurveStack:
    """Closed piecewise-cubic curves, one per section; x and y apart: rows of two take longer."""

    points: FloatArray
    """(2, n) mm: segment starts, section after section."""
    ends: FloatArray
    """(2, n) mm: segment ends."""
    leaving: FloatArray
    """(2, n) dP/dx at segment starts, x in [0, 1] along the segment."""
    arriving: FloatArray
    """(2, n) dP/dx at segment ends."""
    knots: FloatArray
    """(n + 1,) global parameter of the segment starts, increasing, from first[0] to the last end."""
    first: IntArray
    """(m + 1,) first segment of each section."""
    lengths: FloatArray
    """(m,) mm: perimeters."""
    starts: FloatArray
    """(m,) arc-length fraction, from the first vertex, of the canonical start."""
    centroids: FloatArray
    """(m, 2) mm: area centroids."""
    areas: FloatArray
    """(m,) mm²"""
    polygon_areas: FloatArray
    """(m,) mm²: of the polygons through the curves' points."""

    def __len__(self) -> int:
        return len(self.lengths)

    def at(self, section: IntArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points and unit-fraction derivatives on the curves.

        Parameters
        ----------
        section : int array, broadcastable with `s`
            Section numbers.
        s : array
            Fractions of arc length from each canonical start (any real number; wraps).

        Returns
        -------
        points : (..., 2) array, mm
        derivative : (..., 2) array
            dP/ds, mm; its length is close to the perimeter.
        """
        planes = on_curves(self, section, s)
        point, slope = np.moveaxis(self._planes(section, s) if planes is None else planes, 1, -1)
        return point, slope

    def _planes(self, section: IntArray, s: FloatArray) -> FloatArray:
        """Return what `on_curves` does, all samples at once."""
        turns = s + self.starts[section]
        g = turns - np.floor(turns) + section
        # rounding can carry g to the next section's first knot: hold it to its own section
        index = np.searchsorted(self.knots, g, side="right") - 1
        index = np.clip(index, self.first[section], self.first[section + 1] - 1)
        knot = self.knots.take(index)
        span = self.knots.take(index + 1) - knot
        x = (g - knot) / span
        planes = np.empty((2, 2, *x.shape))
        for k in (0, 1):
            p0, p1, d0, d1 = (
                each[k].take(index) for each in (self.points, self.ends, self.leaving, self.arriving)
            )
            planes[0, k], along = along_cubics(p0, p1, d0, d1, x)
            np.divide(along, span, out=planes[1, k])
        return planes

    def flipped(self, flip: tuple[float, float]) -> CurveStack:
        """Return the curves with x and y multiplied by 1 or -1, counter-clockwise again.

        In one mirror each runs the other way from the same vertex; its canonical start is the mirrored one
        (y alone), or half a loop from that, since it lies to the right of the middle.
        """
        scale = np.array(flip)[:, None]
        half = 0.0 if flip[0] > 0.0 else 0.5
        centroids = self.centroids * flip
        if flip[0] * flip[1] > 0.0:
            return replace(
                self,
                points=self.points * scale,
                ends=self.ends * scale,
                leaving=self.leaving * scale,
                arriving=self.arriving * scale,
                starts=self.starts + half,
                centroids=centroids,
            )
        section = np.repeat(np.arange(len(self)), np.diff(self.first))
        back = (self.first[:-1] + self.first[1:] - 1)[section] - np.arange(len(section))
        passed = np.append(2 * section + 1 - self.knots[1:].take(back), float(len(self)))
        return replace(
            self,
            points=self.ends.take(back, axis=1) * scale,
            ends=self.points.take(back, axis=1) * scale,
            leaving=self.arriving.take(back, axis=1) * -scale,
            arriving=self.leaving.take(back, axis=1) * -scale,
            knots=passed,
            starts=half - self.starts,
            centroids=centroids,
        )


def fit_curves(loops: list[FloatArray], corners: list[IntArray]) -> CurveStack:
    """Return the interpolating closed curves of one loop per section.

    Parameters
    ----------
    loops : list of (k_i, 2) arrays
        Vertices, mm, counter-clockwise, no repeated end point, no two neighbours equal.
    corners : list of (c_i,) int arrays
        Vertices at which the curve may turn sharply.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(80) / 80
    >>> curves = fit_curves([np.stack([np.cos(t), np.sin(t)], axis=1)], [np.array([], dtype=int)])
    >>> bool(abs(curves.areas[0] - np.pi) < 1e-6)
    True
    """
    counts = np.array([len(loop) for loop in loops])
    first = np.concatenate([[0], np.cumsum(counts)])
    cuts = [0, *(np.flatnonzero(np.diff(first[1:-1] // AT_ONCE)) + 1), len(loops)]
    points = np.ascontiguousarray(np.concatenate(loops).T)
    ends, leaving, arriving = (np.empty_like(points) for _ in range(3))
    knots = np.append(np.repeat(np.arange(len(loops)), counts), float(len(loops)))

    def fitted(cut: tuple[int, int]) -> CurveMeasures:
        """Fit some of the loops; what belongs to their segments is written where it belongs."""
        some, own = slice(*cut), first[cut[0] : cut[1] + 1] - first[cut[0]]
        part = slice(first[cut[0]], first[cut[1]])
        p0, p1, d0, d1 = (each[:, part] for each in (points, ends, leaving, arriving))
        p1[:, :-1], p1[:, own[1:] - 1] = p0[:, 1:], p0[:, own[:-1]]
        d0[:], d1[:] = segment_tangents(p0, own, corners[some])
        measures = curve_measures(p0, p1, d0, d1, own)
        knots[part] += measures.fractions
        return measures

    if len(cuts) == 2:
        parts = [fitted((0, len(loops)))]
    else:
        with ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-curves") as pool:
            parts = list(pool.map(fitted, pairwise(cuts)))
    figures = {name: np.concatenate([getattr(part, name) for part in parts]) for name in _FIGURES}
    return CurveStack(points, ends, leaving, arriving, knots, first, **figures)
