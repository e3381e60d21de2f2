"""What the accuracy study varies, and the products it hands to the methods.

============  ==================================================  ===============================
axis          varied                                              held
============  ==================================================  ===============================
``sections``  sections at mid-thickness                           exact contours, 65 points
``points``    boundary points per section                         exact contours, many sections
``pixel``     voxels along V^(1/3), isotropic slabs               1 : 1 spacing
``spacing``   slice pitch over pixel size, slabs                  the pixel
``pose``      a random turn                                       isotropic slabs
============  ==================================================  ===============================
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

import numpy as np

from stackloft.sectioning.contour_sink import trace_stack
from stackloft.studies.accuracy_bodies import AccuracyBody, phase
from stackloft.studies.phantom_scan import Scan, Subject, visible
from stackloft.testing.phantoms import Phantom

AXES = ("sections", "points", "pixel", "spacing", "pose")
REFINED = ("sections", "points", "pixel")
"""Axes along which something goes to zero, so that an order can be seen."""
FINE = 96
"""Pixels across the height in pictures of exact faces, for methods that cannot take contours."""


@dataclass(frozen=True, slots=True)
class Levels:
    """How far each axis is refined; coarse first."""

    sections: tuple[int, ...]
    points: tuple[int, ...]
    point_sections: int
    """Sections on the axis ``points``, so many that theirs is not the error that is seen."""
    pixel: tuple[int, ...]
    """Voxels along V^(1/3), so that slender and stout bodies get equally many: multiples of 4 that divide the
    last."""
    spacing: tuple[int, ...]
    """Pitch over pixel size, largest first, each dividing a quarter of the finest `pixel`; the last is 1."""
    pose: tuple[int, ...]
    """Seeds."""
    pose_voxels: int
    """Voxels along V^(1/3) on the axis ``pose``, fourfold."""

    def of(self, axis: str) -> tuple[int, ...]:
        """Return the values of `axis`."""
        values: tuple[int, ...] = getattr(self, axis)
        return values


FULL = Levels((7, 14, 28), (9, 17, 33, 65), 56, (16, 32, 64), (8, 2, 1), (1, 2, 3), 32)
QUICK = Levels((7, 14), (9, 17), 28, (12, 24), (3, 1), (1,), 16)
EXACT_POINTS = 65
"""Points per section on the axis ``sections``, so many that theirs is not the error that is seen."""


@dataclass(frozen=True, slots=True)
class Case:
    """One body at one value of one axis."""

    body: AccuracyBody
    axis: str
    value: int
    step: float
    """What goes to zero under refinement: 1/sections, 1/points, pixel/V^(1/3), pitch/pixel; 1 for poses."""
    phantom: Phantom
    products: tuple[Callable[[], Any], ...]
    """What the body is handed over as, made when asked for; a method takes the first it can start from."""
    shared: Mapping[str, Any] = field(default_factory=dict)
    """Options that go to every plug-in that has them."""


def cases(body: AccuracyBody, axis: str, levels: Levels, subject: Subject | None = None) -> Iterator[Case]:
    """Yield the cases of `body` along `axis`, coarse first.

    Parameters
    ----------
    body : AccuracyBody
    axis : str
        One of `AXES`.
    levels : Levels
    subject : Subject, optional
        The body with what was cut of it before (`subject_of`).

    Examples
    --------
    >>> from stackloft.studies.accuracy_bodies import BODIES
    >>> [len(case.products[0]()) for case in cases(BODIES[0], "sections", QUICK)]
    [7, 14]
    """
    own = subject or subject_of(body)
    make = {"sections": _sections, "points": _points, "pixel": _pixel, "spacing": _spacing, "pose": _pose}
    yield from make[axis](body, own, levels)


def subject_of(body: AccuracyBody) -> Subject:
    """Return the body with what a person tells of it."""
    phantom = body.make()
    return Subject(phantom, partial(body.hints, phantom))


def _sections(body: AccuracyBody, subject: Subject, levels: Levels) -> Iterator[Case]:
    """Exact contours; and fine pictures of the same faces for methods that need pixels."""
    for m in levels.sections:
        faces = Scan(m, subject.phantom.height / FINE, phase=phase(body.label, m))
        products = (partial(subject.contours, m), partial(faces.of, subject))
        yield Case(body, "sections", m, 1 / m, subject.phantom, products, {"points": EXACT_POINTS})


def _points(body: AccuracyBody, subject: Subject, levels: Levels) -> Iterator[Case]:
    contours = cache(partial(subject.contours, levels.point_sections))
    for count in levels.points:
        yield Case(body, "points", count, 1 / count, subject.phantom, (contours,), {"points": count})


def _pixel(body: AccuracyBody, subject: Subject, levels: Levels) -> Iterator[Case]:
    finest = _slices(subject.phantom, levels.pixel[-1])
    for n in levels.pixel:
        slices = _slices(subject.phantom, n)
        scan = Scan(slices, subject.phantom.height / slices, finest, phase(body.label, n))
        yield Case(body, "pixel", n, 1 / n, subject.phantom, _scanned(scan, subject))


def _spacing(body: AccuracyBody, subject: Subject, levels: Levels) -> Iterator[Case]:
    finest = _slices(subject.phantom, levels.pixel[-1])
    for ratio in levels.spacing:
        scan = Scan(
            finest // ratio, subject.phantom.height / finest, 2 * finest, phase(body.label, 1000 + ratio)
        )
        yield Case(body, "spacing", ratio, float(ratio), subject.phantom, _scanned(scan, subject))


def _pose(body: AccuracyBody, subject: Subject, levels: Levels) -> Iterator[Case]:
    for seed in levels.pose:
        phantom = subject.phantom.posed(seed)
        slices = _slices(phantom, levels.pose_voxels)
        turned = Subject(phantom, partial(body.hints, phantom, posed=True))
        scan = Scan(slices, phantom.height / slices, slices, phase(body.label, seed))
        yield Case(body, "pose", seed, 1.0, phantom, _scanned(scan, turned))


def _slices(phantom: Phantom, voxels: int) -> int:
    """Return how many cubic voxels the height is, about `voxels` of them along V^(1/3), in proportion."""
    return voxels // 4 * max(2, round(4.0 * phantom.height / float(np.cbrt(phantom.volume))))


def _scanned(scan: Scan, subject: Subject) -> tuple[Callable[[], Any], ...]:
    """Return the contours of the slices that show the body, and the slices as they are."""
    whole = cache(partial(scan.of, subject))
    return (lambda: trace_stack(visible(whole(), subject.told)), whole)
