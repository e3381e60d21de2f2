r"""The separate bodies of a scan, each as a Segmentation of its own.

::

    slices with two bodies           largest: slices 2 … 5 alone, everything but the body
      1   .   .   .   .              brought to the background's side of the level;
      2   . ( a ) .   .              voids that are closed on every side are filled or kept
      3   . ( a ) . (b).
      …

A body is what hangs together across slices (pixels that share an edge; pieces that overlap from slice to
slice). Of a label map every label is a body, however near another, and its stray voxels are left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.reused_memory import memory_reused
from stackloft.model.segmentation import Beyond, SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.ahead import TOGETHER, ahead_on, groups_of, worked_ahead
from stackloft.sectioning.body_field import MARGIN, BodyField, cut_stack, enclosed, placed
from stackloft.sectioning.cut_bodies import cut_apart
from stackloft.sectioning.kept_slices import Keeper, KeptSlices
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.object_notices import cut_notice, stray_notice
from stackloft.sectioning.opencv_threads import without_opencv_threads
from stackloft.sectioning.slice_look import SliceLook, framed_window, look_at_all
from stackloft.sectioning.voids import VoidFinder, void_notice

CRUMB = 0.02
"""Objects below this fraction of the largest are not worth a word."""
KEPT = MARGIN + 2
"""Pixels kept as they were decoded around all bodies of a slice."""
FEWEST = 12
"""Pixels of a body's slice; slices at its ends with fewer give no contour and are left out."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyObject:
    """One body of a scan."""

    label: int | None
    """Of a label map; None for grey levels."""
    size: float
    """mm³, by counting voxels"""
    segmentation: Segmentation
    """The body alone, on its own slices."""


