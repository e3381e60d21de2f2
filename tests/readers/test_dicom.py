"""DICOM series are placed by position alone, and what cannot be placed is refused by name."""

import shutil

import numpy as np
import pydicom
import pytest
from pydicom.dataset import FileMetaDataset

from stackloft.model.errors import InputError, UsageError
from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft_plugins.readers import dicom_codecs
from stackloft_plugins.readers.dicom import DicomReader


def refusal(source, **options):
    with pytest.raises(InputError) as caught:
        drained(DicomReader(**options), source)
    return str(caught.value)


def drained(reader, source):
    stack = reader.read(source)
    return [stack.decode(k) for k in range(len(stack))]


def codes(stack):
    return [notice.code for notice in stack.notices]


def patient(stack, k, row, column):
    """Where a pixel of slice k lies, patient millimetres."""
    down, across = stack.pixel_spacing[k]
    return (stack.affine @ [column * across, row * down, stack.positions[k], 1.0])[:3]


def expected_corner(volume, k):
    grid = volume.grid
    z = grid.positions[k]
    return volume.turn @ [grid.origin[0], grid.origin[1] + grid.shear * z, z] + volume.origin


@pytest.mark.parametrize("multiframe", [False, True])
@pytest.mark.parametrize("tilt", [-20.0, 0.0, 12.5])
def test_geometry_of_tilted_turned_and_shifted_slices(tmp_path, tilt, multiframe, scan):
    positions = [-31.7, -29.2, -26.7, -24.9, -21.7, -19.2, -16.7, -14.2]
    volume = scan(positions=positions, thickness=2.0, tilt=tilt, multiframe=multiframe)
    write_dicom(volume, tmp_path)
    stack = DicomReader().read(tmp_path)
    assert np.allclose(np.diff(stack.positions), np.diff(positions), atol=1e-9)
    assert abs(np.linalg.det(stack.affine[:3, :3]) - 1) < 1e-9
    row, column = volume.grid.spacing
    for k in range(8):
        corner = expected_corner(volume, k)
        assert np.allclose(patient(stack, k, 0, 0), corner, atol=1e-9)
        assert np.allclose(patient(stack, k, 5, 0), corner + 5 * row * volume.turn[:, 1], atol=1e-9)
        assert np.allclose(patient(stack, k, 0, 5), corner + 5 * column * volume.turn[:, 0], atol=1e-9)
        assert np.array_equal(stack.decode(k), volume.slices[k])
    assert "uneven-spacing" in codes(stack)
    assert ("tilt" in codes(stack)) == bool(tilt)
    assert "slab-gaps" in codes(stack)
    assert (stack.thickness == 2.0).all()


def test_names_and_instance_numbers_place_nothing(eight, series, edit):
    expected = DicomReader().read(eight)
    for k, path in enumerate(sorted(series.iterdir())):
        edit(path, series / f"{(k * 5) % 8}.ima", InstanceNumber=1)
        path.unlink()
    stack = DicomReader().read(series)
    assert np.array_equal(stack.positions, expected.positions)
    assert all(np.array_equal(stack.decode(k), expected.decode(k)) for k in range(8))


def test_spacing_tags_place_nothing(eight, series, edit):
    for path in series.iterdir():
        edit(path, SpacingBetweenSlices="99", SliceThickness="1.25")
    stack = DicomReader().read(series)
    assert np.array_equal(stack.positions, DicomReader().read(eight).positions)
    assert "slab-gaps" in codes(stack)


def test_a_missing_slice_is_refused_unless_allowed(series):
    (series / "IM0004").unlink()
    message = refusal(series)
    for word in ("IM0003", "IM0005", "5 mm", "2.5 mm", "dicom.allow_gaps=true"):
        assert word in message, word
    stack = DicomReader(allow_gaps=True).read(series)
    assert len(stack) == 7
    assert "gap" in codes(stack)
    assert np.allclose(np.sort(np.diff(stack.positions)), [2.5] * 5 + [5.0])


def test_a_pitch_that_changes_with_the_thickness_is_no_gap(tmp_path, edit, scan):
    positions = [0.0, 2.5, 5.0, 7.5, 12.5, 17.5, 22.5, 27.5]
    write_dicom(scan(positions=positions), tmp_path)
    assert "a slice is missing" in refusal(tmp_path)
    for k in range(4, 8):
        edit(tmp_path / f"IM{8 - k:04d}", SliceThickness="5.0")
    assert np.allclose(np.diff(DicomReader().read(tmp_path).positions), np.diff(positions))


