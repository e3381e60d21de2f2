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