def find_objects(segmentation: Segmentation) -> tuple[BodyObject, ...]:
    """Return the bodies: the largest first, or those of a label map by label.

    All slices are decoded once; what the bodies' Segmentations need of them is kept (`KeptSlices`).

    Raises
    ------
    InputError
        There is no body on any slice.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> picture = np.zeros((20, 40))
    >>> picture[4:16, 4:16], picture[4:10, 24:30] = 100.0, 100.0
    >>> air = np.zeros((20, 40))
    >>> stack = SliceStack(lambda k: picture if k else air, tuple("abc"), (20, 40), np.arange(3.0),
    ...                    np.ones((3, 2)), SectionKind.SLAB)
    >>> found = find_objects(Segmentation(stack, lambda k, picture: SectionField(picture, 50.0)))
    >>> [body.size for body in found], found[0].segmentation.stack.names
    ([288.0, 72.0], ('b', 'c'))
    """
    linked = _linked(segmentation)
    if segmentation.neck is not None and len(linked.links.labels()):
        cut = cut_apart(linked.links, linked.voids, segmentation.stack, segmentation.neck)
        linked = replace(linked, links=cut, outlines={})
    links = linked.links
    labels = links.labels() if segmentation.neck is None else np.zeros_like(links.labels())
    if not len(labels):
        raise InputError(
            "no body found on any slice",
            where=f"{segmentation.stack.names[0]} … {segmentation.stack.names[-1]}",
            fix="give --set segmenter.threshold=LEVEL",
        )
    owner, sizes = links.objects(), links.sizes()
    volumes: FloatArray = np.asarray(np.bincount(owner, sizes), dtype=np.float64)
    kind = np.zeros(len(volumes), dtype=np.int64)
    kind[owner] = labels
    if segmentation.labels:
        chosen = [_largest_of(volumes, kind == label) for label in segmentation.labels]
    else:
        chosen = [int(k) for k in np.argsort(-volumes, kind="stable") if volumes[k] >= CRUMB * volumes.max()]
    told = cut_notice(segmentation.neck, len(chosen))
    return tuple(
        BodyObject(
            int(kind[k]) or None,
            float(volumes[k]),
            _view(segmentation, linked, owner == k, (*stray_notice(k, kind, volumes), *told)),
        )
        for k in chosen
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Linked:
    links: LinkedPieces
    """All pieces with their labels (0: none)."""
    voids: VoidFinder
    kept: KeptSlices
    outlines: Mapping[int, NDArray[np.int32]]
    """By slice, of bodies that are one piece without a hole."""


def _linked(segmentation: Segmentation) -> _Linked:
    """Return what one pass over the slices finds."""
    links, voids = LinkedPieces(), VoidFinder()
    outlines: dict[int, NDArray[np.int32]] = {}
    kept = KeptSlices(segmentation.stack.decode)
    keeper = Keeper(kept)
    voxel = _voxel_volumes(segmentation.stack)

    with without_opencv_threads(), memory_reused():
        for index, (picture, look) in enumerate(_looks(segmentation)):
            window = framed_window(look.pieces.shape, look.corner, KEPT, picture.shape)
            keeper.take(index, picture, window if len(look.sizes) else None)
            links.add(look.pieces, look.sizes * voxel[index], look.labels, look.corner, outline=look.outline)
            if not segmentation.labels:
                voids.add(look.body, look.closed, look.framed)
            if look.outline is not None:
                outlines[index] = look.outline
    keeper.end()
    return _Linked(links, voids, kept, outlines)


def _looks(segmentation: Segmentation) -> Iterator[tuple[Picture, SliceLook]]:
    """Yield every slice with what it shows: large ones worked on ahead, small ones some at a time."""
    stack = segmentation.stack
    ahead = ahead_on(stack)
    groups = groups_of(len(segmentation), 1 if ahead else TOGETHER)

    def work(number: int) -> list[tuple[Picture, SliceLook]]:
        group = groups[number]
        if not ahead:
            stack.prefetch(group)
        pictures = [stack.decode(index) for index in group]
        fields = [segmentation.field_of(index, own) for index, own in zip(group, pictures, strict=True)]
        looks = look_at_all(segmentation, list(zip(pictures, fields, strict=True)))
        return list(zip(pictures, looks, strict=True))

    for found in worked_ahead(len(groups), work, ahead):
        yield from found


def _voxel_volumes(stack: SliceStack) -> FloatArray:
    """Return the volume that a pixel of each slice stands for, mm³."""
    z = stack.positions
    lengths = np.gradient(z) if len(z) > 1 else np.ones(1)
    return np.asarray(stack.pixel_spacing.prod(axis=1) * lengths)


def _largest_of(volumes: FloatArray, among: BoolArray) -> int:
    return int(np.argmax(np.where(among, volumes, -1.0)))


def _view(whole: Segmentation, linked: _Linked, own: BoolArray, notices: tuple[Notice, ...]) -> Segmentation:
    """Return the body of the pieces `own` alone, on the slices where it is."""
    every, present = _present(whole, linked.links, own)
    first, last = present[0], present[-1]
    body = BodyField(whole, linked.links, own, linked.voids, first, linked.outlines)
    inner = _void_volume(whole, linked, own)
    told = void_notice(inner, float(linked.links.sizes()[own].sum()), filled=whole.fill_voids)
    stack = cut_stack(replace(whole.stack, decode=linked.kept), first, last + 1)
    return Segmentation(
        stack,
        replace(body, kept=linked.kept) if whole.pointwise else body,
        known_of=stack.decode if whole.pointwise else None,
        binary=whole.binary,
        notices=(*whole.notices, *notices, *told),
        before=_beyond(body, linked.kept, range(every[0] - 1, first)),
        after=_beyond(body, linked.kept, range(last + 1, every[-1] + 2)),
    )


def _beyond(body: BodyField, kept: KeptSlices, numbers: range) -> tuple[Beyond, ...]:
    """Return the slices of those numbers that the scan has; they are kept around the body beside them."""
    stack = body.whole.stack

    def shown(number: int) -> SectionField:
        return body(number - body.first, kept(number))

    area = stack.pixel_spacing.prod(axis=1)
    return tuple(
        Beyond(float(stack.positions[k]), float(area[k]), body.shows(k), partial(shown, k))
        for k in numbers
        if 0 <= k < len(stack)
    )


def _void_volume(whole: Segmentation, linked: _Linked, own: BoolArray) -> float:
    """Return the volume of the voids that a body encloses, mm³."""
    if whole.labels:
        return 0.0
    links, voids = linked.links, linked.voids
    voxel, total = _voxel_volumes(whole.stack), 0.0
    for k in range(len(links)):
        if voids.has_closed(k) and own[links.of_slice(k)].any():
            closed, (row, column) = voids.closed(k)
            window = (slice(row, row + closed.shape[0]), slice(column, column + closed.shape[1]))
            pieces, corner = links.pieces(k)
            mine = np.concatenate([[False], own[links.of_slice(k)]])[pieces]
            both = (placed(one, corner, window) for one in (mine, (pieces > 0) & ~mine))
            total += float(voxel[k]) * float(np.count_nonzero(enclosed(closed, *both)))
    return total


def _present(whole: Segmentation, links: LinkedPieces, own: BoolArray) -> tuple[list[int], list[int]]:
    """Return the slices on which the body has pixels, and those on which it has enough for a contour."""
    voxel = _voxel_volumes(whole.stack)
    sizes = own * links.sizes()
    pixels = np.array([sizes[at].sum() for at in map(links.of_slice, range(len(links)))]) / voxel
    every, enough = np.flatnonzero(pixels), np.flatnonzero(pixels >= FEWEST)
    if len(enough) < 2:  # so small that no contour is to be had; methods that count voxels need none
        enough = every
    return every.tolist(), enough.tolist()