def test_a_duplicate_is_refused(series):
    shutil.copy(series / "IM0003", series / "copy")
    message = refusal(series)
    assert "IM0003" in message
    assert "copy" in message
    assert "same place" in message


def test_slices_all_at_one_place_are_refused(series, edit):
    for path in series.iterdir():
        edit(path, ImagePositionPatient=["1", "2", "3"])
    assert "IM0001" in refusal(series)


def test_repeated_volumes_are_chosen_by_number(eight, series, edit):
    for k, path in enumerate(sorted(series.iterdir())):
        picture = pydicom.dcmread(path)
        later = np.frombuffer(picture.PixelData, "<u2") + 7
        edit(path, series / f"echo_{k}", InstanceNumber=100 + k, PixelData=later.astype("<u2").tobytes())
    assert "dicom.volume=1" in refusal(series)
    first, second = DicomReader(volume=1).read(series), DicomReader(volume=2).read(series)
    assert np.array_equal(first.decode(3), DicomReader().read(eight).decode(3))
    assert np.array_equal(second.decode(3), first.decode(3) + 7)
    assert "no volume 3" in refusal(series, volume=3)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"ImageOrientationPatient": ["1", "0", "0", "0", "1", "0"]}, "orientation"),
        ({"PixelSpacing": ["0.7", "0.41"]}, "pixel spacing"),
        ({"Rows": 31, "Columns": 24}, "size"),
        (
            {"ImageOrientationPatient": ["1", "0", "0", "0", "1", "0"], "ImageType": ["O", "P", "LOCALIZER"]},
            "localizer",
        ),
    ],
)
def test_a_slice_unlike_the_others_is_refused_or_left_out(series, change, word, edit):
    edit(series / "IM0001", **change)
    message = refusal(series)
    assert "IM0001" in message
    assert word in message
    assert "dicom.leave_out=true" in message
    stack = DicomReader(leave_out=True).read(series)
    assert len(stack) == 7
    assert "left-out" in codes(stack)


def test_a_slice_beside_the_line_is_refused(series, edit):
    moved = pydicom.dcmread(series / "IM0004").ImagePositionPatient
    moved[1] = float(moved[1]) + 0.3
    edit(series / "IM0004", ImagePositionPatient=moved)
    assert "IM0004" in refusal(series)


def test_a_position_that_slice_location_contradicts_is_refused(series, edit, scan):
    for path in series.iterdir():
        z = np.array(pydicom.dcmread(path).ImagePositionPatient, float) @ scan().turn[:, 2]
        edit(path, SliceLocation=f"{100 - z:.6f}")
    DicomReader().read(series)
    edit(series / "IM0005", SliceLocation="0")
    assert "IM0005" in refusal(series)


def test_several_series_the_largest_is_taken_and_told(series, edit):
    for number in (1, 2, 3):
        other = edit(
            series / f"IM000{number}", series / f"x{number}", SeriesInstanceUID="1.2.3", SeriesNumber=7
        )
    stack = DicomReader().read(series)
    assert len(stack) == 8
    notice = next(notice for notice in stack.notices if notice.code == "several-series")
    assert "1: CT 8 × 31×24" in notice.message
    assert "7: CT 3 × 31×24" in notice.message
    assert other.SeriesInstanceUID not in notice.message
    for wanted in ("7", "#2", "1.2.3"):
        assert len(DicomReader(series=wanted).read(series)) == 3
    with pytest.raises(UsageError, match="7: CT 3"):
        DicomReader(series="4").read(series)


def test_folders_in_folders_and_notes_beside(eight, series):
    (series / "sub" / "deep").mkdir(parents=True)
    for k in (1, 4, 6):
        (series / f"IM000{k}").rename(series / "sub" / "deep" / f"IM000{k}")
    (series / "README").write_text("scanned on a Tuesday")
    assert np.array_equal(DicomReader().read(series).positions, DicomReader().read(eight).positions)


def test_a_dicomdir_names_its_files(eight, series):
    (series / "IMG").mkdir()
    for path in list(series.glob("IM0*")):
        path.rename(series / "IMG" / path.name)
    data = pydicom.Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID = "1.2.840.10008.1.3.10"
    data.file_meta.MediaStorageSOPInstanceUID = "1.2.9"
    records = []
    for k in range(1, 9):
        record = pydicom.Dataset()
        record.DirectoryRecordType, record.ReferencedFileID = "IMAGE", ["IMG", f"IM000{k}"]
        records.append(record)
    data.DirectoryRecordSequence = records
    data.save_as(series / "DICOMDIR", enforce_file_format=True)
    expected = DicomReader().read(eight).positions
    for source in (series / "DICOMDIR", series):
        assert DicomReader().probe(source) > 0.8
        assert np.array_equal(DicomReader().read(source).positions, expected)
    (series / "IMG" / "IM0004").unlink()
    assert "IMG/IM0004" in refusal(series / "DICOMDIR")


