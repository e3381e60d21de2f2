"""Bodies of a scan are told apart across slices, labels however near, voids however wound."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from stackloft.model.errors import InputError, UsageError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.object_choice import one_object
from stackloft.sectioning.objects import find_objects
from stackloft.sectioning.slice_pieces import body_pieces, pieces_of


def scan(volume, **options):
    volume = np.asarray(volume, dtype=np.float64)
    count = len(volume)
    stack = SliceStack(
        lambda k: volume[k],
        tuple(f"s{k}" for k in range(count)),
        volume.shape[1:],
        2.0 * np.arange(count) + 7.3,
        np.tile([0.5, 0.25], (count, 1)),
        SectionKind.SLAB,
        thickness=np.full(count, 2.0),
    )
    return Segmentation(stack, lambda k, picture: SectionField(picture, 50.0), **options)


def two_bars():
    volume = np.zeros((8, 40, 60))
    volume[1:7, 4:20, 4:20] = 100
    volume[2:5, 10:30, 35:50] = 100
    return volume


def test_bodies_by_size_on_their_own_slices():
    found = find_objects(scan(two_bars()))
    assert [body.size for body in found] == [6 * 256 * 0.25, 3 * 300 * 0.25]
    assert found[1].segmentation.stack.names == ("s2", "s3", "s4")
    assert found[1].segmentation.stack.positions.tolist() == [11.3, 13.3, 15.3]
    for body in found:
        contours = trace_stack(body.segmentation)
        assert all(len(section.loops) == 1 for section in contours.sections)


def test_what_joins_above_is_one_body():
    volume = two_bars()
    volume[4, 10:15, 15:40] = 100
    assert len(find_objects(scan(volume))) == 1


def test_touching_labels_are_bodies_of_their_own_without_stray_voxels():
    labels = np.zeros((6, 30, 40))
    labels[1:5, 5:25, 5:20] = 3
    labels[1:5, 5:25, 20:35] = 7
    labels[3:5, 5:25, 20:22] = 3  # overlaps the other label from slice to slice
    labels[5, 28, 38] = 7
    every = scan(labels, binary=True, labels=(3, 7))
    three, seven = find_objects(every)
    assert (three.label, seven.label) == (3, 7)
    assert three.size == (labels == 3).sum() * 0.25
    assert seven.size == ((labels == 7).sum() - 1) * 0.25
    assert [notice.code for notice in seven.segmentation.notices] == ["stray-voxels"]
    assert seven.segmentation.binary
    chosen = one_object(every, "7")
    assert chosen.stack.provenance["objects"] == "3,7"
    with pytest.raises(UsageError, match="3: "):
        one_object(every, "5")


def hollow():
    volume = np.zeros((9, 40, 40))
    volume[1:8, 5:35, 5:35] = 100
    volume[3:6, 15:25, 15:25] = 0
    return volume


def areas(segmentation):
    contours = trace_stack(segmentation)
    return [sum(loop.signed_area for loop in section.loops) for section in contours.sections]


def test_a_closed_void_is_filled_or_kept():
    filled, kept = (find_objects(scan(hollow(), fill_voids=fill))[0].segmentation for fill in (True, False))
    assert [notice.code for notice in filled.notices] == ["voids-filled"]
    assert "75 mm³" in filled.notices[0].message
    assert np.ptp(areas(filled)) < 1e-9
    assert np.ptp(areas(kept)) > 10
    assert [notice.code for notice in kept.notices] == ["voids-kept"]


def test_a_hole_that_is_open_above_is_no_void():
    volume = hollow()
    volume[5:, 15:25, 15:25] = 0
    body = find_objects(scan(volume, fill_voids=True))[0].segmentation
    assert not body.notices
    assert np.ptp(areas(body)) > 10


def test_a_void_behind_a_crack_is_closed_and_the_other_body_keeps_its_own():
    volume = np.zeros((5, 60, 120))
    for left in (5, 65):
        volume[:, 5:55, left : left + 50] = 100
        volume[1:4, 20:40, left + 10 : left + 30] = 0
    volume[1:4, 5:20, 24] = 0  # one pixel wide, out to the border
    found = find_objects(scan(volume, fill_voids=True))
    assert len(found) == 2
    for body in found:
        assert np.ptp(areas(body.segmentation)) < 0.02 * max(areas(body.segmentation))


def test_a_void_whose_crack_is_a_mere_notch_on_the_next_slice_is_closed():
    volume = np.zeros((8, 40, 40))
    volume[1:7, 5:35, 5:35] = 100
    volume[2:4, 10:30, 15:25] = 0
    volume[4, 5:30, 20] = 0  # one pixel wide, from above the void out to the border
    volume[5, 5:20, 20] = 0  # less than 20 pixels: the boundary's own notch
    body = find_objects(scan(volume, fill_voids=True))[0].segmentation
    assert [notice.code for notice in body.notices] == ["voids-filled"]
    assert np.ptp(areas(body)) < 0.03 * max(areas(body))


def test_nothing_is_an_error():
    with pytest.raises(InputError, match="no body"):
        find_objects(scan(np.zeros((3, 9, 9))))


class Above:
    """A field that looks at every pixel alone."""

    pointwise = True

    def __call__(self, number, picture):
        return SectionField(picture, 50.0)


def test_fields_from_what_was_kept_are_those_of_whole_pictures():
    volume = two_bars()
    volume[3, 8:12, 8:12] = 0  # a void on one slice
    whole = scan(volume, fill_voids=True)
    for body in find_objects(replace(whole, field_of=Above())):
        own = body.segmentation
        assert own.knows_its_pictures
        for k in range(len(own)):
            kept, seen = (own.field_of(k, picture) for picture in (np.zeros((0, 0)), own.stack.decode(k)))
            assert kept.offset == seen.offset
            assert (kept.values == seen.values).all()
            assert (kept.outline is None) == (seen.outline is None)
        assert not replace(own, stack=replace(own.stack, decode=lambda k: volume[k])).knows_its_pictures
    assert not find_objects(whole)[0].segmentation.knows_its_pictures


def test_a_piece_kept_as_its_outline_comes_back_whole():
    rng = np.random.default_rng(3)
    outlined = 0
    for _ in range(300):
        rough = cv2.GaussianBlur(rng.random((40, 50)).astype(np.float32), (0, 0), rng.uniform(0.7, 4.0))
        numbers, sizes = pieces_of(rough > np.quantile(rough, rng.uniform(0.5, 0.97)))
        body = numbers == 1 + int(sizes.argmax())
        found = body_pieces(body)
        links = LinkedPieces()
        links.add(found.pieces, found.sizes, None, found.corner, outline=found.outline)
        pieces, (row, column) = links.pieces(0)
        outlined += found.outline is not None
        assert (pieces > 0).sum() == body.sum()
        assert ((pieces > 0) == body[row : row + pieces.shape[0], column : column + pieces.shape[1]]).all()
    assert outlined > 150
