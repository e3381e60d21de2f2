"""Structure sets: the same sections as exact contours, wherever they lie, with their holes."""

import numpy as np
import pytest

import stackloft
from stackloft.model.errors import InputError, UsageError
from stackloft.testing.phantoms import make, write_phantom
from stackloft.testing.phantoms.structure_set import add_region, structure_bytes, structure_set
from stackloft_plugins.readers.dicom import DicomReader
from stackloft_plugins.readers.rtstruct import RtstructReader

SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
BOW_TIE = np.array([[-4.0, -8], [4, 8], [4, -8], [-1, 4]])
LEVELS = tuple(range(0, 30, 5))


def at(points, z):
    return np.column_stack([points, np.full(len(points), float(z))])


def written(folder, *regions, **elements):
    """Write a structure set; a region is (number, name, curves[, kind])."""
    data = structure_set()
    for region in regions:
        add_region(data, *region)
    for key, value in elements.items():
        setattr(data, key, value)
    path = folder / "RS"
    path.write_bytes(structure_bytes(data))
    return path


def ring(z):
    """A 20 mm square with a 10 mm hole in it, as two curves."""
    return [at(10 * SQUARE, z), at(5 * SQUARE[::-1], z)]


def keyhole(z):
    """The same as one curve with a bridge."""
    outline, hole = 10 * SQUARE, 5 * SQUARE[::-1]
    return [at(np.concatenate([outline, outline[:1], hole[-1:], hole]), z)]


@pytest.mark.parametrize(
    ("seed", "origin"), [(None, (0, 0, 0)), (3, (-210.3, 55.7, 801.9)), (8, (12, -3, 5))]
)
def test_volume_and_area_are_those_of_the_exact_contours(tmp_path, seed, origin):
    write_phantom("potato", "contours", tmp_path / "csv", sections=9)
    write_phantom("potato", "rtstruct", tmp_path / "rs", sections=9, cosines=seed, origin=origin)
    exact = stackloft.measure(tmp_path / "csv").objects[0]
    found = stackloft.measure(tmp_path / "rs").objects[0]
    turned = 1e-6 if seed is None else 1e-5  # about the axis: the 33 points lie elsewhere on each loop
    assert found.volume.value == pytest.approx(exact.volume.value, rel=turned)
    assert found.area.value == pytest.approx(exact.area.value, rel=turned)


