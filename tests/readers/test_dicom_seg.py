"""DICOM segmentations: every segment a body of its own, on the planes where the pictures were."""

import numpy as np
import pytest

import stackloft
from stackloft.model.errors import InputError, UsageError
from stackloft.testing.phantoms import write_phantom
from stackloft.testing.phantoms.scan_grid import ScanGrid
from stackloft.testing.phantoms.scan_seg import segmentation
from stackloft.testing.phantoms.scan_volume import ScanVolume
from stackloft_plugins.readers.dicom import DicomReader
from stackloft_plugins.readers.dicom_seg import DicomSegReader

VOXEL = 0.7 * 0.4 * 2.5
SHAPE = (30, 44)


def volume(tilt=0.0, slices=9, **changes):
    turn = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
    shear = float(np.tan(np.radians(tilt)))
    z = 2.5 * np.arange(slices) - 31.7
    grid = ScanGrid(z, 2.5, np.array([-12.3, 8.1]), SHAPE, (0.7, 0.4), shear)
    blank = tuple(np.zeros(SHAPE, np.int16) for _ in z)
    return ScanVolume("box", blank, grid, turn, np.array([3.3, -71.0, 12.9]), **changes)


def masks(slices=9):
    """Two boxes that touch, and a third over both."""
    each = np.zeros((slices, *SHAPE, 3))
    each[1:8, 5:20, 5:20, 0] = 1
    each[2:6, 5:20, 20:30, 1] = 1
    each[3:5, 10:15, 15:25, 2] = 1
    return each


def written(folder, made, kind="BINARY", scan=None, **more):
    names = ["flesh", "core", "over"][: made.shape[-1]]
    path = folder / "SEG"
    path.write_bytes(segmentation(scan or volume(), made, names, kind, **more))
    return path


def count(path, **options):
    return stackloft.measure(path, "voxel", **options).objects[0].volume.value / VOXEL


@pytest.mark.parametrize("kind", ["BINARY", "FRACTIONAL"])
@pytest.mark.parametrize("tilt", [0.0, 15.0])
def test_segments_that_touch_or_overlap_are_measured_apart(tmp_path, kind, tilt):
    path = written(tmp_path, masks(), kind, volume(tilt))
    for number, (name, voxels) in enumerate([("flesh", 1575), ("core", 600), ("over", 100)], start=1):
        assert count(path, object=str(number)) == pytest.approx(voxels)
        assert count(path, object=name) == pytest.approx(voxels)
    largest = DicomSegReader().read(path)
    assert largest.stack.provenance["segment"] == "1 (flesh)"
    assert "3 segments are here (1 (flesh), 2 (core), 3 (over))" in largest.stack.notices[0].message


def test_a_label_map_segmentation_is_read(tmp_path):
    labels = masks()[..., :2] @ np.array([1, 2])
    path = tmp_path / "SEG"
    path.write_bytes(segmentation(volume(), labels, ["flesh", "core"], "LABELMAP"))
    assert [count(path, object=name) for name in ("flesh", "core")] == pytest.approx([1575, 600])


def test_all_segments_are_measured_with_their_numbers(tmp_path):
    found = stackloft.measure(written(tmp_path, masks()), "voxel", object="all").objects
    assert [(each.label, round(each.volume.value / VOXEL)) for each in found] == [
        ("segment 1", 1575), ("segment 2", 600), ("segment 3", 100),
    ]  # fmt: skip


@pytest.mark.parametrize("omit", [True, False])
def test_planes_left_out_as_empty_keep_the_others_in_their_places(tmp_path, omit):
    made = np.zeros((9, *SHAPE, 2))
    made[[0, 1, 2, 6, 7, 8], 5:20, 5:20, 0] = 1
    made[6:9, 5:20, 25:30, 1] = 1
    path = written(tmp_path, made, omit_empty_frames=omit)
    stack = DicomSegReader(object="2").read(path).stack
    places = [(stack.affine @ [0.0, 0.0, z, 1.0])[:3] for z in stack.positions]
    assert np.allclose(places, [volume().corner(k) for k in (6, 7, 8)], atol=1e-4)
    whole = DicomSegReader(object="1").read(path)
    assert count(path, object="1") == pytest.approx(3 * 225)
    assert "left out" in " ".join(notice.message for notice in whole.notices)
    assert np.allclose(np.diff(whole.stack.positions), 2.5)


def test_places_in_space_are_those_of_the_pictures(tmp_path):
    scan = volume(tilt=12.0)
    made = np.zeros((9, *SHAPE, 1))
    for k in range(9):
        made[k, 3 + k : 15, 4:20] = 1
    stack = DicomSegReader().read(written(tmp_path, made, scan=scan)).stack
    for k in range(len(stack)):
        corner = stack.affine @ [0.0, 0.0, stack.positions[k], 1.0]
        nearest = min(range(9), key=lambda j: np.linalg.norm(scan.corner(j) - corner[:3]))
        assert np.allclose(corner[:3], scan.corner(nearest), atol=1e-4)
        assert stack.decode(k).sum() == made[nearest].sum()
    assert "12.00°" in stack.notices[0].message


@pytest.mark.parametrize("form", ["nrrd", "dicom-seg"])
def test_a_binary_segment_gives_the_figures_of_the_label_map(tmp_path, form):
    folders = {each: tmp_path / each for each in ("nifti", form)}
    for each, folder in folders.items():
        write_phantom("potato", each, folder, pixel_size=1.2, label=1)
    sources = [
        tmp_path / "nifti" / "scan.nii.gz",
        folders[form] / "scan.nrrd" if form == "nrrd" else folders[form],
    ]
    figures = [stackloft.measure(source).objects[0] for source in sources]
    assert figures[0].volume.value == pytest.approx(figures[1].volume.value, rel=1e-6)
    assert figures[0].area.value == pytest.approx(figures[1].area.value, rel=1e-6)


def test_a_fractional_segment_gives_the_figures_of_the_grey_slabs(tmp_path):
    for form in ("dicom", "dicom-seg"):
        write_phantom("potato", form, tmp_path / form, pixel_size=1.0)
    grey, share = (stackloft.measure(tmp_path / form).objects[0] for form in ("dicom", "dicom-seg"))
    assert share.volume.value == pytest.approx(grey.volume.value, rel=1e-3)  # 200 steps instead of 1040
    assert share.area.value == pytest.approx(grey.area.value, rel=1e-3)


def test_segments_that_are_not_there_are_refused(tmp_path):
    path = written(tmp_path, masks())
    with pytest.raises(UsageError, match=r"no such segment; found: 7; expected: 1 \(flesh\), 2"):
        DicomSegReader(object="7").read(path)
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match="no folder with one DICOM segmentation"):
        DicomSegReader().read(tmp_path / "none")


def test_who_the_patient_is_stays_in_the_file(tmp_path):
    path = tmp_path / "SEG"
    path.write_bytes(segmentation(volume(), masks(), ["Grey flesh", "PH-2007", "over"]))
    found = DicomSegReader().read(path)
    text = repr((found.notices, found.stack.notices, dict(found.stack.provenance), found.stack.names))
    assert not [word for word in ("Grey", "2007", "Phantom") if word in text]
    kept = DicomSegReader(keep_identifiers=True).read(path)
    assert kept.stack.provenance["PatientName"] == "Phantom^Grey"


def test_a_segmentation_beside_its_pictures_is_left_out_and_told(series):
    path = written(series, masks())
    stack = DicomReader().read(series)
    assert len(stack) == 8
    assert "SEG (SEG)" in stack.notices[0].message
    assert DicomSegReader().probe(path) > DicomReader().probe(path)
