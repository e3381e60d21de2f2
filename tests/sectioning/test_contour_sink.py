"""Slices go by once, in order, with few in memory, and their notices come together."""

import threading

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Hints, SectionKind, SliceStack
from stackloft.sectioning.ahead import AHEAD, THREADS
from stackloft.sectioning.contour_sink import feed, gathered, trace_stack


def picture(number):
    levels = np.full((40, 50), 20.0)
    levels[10:30, 8 : 20 + number] = 100.0
    return levels


def segmentation(count=6, decode=picture, field_notices=()):
    stack = SliceStack(
        decode,
        tuple(f"slice_{k}.png" for k in range(count)),
        (40, 50),
        np.arange(count) * 2.5 + 7,
        np.full((count, 2), 0.4),
        SectionKind.SILHOUETTE,
        hints=Hints(specimen="pear"),
        notices=(Notice("slice-skipped", "one"),),
        provenance={"pixel size": "stack.toml"},
    )
    return Segmentation(stack, lambda k, levels: SectionField(levels, 60.0, notices=field_notices))


def test_everything_known_is_carried_over():
    contours = trace_stack(segmentation())
    assert contours.positions.tolist() == [7, 9.5, 12, 14.5, 17, 19.5]
    assert [section.name for section in contours.sections] == [f"slice_{k}.png" for k in range(6)]
    assert (contours.exact, contours.resolution, contours.kind) == (False, 0.4, SectionKind.SILHOUETTE)
    assert contours.hints.specimen == "pear"
    assert contours.provenance == {"pixel size": "stack.toml"}
    assert [notice.code for notice in contours.notices] == ["slice-skipped"]
    areas = [section.loops[0].signed_area for section in contours.sections]
    assert areas == pytest.approx([20 * (12 + k) * 0.16 for k in range(6)], rel=0.01)


def test_look_ahead_is_bounded_and_order_kept():
    alive, most, seen = [0], [0], []
    lock = threading.Lock()

    def decode(number):
        with lock:
            alive[0] += 1
            most[0] = max(most[0], alive[0])
        return picture(number)

    class Watch:
        def begin(self, segmentation):
            pass

        def add(self, index, picture, section_field):
            seen.append(index)
            with lock:
                alive[0] -= 1

        def end(self):
            return "done"

    assert feed(segmentation(30, decode), [Watch()]) == ["done"]
    assert seen == list(range(30))
    assert most[0] <= AHEAD + 1
    assert threading.active_count() <= 1 + THREADS


def test_an_error_in_a_slice_reaches_the_caller_and_ends_the_work():
    decoded = []

    def decode(number):
        decoded.append(number)
        if number == 3:
            raise InputError("picture is damaged", where="slice_3.png")
        return picture(number)

    with pytest.raises(InputError, match=r"slice_3\.png"):
        trace_stack(segmentation(50, decode))
    assert len(decoded) < 10


def test_notices_of_many_slices_become_one():
    contours = trace_stack(segmentation(5, field_notices=(Notice("low-contrast", "x.png: faint"),)))
    assert [notice.code for notice in contours.notices] == ["slice-skipped", "low-contrast"]
    merged = gathered([Notice("a", f"{k}.png: odd") for k in range(6)])
    assert merged == (Notice("a", "0.png: odd (and 5 more: 1.png, 2.png, 3.png, …)"),)
