"""``object``: the largest body of a scan, one by label or rank, or all of them."""

import numpy as np
import pytest
import SimpleITK

import stackloft
from stackloft.model.errors import InputError, UsageError


@pytest.fixture
def pair(tmp_path):
    """Two balls of different sizes, as grey levels and as labels that touch."""
    z, y, x = np.mgrid[:20, :40, :70].astype(float)
    z *= 2
    small, large = (
        np.sqrt((z - 19) ** 2 + (y - 20) ** 2 + (x - c) ** 2) - r for c, r in ((16, 11), (46, 16))
    )
    grey = np.clip(0.5 - np.minimum(small, large), 0, 1) * 900
    labels = np.where(small < 0, 4, np.where(large < 0, 9, 0))
    for name, values in (("grey", grey.astype(np.int16)), ("labels", labels.astype(np.uint8))):
        image = SimpleITK.GetImageFromArray(values)
        image.SetSpacing((1.0, 1.0, 2.0))
        SimpleITK.WriteImage(image, str(tmp_path / f"{name}.nrrd"))
    return tmp_path


def volumes(result):
    return [body.volume.value for body in result.objects]


SIZES = {"small": 4 / 3 * np.pi * 11**3, "large": 4 / 3 * np.pi * 16**3}


def test_the_largest_is_measured_and_the_others_told(pair):
    result = stackloft.measure(pair / "grey.nrrd", "voxel")
    assert volumes(result) == [pytest.approx(SIZES["large"], rel=0.01)]
    assert "several-objects" in [notice.code for notice in result.warnings]


@pytest.mark.parametrize(("file", "names"), [("grey", ("1", "2")), ("labels", ("9", "4"))])
def test_one_by_its_name(pair, file, names):
    for name, size in zip(names, ("large", "small"), strict=True):
        result = stackloft.measure(pair / f"{file}.nrrd", "voxel", object=name)
        assert volumes(result) == [pytest.approx(SIZES[size], rel=0.04)]
    with pytest.raises((InputError, UsageError), match=f"{names[0]}: 1"):
        stackloft.measure(pair / f"{file}.nrrd", "voxel", object="17")


def test_all_in_one_result(pair):
    grey = stackloft.measure(pair / "grey.nrrd", "voxel", object="all")
    assert volumes(grey) == [pytest.approx(SIZES[size], rel=0.04) for size in ("large", "small")]
    assert [body.id for body in grey.objects] == [1, 2]
    assert "several-objects" not in [notice.code for notice in grey.warnings]
    labels = stackloft.measure(pair / "labels.nrrd", "voxel", object="all")
    assert volumes(labels) == [pytest.approx(SIZES[size], rel=0.04) for size in ("small", "large")]
    assert [body.label for body in labels.objects] == ["label 4", "label 9"]


@pytest.mark.parametrize("file", ["grey", "labels"])
def test_one_by_a_point_in_it(pair, file):
    source = pair / f"{file}.nrrd"
    for point, name in (("16,20,19", "small"), ("5.5cm,2.5cm,19mm", "large")):
        result = stackloft.measure(source, "voxel", object=f"seed:{point}")
        assert volumes(result) == [pytest.approx(SIZES[name], rel=0.04)]
    for nowhere in ("30,1,19", "16,20,400"):
        with pytest.raises(UsageError, match="no body is at that point"):
            stackloft.measure(source, "voxel", object=f"seed:{nowhere}")
    with pytest.raises(UsageError, match="a seed is a point in space"):
        stackloft.measure(source, "voxel", object="seed:30,1")


def test_a_point_is_in_patient_space_whatever_the_direction(pair):
    image = SimpleITK.ReadImage(str(pair / "grey.nrrd"))
    image.SetOrigin((100.0, -50.0, 7.0))
    image.SetDirection((0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0))
    SimpleITK.WriteImage(image, str(pair / "turned.nrrd"))
    for index, name in (((16, 20, 9), "small"), ((50, 24, 9), "large")):
        point = ",".join(str(x) for x in image.TransformIndexToPhysicalPoint(index))
        result = stackloft.measure(pair / "turned.nrrd", "voxel", object=f"seed:{point}")
        assert volumes(result) == [pytest.approx(SIZES[name], rel=0.04)]


def test_porosity_is_told_filled_or_kept(tmp_path):
    z, y, x = np.mgrid[:30, :40, :40].astype(float)
    ball = np.clip(0.5 + 14 - np.sqrt((z - 14.5) ** 2 + (y - 20) ** 2 + (x - 20) ** 2), 0, 1)
    void = np.clip(0.5 + 6 - np.sqrt((z - 14.5) ** 2 + (y - 20) ** 2 + (x - 22) ** 2), 0, 1)
    image = SimpleITK.GetImageFromArray((1000 * (ball - void)).astype(np.int16))
    SimpleITK.WriteImage(image, str(tmp_path / "porous.nrrd"))
    sizes = {"fill": 14**3, "keep": 14**3 - 6**3}
    for choice, code in (("fill", "voids-filled"), ("keep", "voids-kept")):
        result = stackloft.measure(tmp_path / "porous.nrrd", "partial-volume", voids=choice)
        assert volumes(result) == [pytest.approx(4 / 3 * np.pi * sizes[choice], rel=0.005)]
        (told,) = [notice.message for notice in result.warnings if notice.code == code]
        porosity = float(told.split("porosity ")[1].split(" %")[0])
        assert porosity == pytest.approx(100 * 6**3 / 14**3, abs=0.2)  # voxels are counted