def test_files_without_preamble_or_meta(eight, series):
    for path in series.iterdir():
        data = pydicom.dcmread(path)
        data.file_meta, data.preamble = FileMetaDataset(), None
        pydicom.dcmwrite(path, data, implicit_vr=True, little_endian=True)
        assert path.read_bytes()[128:132] != b"DICM"
    assert DicomReader().probe(series) > 0.8
    stack, expected = DicomReader().read(series), DicomReader().read(eight)
    assert all(np.array_equal(stack.decode(k), expected.decode(k)) for k in range(8))


def test_signed_pixels_padding_and_a_scale_of_each_slice(eight, series, edit):
    expected = DicomReader().read(eight)
    for k, path in enumerate(sorted(series.iterdir())):
        slope = 0.5 + k / 8
        wanted = np.frombuffer(pydicom.dcmread(path).PixelData, "<u2").astype(float) - 1024
        stored = np.round((wanted - 3.25) / slope).astype("<i2")
        stored[:9] = -2000
        edit(
            path,
            PixelData=stored.tobytes(),
            PixelRepresentation=1,
            RescaleSlope=str(slope),
            RescaleIntercept="3.25",
        )
        data = pydicom.dcmread(path)
        data.add_new("PixelPaddingValue", "US", 65536 - 2000)
        data.save_as(path)
    stack = DicomReader().read(series)
    for k in range(8):
        assert np.abs(stack.decode(k) - expected.decode(k)).max() <= 0.75
        assert stack.decode(k).dtype == np.float32


def test_monochrome1_is_turned_over(eight, series, edit):
    expected = DicomReader().read(eight)
    for path in series.iterdir():
        stored = 4095 - np.frombuffer(pydicom.dcmread(path).PixelData, "<u2")
        bare = dict.fromkeys(("RescaleSlope", "RescaleIntercept", "RescaleType"))
        bits = {"PhotometricInterpretation": "MONOCHROME1", "BitsStored": 12, "HighBit": 11}
        edit(path, PixelData=stored.tobytes(), **bits, **bare)
    stack = DicomReader().read(series)
    assert all(np.array_equal(stack.decode(k), expected.decode(k) + 1024) for k in range(8))


def test_a_mosaic_is_refused_by_name(series, edit):
    edit(series / "IM0002", ImageType=["ORIGINAL", "PRIMARY", "M", "MOSAIC"])
    message = refusal(series)
    assert "mosaic" in message
    assert "IM0002" in message


@pytest.mark.parametrize("name", ["PixelSpacing", "ImagePositionPatient", "ImageOrientationPatient"])
def test_a_slice_without_its_place_is_refused(series, name, edit):
    edit(series / "IM0002", **{name: None})
    message = refusal(series)
    assert "IM0002" in message
    assert pydicom.datadict.dictionary_description(name) in message


def test_a_missing_decoder_is_named_with_its_pip_line(series, monkeypatch):
    for path in series.iterdir():
        data = pydicom.dcmread(path)
        data.compress(pydicom.uid.JPEGLSLossless)
        data.save_as(path)
    decoder = pydicom.pixels.get_decoder(pydicom.uid.JPEGLSLossless)
    monkeypatch.setattr(decoder, "_available", {})
    message = refusal(series)
    for word in ("JPEG-LS Lossless", "1.2.840.10008.1.2.4.80", "python-gdcm", "pip install pyjpegls"):
        assert word in message, word


def test_every_package_named_for_a_syntax_is_one_that_pydicom_asks_for():
    for syntax, packages in dicom_codecs.PACKAGES.items():
        decoder = pydicom.pixels.get_decoder(pydicom.uid.UID(syntax))
        assert decoder.is_available
        wanted = {
            "pyjpegls": "pyjpegls",
            "python-gdcm": "gdcm",
            "pylibjpeg-libjpeg": "pylibjpeg",
            "pylibjpeg-openjpeg": "pylibjpeg",
        }
        assert {wanted[package] for package in packages} <= set(decoder.available_plugins), syntax
