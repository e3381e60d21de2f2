"""Scans from real machines, where they are at hand (/work/shared/real)."""

from pathlib import Path

import numpy as np
import pytest
import SimpleITK

import stackloft
from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom import DicomReader
from stackloft_plugins.readers.dicom_codestream import check_codestream
from stackloft_plugins.readers.dicom_file import ClampedFile
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_pixels import decode_frame
from stackloft_plugins.readers.itk import ItkReader

REAL = Path("/work/shared/real")
pytestmark = pytest.mark.skipif(not REAL.is_dir(), reason="the real scans are not at hand")


def frame_of(path):
    """A frame of a mosaic, which `read` refuses: its pixels can still be compared."""
    import pydicom  # noqa: PLC0415

    data = pydicom.dcmread(path, stop_before_pixels=True)
    zero = np.zeros(3)
    return Frame(
        path, path.name, 0, "", None, "MR", (), (data.Rows, data.Columns), 1, zero, np.eye(3)[:2], (1.0, 1.0),
        None, None, 1.0, 0.0, False, False, None, (0, 4095), False, data.file_meta.TransferSyntaxUID, False,
    )  # fmt: skip


def test_nine_files_of_seven_transfer_syntaxes_hold_the_same_pixels():
    paths = sorted((REAL / "transfer_syntaxes").iterdir())
    frames = [frame_of(path) for path in paths]
    assert len(frames) == 9
    assert len({frame.syntax for frame in frames}) == 7
    first = decode_frame(frames[0])
    for frame in frames:
        with ClampedFile(frame.path) as stream:
            check_codestream(stream, frame)
        assert np.array_equal(decode_frame(frame), first), frame.name
    with pytest.raises(InputError, match=r"1\.dcm: is a Siemens mosaic"):
        DicomReader().read(REAL / "transfer_syntaxes")


@pytest.mark.parametrize("codec", ["rle", "jpeg", "jpegls", "j2k"])
def test_every_codec_equals_its_ground_truth(codec):
    folder = REAL / "defects" / f"compressed_{codec}"
    stack = DicomReader().read(folder / "001")
    truth = SimpleITK.ReadImage(str(folder / "001_ground_truth.nii.gz"))
    values = SimpleITK.GetArrayFromImage(truth)
    assert len(stack) == 4
    for k in range(4):
        picture = stack.decode(k)
        for row, column in np.random.default_rng(k).integers(0, 256, (200, 2)):
            place = stack.affine @ [column, row, stack.positions[k], 1.0]
            x, y, z = truth.TransformPhysicalPointToIndex(place[:3].tolist())
            assert picture[row, column] == values[z, y, x]


def test_tilt_is_put_right_and_gaps_are_refused():
    stack = DicomReader().read(REAL / "defects" / "gantrytilting" / "001")
    assert np.allclose(np.diff(stack.positions), 5 * 0.970295726276, atol=1e-6)
    assert "14.00°" in stack.notices[0].message
    assert np.allclose(
        stack.affine @ [0, 0, stack.positions[3], 1], [-106.791015625, -256.61886606561, -46.951915066986, 1]
    )
    for folder, names in (("001", ("0009", "0010")), ("002", ("0003", "0005"))):
        source = REAL / "defects" / "sliceincrement" / folder
        with pytest.raises(InputError, match="a slice is missing") as caught:
            DicomReader().read(source)
        assert all(name in str(caught.value) for name in names)
        assert len(DicomReader(allow_gaps=True).read(source)) == 4


def test_an_enhanced_file_has_its_geometry():
    folder = REAL / "enhanced_mr" / "Siemens"
    stack = DicomReader().read(folder / "011-0002.img")
    assert len(stack) == 25
    assert stack.shape == (64, 64)
    assert np.allclose(stack.pixel_spacing, 3.28125)
    assert np.allclose(np.diff(stack.positions), 3.3)
    assert (stack.thickness == 3.0).all()
    assert np.allclose(stack.affine @ [0, 0, stack.positions[0], 1], [-105, -105, -79.6, 1])
    with pytest.raises(InputError, match="4 volumes at the same places"):
        DicomReader().read(folder)
    assert np.array_equal(DicomReader(volume=2).read(folder).decode(7), stack.decode(7))


@pytest.mark.parametrize("method", ["cavalieri", "frustum"])
def test_the_acr_phantom_with_gaps_between_its_slabs(method):
    options = {"settings": {"cavalieri": {"rule": "trapezoid"}}} if method == "cavalieri" else {}
    result = stackloft.measure(REAL / "acr_mri", method, **options)
    assert 2790e3 < result.objects[0].volume.value < 2880e3
    assert "slab-gaps" in [notice.code for notice in result.warnings]


def test_every_banana_of_the_label_map_is_its_own_body():
    path = REAL / "banana_mri" / "raw_segmentation.nii.gz"
    values = SimpleITK.GetArrayFromImage(SimpleITK.ReadImage(str(path)))
    result = stackloft.measure(path, "voxel", object="all")
    assert [body.label for body in result.objects] == [f"label {k}" for k in range(1, 6)]
    for k, body in enumerate(result.objects, start=1):
        pieces = SimpleITK.RelabelComponent(
            SimpleITK.ConnectedComponent(SimpleITK.GetImageFromArray((values == k) * 1))
        )
        largest = (SimpleITK.GetArrayFromImage(pieces) == 1).sum()
        assert body.volume.value == pytest.approx(largest, rel=1e-3)


def test_the_affine_of_a_nifti_file_is_kept():
    path = REAL / "banana_mri" / "20140612_142959t2tsevflisos006a1001.nii.gz"
    image = SimpleITK.ReadImage(str(path))
    stack = ItkReader().read(path)
    values = SimpleITK.GetArrayFromImage(image)
    for k, row, column in ((0, 0, 0), (90, 17, 200), (207, 225, 255)):
        place = stack.affine @ [column, row, stack.positions[k], 1.0]
        x, y, z = image.TransformPhysicalPointToIndex(place[:3].tolist())
        assert (x, y) == (column, row)
        assert stack.decode(k)[row, column] == values[z, y, x]
