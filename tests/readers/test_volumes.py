"""One body in every form of file measures the same; what a file does not say is asked for."""

import numpy as np
import pytest
import SimpleITK
import tifffile

import stackloft
from stackloft.model.errors import InputError
from stackloft.model.segmentation import Segmentation
from stackloft.testing import phantoms
from stackloft_plugins.readers.itk import ItkReader
from stackloft_plugins.readers.numpy_file import NumpyReader
from stackloft_plugins.readers.tiff import TiffReader

METHODS = "loft,partial-volume"
BODY = {"name": "ellipsoid", "a": 21, "b": 17, "c": 25, "rotation": 7, "offset": (12.5, -4.0, 130.0)}


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    body, found = phantoms.make(**BODY), {}
    for form in ("dicom", "nrrd", "nifti", "tiff"):
        folder = tmp_path_factory.mktemp(form)
        scanner = phantoms.Scans(
            form=form, sections=14, pixel_size=1.1, stretch=1.3, origin=(31.7, -222.0, 8.9)
        )
        found[form] = scanner.write(body, folder)[0] if form != "dicom" else folder
        scanner.write(body, folder)
    tilted = tmp_path_factory.mktemp("tilted")
    phantoms.Scans(sections=14, pixel_size=1.1, stretch=1.3, tilt=20.0, cosines=5).write(body, tilted)
    return {**found, "tilted": tilted}


@pytest.fixture(scope="module")
def figures(scans):
    return {form: stackloft.measure(path, METHODS).objects[0].methods for form, path in scans.items()}


@pytest.mark.parametrize("form", ["nrrd", "nifti", "tiff"])
def test_every_form_measures_the_same(figures, form):
    for method in ("loft", "partial-volume"):
        assert figures[form][method].volume.value == pytest.approx(
            figures["dicom"][method].volume.value, rel=1e-6
        )
    assert figures[form]["loft"].area.value == pytest.approx(figures["dicom"]["loft"].area.value, rel=1e-6)


def test_tilt_and_direction_leave_the_figures_alone(figures):
    body = phantoms.make(**BODY)
    for form in ("dicom", "tilted"):
        assert figures[form]["partial-volume"].volume.value == pytest.approx(body.volume, rel=1e-4)
    straight, tilted = figures["dicom"]["loft"], figures["tilted"]["loft"]
    assert tilted.volume.value == pytest.approx(straight.volume.value, rel=2e-3)
    assert tilted.area.value == pytest.approx(straight.area.value, rel=2e-3)


def image(tmp_path, suffix, values, spacing=(0.5, 0.75, 2.0), **write):
    path = tmp_path / f"volume{suffix}"
    picture = SimpleITK.GetImageFromArray(values)
    picture.SetSpacing(spacing)
    SimpleITK.WriteImage(picture, str(path), **write)
    return path


VALUES = np.random.default_rng(5).integers(0, 500, (4, 10, 12)).astype(np.int16)


@pytest.mark.parametrize("suffix", [".mhd", ".mha", ".nrrd", ".nii", ".nii.gz"])
@pytest.mark.parametrize("packed", [False, True])
def test_itk_spacings_and_slices(tmp_path, suffix, packed):
    stack = ItkReader().read(image(tmp_path, suffix, VALUES, useCompression=packed))
    assert np.allclose(stack.pixel_spacing, [0.75, 0.5])
    assert np.allclose(np.diff(stack.positions), 2.0)
    assert all(np.array_equal(stack.decode(k), VALUES[k]) for k in (3, 0, 2))


def test_a_unit_that_an_nrrd_names_is_converted(tmp_path):
    path = image(tmp_path, ".nrrd", VALUES)
    head, body = path.read_bytes().split(b"\n\n", 1)
    path.write_bytes(head + b'\nspace units: "um" "um" "um"\n\n' + body)
    assert np.allclose(ItkReader().read(path).pixel_spacing, [0.75e-3, 0.5e-3])
    path.write_bytes(head + b'\nspace units: "px" "px" "px"\n\n' + body)
    with pytest.raises(InputError, match="unit of length"):
        ItkReader().read(path)


def test_labels_are_seen_or_said(tmp_path):
    labels = np.zeros((4, 20, 20), np.uint8)
    labels[:, 3:12, 3:12] = 2
    path = image(tmp_path, ".nrrd", labels)
    assert isinstance(ItkReader().read(path), Segmentation)
    assert not isinstance(ItkReader(labels="no").read(path), Segmentation)
    with pytest.raises(InputError, match="whole numbers"):
        ItkReader(labels="yes").read(image(tmp_path, ".mha", VALUES.astype(np.float32) + 0.5))


def test_ome_and_imagej_spacings(tmp_path):
    open_microscopy, imagej, bare = (tmp_path / name for name in ("a.ome.tif", "b.tif", "c.tif"))
    size = {"PhysicalSizeX": 57.5, "PhysicalSizeY": 0.0575, "PhysicalSizeZ": 115.0}
    units = {"PhysicalSizeXUnit": "µm", "PhysicalSizeYUnit": "mm", "PhysicalSizeZUnit": "µm"}
    tifffile.imwrite(
        open_microscopy, VALUES, photometric="minisblack", metadata={"axes": "ZYX", **size, **units}
    )
    tifffile.imwrite(
        imagej, VALUES.astype(np.uint16), imagej=True, resolution=(1 / 57.5, 1 / 57.5),
        metadata={"unit": "um", "spacing": 115.0, "axes": "ZYX"},
    )  # fmt: skip
    for path in (open_microscopy, imagej):
        stack = TiffReader().read(path)
        assert np.allclose(stack.pixel_spacing, 0.0575)
        assert np.allclose(np.diff(stack.positions), 0.115)
        assert np.array_equal(stack.decode(2), VALUES[2])
    tifffile.imwrite(bare, VALUES, photometric="minisblack", resolution=(72, 72), resolutionunit="INCH")
    with pytest.raises(InputError, match="pixel size is unknown"):
        TiffReader().read(bare)
    with pytest.raises(InputError, match="distance between the slices"):
        TiffReader(pixel_size="1mm").read(bare)
    assert len(TiffReader(pixel_size="1mm", thickness="2mm").read(bare)) == 4


def test_arrays(tmp_path):
    np.savez(tmp_path / "two.npz", a=VALUES, b=VALUES + 1, spacing=[2.0, 0.75, 0.5])
    stack = NumpyReader(array="b").read(tmp_path / "two.npz")
    assert np.allclose(stack.pixel_spacing, [0.75, 0.5])
    assert np.array_equal(stack.decode(1), VALUES[1] + 1)
    with pytest.raises(InputError, match=r"numpy\.array"):
        NumpyReader().read(tmp_path / "two.npz")
    np.save(tmp_path / "flat.npy", VALUES[0])
    with pytest.raises(InputError, match="no volume"):
        NumpyReader(pixel_size=1, thickness=1).read(tmp_path / "flat.npy")
