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

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.body_field import BodyField, cut_stack, touching
from stackloft.sectioning.contour_sink import decoded_ahead
from stackloft.sectioning.linked_pieces import LinkedPieces, Pieces, pieces_of
from stackloft.sectioning.voids import VoidFinder, void_notice

CRUMB = 0.02
"""Objects below this fraction of the largest are not worth a word."""
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

    All slices are decoded once.

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
    links, voids = _linked(segmentation)
    labels = links.labels()
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
    return tuple(
        BodyObject(
            int(kind[k]) or None,
            float(volumes[k]),
            _view(segmentation, links, owner == k, voids, _stray_notice(k, kind, volumes)),
        )
        for k in chosen
    )


def _linked(segmentation: Segmentation) -> tuple[LinkedPieces, VoidFinder]:
    """Return all pieces with their labels (0: none), and the voids, from one pass over the slices."""
    links, voids = LinkedPieces(), VoidFinder()
    voxel = _voxel_volumes(segmentation.stack)
    for index, picture, section in decoded_ahead(segmentation):
        pieces, sizes, own = _slice_pieces(segmentation, picture, section)
        links.add(pieces, sizes * voxel[index], own)
        if not segmentation.labels:
            voids.add(pieces > 0)
    return links, voids


def _slice_pieces(
    segmentation: Segmentation, picture: Picture, section: SectionField
) -> tuple[Pieces, FloatArray, IntArray]:
    """Return one slice's pieces on the whole slice, their pixels, and the label of each."""
    if not segmentation.labels:
        pieces, sizes = pieces_of(_body(section))
        whole = np.zeros(segmentation.stack.shape, dtype=np.int32)
        row, column = section.offset
        whole[row : row + pieces.shape[0], column : column + pieces.shape[1]] = pieces
        return whole, sizes.astype(np.float64), np.zeros(len(sizes), dtype=np.int64)
    whole, counts, labels = np.zeros(picture.shape, dtype=np.int32), [np.zeros(0)], [np.zeros(0, np.int64)]
    done = 0
    for label in np.unique(picture[picture > 0]):
        pieces, sizes = pieces_of(picture == label)
        np.copyto(whole, pieces + done, where=pieces > 0)
        done += len(sizes)
        counts.append(sizes.astype(np.float64))
        labels.append(np.full(len(sizes), int(label)))
    return whole, np.concatenate(counts), np.concatenate(labels)


def _body(section: SectionField) -> BoolArray:
    level = section.level if section.local_levels is None else section.local_levels
    return np.asarray(section.values > level)


def _voxel_volumes(stack: SliceStack) -> FloatArray:
    """Return the volume that a pixel of each slice stands for, mm³."""
    z = stack.positions
    lengths = np.gradient(z) if len(z) > 1 else np.ones(1)
    return np.asarray(stack.pixel_spacing.prod(axis=1) * lengths)


def _largest_of(volumes: FloatArray, among: BoolArray) -> int:
    return int(np.argmax(np.where(among, volumes, -1.0)))


def _stray_notice(k: int, kind: IntArray, volumes: FloatArray) -> tuple[Notice, ...]:
    """Return a notice when a label has voxels away from its largest piece."""
    if not kind[k]:
        return ()
    stray = float(volumes[kind == kind[k]].sum() - volumes[k])
    if not stray:
        return ()
    share = 100 * stray / float(volumes[k])
    text = f"label {kind[k]}: left out {stray:.4g} mm³ of stray voxels ({share:.2g} %) away from its body"
    return (Notice("stray-voxels", text),)


def _view(
    whole: Segmentation, links: LinkedPieces, own: BoolArray, voids: VoidFinder, notices: tuple[Notice, ...]
) -> Segmentation:
    """Return the body of the pieces `own` alone, on the slices where it is."""
    present = _present(whole, links, own)
    first, last = present[0], present[-1]
    inner = _void_volume(whole, links, own, voids)
    told = void_notice(inner, float(links.sizes()[own].sum()), filled=whole.fill_voids)
    return Segmentation(
        cut_stack(whole.stack, first, last + 1),
        BodyField(whole, links, own, voids, first),
        binary=whole.binary,
        notices=(*whole.notices, *notices, *told),
    )


def _void_volume(whole: Segmentation, links: LinkedPieces, own: BoolArray, voids: VoidFinder) -> float:
    """Return the volume of the voids that a body encloses, mm³."""
    if whole.labels:
        return 0.0
    voxel, total = _voxel_volumes(whole.stack), 0.0
    for k in range(len(links)):
        if own[links.of_slice(k)].any() and voids.has_closed(k):
            mine = np.concatenate([[False], own[links.of_slice(k)]])[links.pieces(k)]
            total += float(voxel[k]) * float(np.count_nonzero(touching(voids.closed(k), mine)))
    return total


def _present(whole: Segmentation, links: LinkedPieces, own: BoolArray) -> list[int]:
    """Return the slices from the first to the last on which the body has pixels enough for a contour."""
    voxel = _voxel_volumes(whole.stack)
    pixels = (
        np.array([(own[at] * links.sizes()[at]).sum() for at in map(links.of_slice, range(len(links)))])
        / voxel
    )
    enough = np.flatnonzero(pixels >= FEWEST)
    if len(enough) < 2:  # so small that no contour is to be had; methods that count voxels need none
        enough = np.flatnonzero(pixels)
    return [int(k) for k in enough]