@pytest.mark.parametrize("seed", [None, 5])
def test_points_come_back_where_they_were_drawn(tmp_path, seed):
    write_phantom("cone", "rtstruct", tmp_path, sections=5, cosines=seed, origin=(7.5, -300.25, 41.125))
    stack = RtstructReader().read(tmp_path)
    exact = make("cone").contour_stack(5)
    turned = np.diff(stack.positions), np.diff(exact.positions)
    assert np.allclose(*turned, atol=1e-6) or np.allclose(turned[0], turned[1][::-1], atol=1e-6)
    assert np.allclose(stack.affine[:3, :3] @ stack.affine[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(stack.affine[:3, :3]) == pytest.approx(1.0)
    areas = sorted(section.loops[0].signed_area for section in stack.sections)
    assert areas == pytest.approx(sorted(s.loops[0].signed_area for s in exact.sections), rel=1e-6)


@pytest.mark.parametrize(
    ("curves", "kind"),
    [(ring, "CLOSED_PLANAR"), (ring, "CLOSEDPLANAR_XOR"), (keyhole, "CLOSED_PLANAR")],
)
def test_holes_are_holes_however_they_are_drawn(tmp_path, curves, kind):
    path = written(tmp_path, (1, "ring", [curve for z in LEVELS for curve in curves(z)], kind))
    stack = RtstructReader().read(path)
    for section in stack.sections:
        assert [loop.hole for loop in section.loops] == [False, True]
        assert [loop.signed_area for loop in section.loops] == pytest.approx([400.0, -100.0])
    volume = stackloft.measure(path, "cavalieri", rule="trapezoid").objects[0].volume.value
    assert volume == pytest.approx(300 * 25)


def test_regions_are_chosen_by_name_or_number_and_the_largest_is_told(tmp_path):
    small = [at(2 * SQUARE, z) for z in LEVELS]
    large = [at(8 * SQUARE + 40, z) for z in LEVELS]
    path = written(
        tmp_path, (4, "seed", small), (9, "flesh", large), (11, "marker", [at(SQUARE[:1], 0)], "POINT")
    )
    stack = RtstructReader().read(path)
    assert stack.provenance["region"] == "9 (flesh)"
    assert "4 (seed), 9 (flesh)" in stack.notices[0].message
    for wanted in ("seed", "4"):
        chosen = RtstructReader(roi=wanted).read(path)
        assert (chosen.provenance["object"], chosen.notices) == ("4", ())
    with pytest.raises(UsageError, match=r"no such region; found: skin; expected: 4 \(seed\)"):
        RtstructReader(roi="skin").read(path)
    every = stackloft.measure(path, "cavalieri", object="all", rule="trapezoid").objects
    assert [(each.label, each.volume.value) for each in every] == [
        ("region 4", pytest.approx(16 * 25)), ("region 9", pytest.approx(256 * 25)),
    ]  # fmt: skip


def test_a_gap_is_told_and_open_curves_are_left_out(tmp_path):
    levels = (0, 5, 10, 25, 30)
    path = written(tmp_path, (1, "a", [at(4 * SQUARE, z) for z in levels]))
    (notice,) = RtstructReader().read(path).notices
    assert notice.code == "gap"
    assert "15 mm from z = 10 mm, 5 mm between others" in notice.message
    data = structure_set()
    add_region(data, 1, "a", [at(4 * SQUARE, z) for z in LEVELS])
    add_region(data, 2, "b", [at(4 * SQUARE, 0)], "OPEN_PLANAR")
    data.ROIContourSequence[0].ContourSequence.append(data.ROIContourSequence[1].ContourSequence[0])
    path.write_bytes(structure_bytes(data))
    assert "OPEN_PLANAR" in RtstructReader().read(path).notices[0].message


def bent(z):
    points = at(4 * SQUARE, z)
    points[2, 2] += 3.0
    return points


@pytest.mark.parametrize(
    ("curves", "words"),
    [
        ([at(4 * SQUARE, 0), bent(5), at(4 * SQUARE, 10)], "leaves the plane"),
        ([*(at(4 * SQUARE, z) for z in LEVELS), np.roll(at(4 * SQUARE, 2), 1, axis=1)], "leaves the plane"),
        ([at(4 * SQUARE, 0)], "one section makes no body"),
        ([at(BOW_TIE, z) for z in LEVELS], "crosses itself"),
        ([at(4 * SQUARE + shift, z) for z in LEVELS for shift in (0, 3)], "loops cross"),
        ([at(4 * SQUARE, 1e9), at(4 * SQUARE, 0)], "impossible coordinates"),
    ],
)
def test_what_makes_no_sections_is_refused(tmp_path, curves, words):
    with pytest.raises(InputError, match=words) as caught:
        RtstructReader().read(written(tmp_path, (1, "a", curves)))
    assert "RS" in str(caught.value)


def test_a_contour_with_another_number_of_points_is_refused(tmp_path):
    data = structure_set()
    add_region(data, 1, "a", [at(4 * SQUARE, z) for z in LEVELS])
    data.ROIContourSequence[0].ContourSequence[2].NumberOfContourPoints = 5
    (tmp_path / "RS").write_bytes(structure_bytes(data))
    with pytest.raises(InputError, match="found: 12 coordinates; expected: 3 for each of 5 points"):
        RtstructReader().read(tmp_path / "RS")


def test_who_the_patient_is_stays_in_the_file(tmp_path):
    path = written(
        tmp_path,
        (1, "Grey liver", [at(4 * SQUARE, z) for z in LEVELS]),
        (2, "PH-2007", [at(SQUARE, z) for z in LEVELS]),
        StudyDescription="Grey's liver", ReferringPhysicianName="Doctor^Who",
    )  # fmt: skip
    stack = RtstructReader().read(path)
    text = repr((stack.notices, dict(stack.provenance), [section.name for section in stack.sections]))
    assert not [word for word in ("Grey", "2007", "Doctor") if word in text]
    kept = RtstructReader(keep_identifiers=True).read(path)
    assert kept.provenance["PatientName"] == "Phantom^Grey"


def test_a_structure_set_beside_its_pictures_is_left_out_and_told(series):
    path = written(series, (1, "a", [at(4 * SQUARE, z) for z in LEVELS]))
    stack = DicomReader().read(series)
    assert len(stack) == 8
    assert "RS (RTSTRUCT)" in stack.notices[0].message
    assert RtstructReader().probe(series) == 0.0
    assert RtstructReader().probe(path) > DicomReader().probe(path)
    assert len(stackloft.read(path)) == 6
