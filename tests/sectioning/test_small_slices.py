"""A scan's small slices are worked on without threads, and give what they give with them."""

import threading

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.sectioning import ahead
from stackloft.sectioning.ahead import Behind, worked_ahead
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.sectioning.objects import find_objects
from stackloft.sectioning.slice_pieces import body_pieces
from stackloft.sectioning.voids import closed_background


def scan(kind, seen, count=20):
    rows, columns = np.mgrid[:60, :70]

    def decode(number):
        seen.append(threading.current_thread().name)
        noise = np.random.default_rng(number).normal(0.0, 4.0, (60, 70))
        return np.where(np.hypot(rows - 30, columns - 33) < 16 + number % 4, 100.0, 0.0) + noise

    names = tuple(f"{k}" for k in range(count))
    stack = SliceStack(decode, names, (60, 70), np.arange(count) * 0.8, np.full((count, 2), 0.4), kind)
    return Segmentation(stack, lambda k, picture: SectionField(picture, 50.0))


def test_a_scan_is_decoded_by_its_caller_and_photographs_are_not():
    own = threading.current_thread().name
    seen = []
    trace_stack(scan(SectionKind.SLAB, seen))
    find_objects(scan(SectionKind.SLAB, seen))
    assert set(seen) == {own}
    seen.clear()
    trace_stack(scan(SectionKind.FACE, seen))
    assert own not in seen


def test_threads_change_nothing(monkeypatch):
    def loops():
        body = find_objects(scan(SectionKind.SLAB, []))[0].segmentation
        return [loop for section in trace_stack(body).sections for loop in section.loops]

    alone = loops()
    monkeypatch.setattr(ahead, "SMALL", 0)
    together = loops()
    assert len(alone) == 20
    assert all(np.array_equal(a.points, b.points) for a, b in zip(alone, together, strict=True))


def test_without_threads_work_is_done_when_it_is_asked_for():
    done = []
    numbers = worked_ahead(5, lambda number: done.append(number) or number**2, 0)
    assert (next(numbers), next(numbers), done) == (0, 1, [0, 1])
    numbers.close()
    assert done == [0, 1]
    behind = Behind(0)
    behind.give(lambda: done.append(2))
    assert done == [0, 1, 2]
    with pytest.raises(InputError, match="damaged"):
        behind.give(lambda: (_ for _ in ()).throw(InputError("damaged")))


def test_what_is_known_of_a_piece_saves_looks_and_changes_nothing():
    """Of single pieces without a hole some close in background, behind a passage that counts as none."""
    rng = np.random.default_rng(4)
    rows, columns = np.mgrid[:60, :60]
    closed = 0
    for _ in range(300):
        body = np.hypot(rows - 30, columns - 30) < rng.uniform(15, 22)
        y, x = rng.integers(20, 40, 2)
        body &= np.hypot(rows - y, columns - x) > rng.uniform(0, 6)
        body[y - rng.integers(0, 3) : y + rng.integers(1, 3), x:] &= (
            rng.random() < 0.2
        )  # a passage to the right
        if body_pieces(body).outline is None:
            continue
        known, plain = closed_background(body, solid=True, apart=True), closed_background(body)
        assert (known is None) == (plain is None)
        if plain is not None:
            assert np.array_equal(known, plain)
            closed += 1
    assert closed > 30
