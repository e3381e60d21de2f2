"""ParaVision's 2dseq: the numbers and places that visu_pars tells, or a refusal that names the parameter."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import stackloft
from stackloft.model.errors import InputError, StackloftError, UsageError
from stackloft.testing.phantoms import write_phantom
from stackloft.testing.phantoms.scan_bruker import visu_pars, write_bruker
from stackloft_plugins.readers.bruker import BrukerReader
from stackloft_plugins.readers.jcamp import parse_parameters

AXIAL = np.eye(3).ravel()
SAGITTAL = np.array([0.0, 1, 0, 0, 0, 1, 1, 0, 0])
TYPES = {"_8BIT_UNSGN_INT": "u1", "_16BIT_SGN_INT": "i2", "_32BIT_SGN_INT": "i4", "_32BIT_FLOAT": "f4"}


def entries(count=4, size=(5, 3), **changes):
    """The parameters of `count` axial frames, 2 mm apart, with pixels of 0.5 × 0.8 mm."""
    z = 2.0 * np.arange(count) - 3.3
    made = {
        "VisuCoreFrameCount": count,
        "VisuCoreDim": 2,
        "VisuCoreSize": np.array(size),
        "VisuCoreDimDesc": ["spatial", "spatial"],
        "VisuCoreExtent": np.array([0.5 * size[0], 0.8 * size[1]]),
        "VisuCoreFrameThickness": np.array([1.5]),
        "VisuCoreUnits": ["<mm>", "<mm>"],
        "VisuCoreOrientation": np.tile(AXIAL, (count, 1)),
        "VisuCorePosition": np.column_stack([np.full(count, -4.0), np.full(count, 7.5), z]),
        "VisuCoreDataOffs": np.arange(count) + 0.5,
        "VisuCoreDataSlope": 2.0 + np.arange(count),
        "VisuCoreWordType": "_16BIT_SGN_INT",
        "VisuCoreByteOrder": "littleEndian",
        "VisuFGOrderDesc": [f"({count}, <FG_SLICE>, <a comment>, 0, 2)"],
    }
    return {key: value for key, value in {**made, **changes}.items() if value is not None}


def written(folder, values=None, dtype="<i2", **changes):
    made = entries(**changes)
    size = made["VisuCoreSize"].astype(int)
    stored = np.arange(made["VisuCoreFrameCount"] * size.prod()) % 251 if values is None else values
    (folder / "2dseq").write_bytes(np.asarray(stored).astype(dtype).tobytes())
    (folder / "visu_pars").write_text(visu_pars(**made))
    return np.asarray(stored, dtype=float).reshape(-1, *size[::-1])


@pytest.mark.parametrize("word", TYPES)
@pytest.mark.parametrize(("order", "mark"), [("littleEndian", "<"), ("bigEndian", ">")])
def test_numbers_come_back_by_type_order_slope_and_offset(tmp_path, word, order, mark):
    stored = written(tmp_path, dtype=mark + TYPES[word], VisuCoreWordType=word, VisuCoreByteOrder=order)
    stack = BrukerReader().read(tmp_path)
    for k in range(4):
        assert np.allclose(stack.decode(k), stored[k] * (2 + k) + 0.5 + k)
    assert stack.pixel_spacing[0].tolist() == pytest.approx([0.8, 0.5])
    assert np.allclose(stack.positions, 2.0 * np.arange(4) - 3.3)
    assert np.allclose(stack.affine @ [0, 0, stack.positions[2], 1], [-4, 7.5, 0.7, 1])
    assert stack.thickness.tolist() == [1.5] * 4
    assert stack.notices[0].code == "slab-gaps"


def test_descending_and_oblique_slices_lie_where_they_are_said_to(tmp_path):
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn[:, 2] = np.cross(turn[:, 0], turn[:, 1])
    corners = np.array([[3.0, 4, 5]]) - 1.7 * np.arange(4)[:, None] * turn[:, 2]
    stored = written(tmp_path, VisuCoreOrientation=np.tile(turn.T.ravel(), (4, 1)), VisuCorePosition=corners)
    stack = BrukerReader().read(tmp_path)
    assert np.allclose(np.diff(stack.positions), 1.7)
    for k in range(4):
        assert np.allclose((stack.affine @ [0, 0, stack.positions[k], 1])[:3], corners[3 - k])
        assert np.allclose(stack.decode(k), stored[3 - k] * (5 - k) + 3.5 - k)


def test_values_given_once_or_for_each_slice_serve_all_frames(tmp_path):
    groups = ["(2, <FG_ECHO>, <>, 0, 1) (3, <FG_SLICE>, <>, 1, 2)"]
    changes = {
        "VisuFGOrderDesc": groups,
        "VisuCorePosition": entries(3)["VisuCorePosition"],
        "VisuCoreOrientation": AXIAL[None],
        "VisuCoreDataSlope": np.full(6, 3.0),
        "VisuCoreDataOffs": np.zeros(6),
    }
    stored = written(tmp_path, count=6, **changes)
    with pytest.raises(InputError, match=r"holds 2 frames at each place.*bruker\.volume=1 … 2"):
        BrukerReader().read(tmp_path)
    for volume in (1, 2):
        stack = BrukerReader(volume=volume).read(tmp_path)
        assert np.allclose(stack.positions, [-3.3, -1.3, 0.7])
        for k in range(3):
            assert np.allclose(stack.decode(k), 3 * stored[2 * k + volume - 1])
    with pytest.raises(UsageError, match="expected: 1 to 2"):
        BrukerReader(volume=3).read(tmp_path)


def test_packages_of_slices_are_told_apart_by_their_direction(tmp_path):
    turns = np.array([AXIAL] * 3 + [SAGITTAL] * 4)
    corners = np.array([[0.0, 0, z] for z in (0, 2, 4)] + [[x, 0.0, 0] for x in (0, 3, 6, 9)])
    stored = written(tmp_path, count=7, VisuCoreOrientation=turns, VisuCorePosition=corners)
    stack = BrukerReader().read(tmp_path)
    assert "2 packages of parallel slices are here (1: 3 slices, 2: 4 slices)" in stack.notices[0].message
    assert np.allclose(np.diff(stack.positions), 3)
    first = BrukerReader(package=1).read(tmp_path)
    assert np.allclose(first.positions, [0, 2, 4])
    assert np.allclose(first.decode(1), stored[1] * 3 + 1.5)
    with pytest.raises(UsageError, match="expected: 1: 3 slices"):
        BrukerReader(package=3).read(tmp_path)


@pytest.mark.parametrize("order", ["disk_normal_slice_order", "disk_reverse_slice_order"])
@pytest.mark.parametrize("handed", [1.0, -1.0])
def test_a_three_dimensional_frame_is_a_block(tmp_path, order, handed):
    turn = np.array([1.0, 0, 0, 0, 1, 0, 0, 0, handed])
    stored = np.arange(2 * 3 * 4 * 5).reshape(2, 3, 4, 5)
    written(
        tmp_path, stored, count=2, VisuCoreDim=3, VisuCoreSize=np.array([5, 4, 3]),
        VisuCoreDimDesc=["spatial"] * 3, VisuCoreExtent=np.array([2.5, 3.2, 4.5]), VisuCoreUnits=["<mm>"] * 3,
        VisuCoreOrientation=turn[None], VisuCorePosition=np.array([[1.0, 2, 3]]),
        VisuFGOrderDesc=["(2, <FG_MOVIE>, <>, 0, 0)"], VisuCoreDiskSliceOrder=order,
        VisuCoreDataSlope=np.ones(2), VisuCoreDataOffs=np.zeros(2),
    )  # fmt: skip
    stack = BrukerReader(volume=2).read(tmp_path)
    assert stack.shape == (4, 5)
    for k in range(3):
        place = (stack.affine @ [0, 0, stack.positions[k], 1])[:3]
        index = round(handed * (place[2] - 3) / 1.5)
        assert np.allclose(place, [1, 2, 3 + handed * 1.5 * index])
        kept = index if order == "disk_normal_slice_order" else 2 - index
        assert np.array_equal(stack.decode(k), stored[1, kept])


def test_slices_stored_backwards_are_turned_round(tmp_path):
    scale = {"VisuCoreDataSlope": np.ones(4), "VisuCoreDataOffs": np.zeros(4)}
    stored = written(tmp_path, VisuCoreDiskSliceOrder="disk_reverse_slice_order", **scale)
    stack = BrukerReader().read(tmp_path)
    assert all(np.array_equal(stack.decode(k), stored[3 - k]) for k in range(4))


@pytest.mark.parametrize(
    "name",
    [
        "VisuCoreFrameCount", "VisuCoreDim", "VisuCoreSize", "VisuCoreExtent", "VisuCorePosition",
        "VisuCoreOrientation", "VisuCoreWordType", "VisuCoreByteOrder", "VisuCoreDataSlope",
        "VisuCoreDataOffs",
    ],
)  # fmt: skip
def test_a_missing_parameter_is_named(tmp_path, name):
    made = entries()
    written(tmp_path)
    del made[name]
    (tmp_path / "visu_pars").write_text(visu_pars(**made))
    with pytest.raises(InputError, match=f"visu_pars: does not say {name}"):
        BrukerReader().read(tmp_path)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"VisuCoreDim": 1}, "VisuCoreDim is impossible"),
        ({"VisuCoreDimDesc": ["spatial", "spectroscopic"]}, "spatial dimensions alone"),
        ({"VisuCoreUnits": ["<mm>", "<ppm>"]}, "VisuCoreUnits is impossible"),
        ({"VisuCoreExtent": np.array([0.0, 3.0])}, "VisuCoreExtent is impossible"),
        ({"VisuCoreWordType": "_64BIT_FLOAT"}, "VisuCoreWordType is impossible"),
        ({"VisuCorePosition": np.zeros((2, 3))}, "VisuCorePosition is wrong"),
        ({"VisuCorePosition": np.zeros((4, 3))}, "same place"),
        ({"VisuCoreOrientation": np.ones((4, 9))}, "VisuCoreOrientation is impossible"),
        ({"VisuCoreDataSlope": np.zeros(4)}, "VisuCoreDataSlope is impossible"),
        ({"VisuCoreFrameCount": 5}, "VisuFGOrderDesc is impossible"),
        ({"VisuCoreFrameType": "COMPLEX_IMAGE"}, "holds complex numbers"),
        ({"VisuFGOrderDesc": ["(4, <FG_SLICE"]}, "VisuFGOrderDesc is impossible"),
    ],
)
def test_what_is_impossible_is_named(tmp_path, changes, words):
    written(tmp_path)
    (tmp_path / "visu_pars").write_text(visu_pars(**entries(**changes)))
    with pytest.raises(InputError, match=words):
        BrukerReader().read(tmp_path)


def test_a_missing_slice_numbers_cut_off_and_a_contradicting_reco_are_refused(tmp_path):
    places = entries()["VisuCorePosition"]
    places[3, 2] += 4
    written(tmp_path, VisuCorePosition=places)
    with pytest.raises(InputError, match=r"a slice is missing.*2dseq\[3\] and 2dseq\[4\]"):
        BrukerReader().read(tmp_path)
    assert len(BrukerReader(allow_gaps=True).read(tmp_path)) == 4
    written(tmp_path)
    (tmp_path / "reco").write_text(visu_pars(RECO_wordtype="_32BIT_SGN_INT"))
    with pytest.raises(InputError, match="reco and visu_pars contradict"):
        BrukerReader().read(tmp_path)
    (tmp_path / "reco").unlink()
    path = tmp_path / "2dseq"
    path.write_bytes(path.read_bytes()[:-2])
    with pytest.raises(InputError, match="found: 118 bytes; expected: 120 bytes: 4 frames of 5 × 3"):
        BrukerReader().read(tmp_path)


def test_a_scan_folder_serves_when_it_has_one_reconstruction(tmp_path, scan):
    for number in (1, 2):
        folder = tmp_path / "3" / "pdata" / str(number)
        folder.mkdir(parents=True)
        write_bruker(scan(), folder)
        if number == 1:
            assert len(stackloft.read(tmp_path / "3")) == len(stackloft.read(folder / "2dseq")) == 8
    with pytest.raises(InputError, match=r"holds 2 reconstructions; found: pdata/1, pdata/2"):
        BrukerReader().read(tmp_path / "3")
    assert BrukerReader().probe(tmp_path / "3") == 0.0


def test_figures_are_those_of_the_same_scan_as_dicom(tmp_path):
    for form in ("dicom", "bruker"):
        write_phantom("potato", form, tmp_path / form, pixel_size=1.5, tilt=8, cosines=4, origin=(5, 6, 7))
    figures = [stackloft.measure(tmp_path / form).objects[0] for form in ("dicom", "bruker")]
    assert figures[0].volume.value == pytest.approx(figures[1].volume.value, rel=1e-6)
    assert figures[0].area.value == pytest.approx(figures[1].area.value, rel=1e-6)


def test_who_the_subject_is_stays_in_the_file(tmp_path, scan):
    write_bruker(scan(), tmp_path)
    stack = BrukerReader().read(tmp_path)
    text = repr((stack.notices, dict(stack.provenance), stack.names))
    assert not [word for word in ("Grey", "PH-2007") if word in text]


SOUND = visu_pars(**entries())


@given(st.text(alphabet="#$@*()<>,. =\n0129eE-+abVisuCore", max_size=300))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_any_text_is_parsed_or_refused(tmp_path_factory, text):
    try:
        read = parse_parameters(text, tmp_path_factory.getbasetemp() / "visu_pars")
        for name in read.entries:
            read.words(name), read.structures(name)
            read.numbers(name)
    except InputError:
        pass


@given(
    st.integers(0, len(SOUND) - 1), st.text(alphabet="0129-.eE@*()<> \n#$inf", max_size=6), st.integers(0, 9)
)
@settings(
    max_examples=300, deadline=None, derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)  # fmt: skip
def test_spoilt_parameters_are_refused_or_place_the_slices(tmp_path, place, text, cut):
    written(tmp_path)
    spoilt = SOUND[:place] + text + SOUND[place + cut :]
    (tmp_path / "visu_pars").write_text(spoilt)
    try:
        stack = BrukerReader().read(tmp_path)
        pictures = [stack.decode(k) for k in range(len(stack))]
    except StackloftError as error:
        found = str(error)
        if "\n" in found:
            pytest.fail(found)
        return
    assert all(picture.shape == stack.shape and np.isfinite(picture).all() for picture in pictures)
    assert (np.diff(stack.positions) > 0).all()
