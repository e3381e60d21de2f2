"""The accuracy study's own parts: scans are exact, orders are seen, strangers and failures take part."""

import numpy as np
import pytest

from stackloft.model.slice_stack import Hints
from stackloft.studies.accuracy_axes import AXES, FULL, QUICK, cases, subject_of
from stackloft.studies.accuracy_bodies import BODIES, bodies_named
from stackloft.studies.accuracy_table import Accuracy, AccuracyRow, finest, observed_order
from stackloft.studies.phantom_scan import BODY, Scan, Subject, visible
from stackloft.studies.theory import order_of
from stackloft.testing import phantoms


def nothing_told(positions):
    return Hints()


def grey_volume(segmentation):
    stack = segmentation.stack
    pitch = float(np.diff(stack.positions).mean())
    pixel = float(stack.pixel_spacing[0].prod())
    return sum(float(stack.decode(k).sum()) for k in range(len(stack))) / BODY * pitch * pixel


@pytest.mark.parametrize("name", ["ellipsoid", "box", "cone", "two-lobed"])
def test_a_scan_s_grey_levels_add_up_to_the_body(name):
    phantom = phantoms.make(name, offset=(3.0, -40.0, 17.0))
    for slices, slabs in ((12, 24), (24, 24)):
        scan = Scan(slices, phantom.height / 24, slabs, phase=(0.3, 0.8)).of(Subject(phantom, nothing_told))
        assert grey_volume(scan) == pytest.approx(phantom.volume, rel=2e-4)
        first, last = scan.stack.positions[[0, -1]]
        assert (first + last) / 2 == pytest.approx(sum(phantom.extent()) / 2)


def test_slices_without_a_visible_body_are_left_out_and_the_ends_told_anew():
    cone = next(body for body in BODIES if body.label == "cone")
    subject = subject_of(cone)
    whole = Scan(24, subject.phantom.height / 24, 24).of(subject)
    seen = visible(whole, subject.told)
    assert 18 <= len(seen) < len(whole)
    assert all((seen.stack.decode(k) > BODY / 2).sum() >= 16 for k in (0, len(seen) - 1))
    low, high = subject.phantom.extent()
    first, last = seen.stack.hints.ends
    assert first.length == pytest.approx(seen.stack.positions[0] - low)
    assert last.length == pytest.approx(high - seen.stack.positions[-1])


@pytest.mark.parametrize("levels", [FULL, QUICK])
def test_levels_divide_each_other(levels):
    for n in levels.pixel:
        assert n % 4 == 0
        assert levels.pixel[-1] % n == 0
    assert levels.spacing[-1] == 1
    for ratio in levels.spacing:
        assert levels.pixel[-1] // 4 % ratio == 0
    assert levels.pose_voxels % 4 == 0


def test_products_are_made_once_for_each_case_and_only_when_asked_for():
    box = bodies_named(("box",))[0]
    for axis in AXES:
        for one in cases(box, axis, QUICK):
            assert callable(one.products[0])
            assert one.step > 0
    steps = [one.step for one in cases(box, "pixel", QUICK)]
    assert steps == sorted(steps, reverse=True)


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_an_order_is_seen_whatever_the_sign(order):
    steps = [0.1, 0.05, 0.025, 0.0125]
    errors = [(-1) ** k * 3.0 * step**order for k, step in enumerate(steps)]
    assert observed_order(steps, errors) == pytest.approx(order)


def test_no_order_is_seen_in_rounding_or_in_one_value():
    assert observed_order([0.1, 0.05], [1e-11, 3e-12]) is None
    assert observed_order([0.1, 0.05], [1.0, None]) is None


def test_theory_takes_the_worse_of_two_ends():
    assert order_of("loft", "sections", "face") == 4
    assert order_of("loft", "sections", "face/round") == 2
    assert order_of("frustum", "sections", "face/point") == 1
    assert order_of("no-such-method", "sections") is None


def rows():
    yield AccuracyRow("a", "x", "sections", 7, 1 / 7, 1.0, 2.0)
    yield AccuracyRow("a", "x", "sections", 14, 1 / 14, 0.25, -0.5)
    yield AccuracyRow("a", "y", "sections", 7, 1 / 7, failure="broken")
    yield AccuracyRow("a", "y", "sections", 14, 1 / 14, -0.75, None)
    yield AccuracyRow("b", "x", "points", 9, 1 / 9, failure="not applicable: no points")
    yield AccuracyRow("a", "x", "pose", 1, 1.0, 3.0, 1.0)
    yield AccuracyRow("a", "x", "pose", 2, 1.0, -4.0, 1.0)


def test_summaries_take_the_finest_value_and_every_pose():
    sections, points, pose = Accuracy(tuple(rows()), ()).summaries()
    assert (sections.measured, sections.failed) == (3, 1)
    assert sections.volume_rms == pytest.approx(np.sqrt((0.25**2 + 0.75**2) / 2))
    assert (sections.volume_worst, sections.area_worst) == (0.75, 0.5)
    assert (points.measured, points.failed, points.volume_rms) == (0, 0, None)
    assert (pose.volume_worst, pose.volume_rms) == (4.0, pytest.approx(np.sqrt(12.5)))


def test_failures_are_gathered_by_reason_and_the_worst_pose_is_shown():
    found = Accuracy(tuple(rows()), ())
    assert list(found.failures()) == [("a", "broken")]
    assert [row.volume_error for row in finest(found.rows) if row.axis == "pose"] == [-4.0]
