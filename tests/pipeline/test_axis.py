"""``--axis``: sections across any axis of the array give the same body, whatever its place in space."""

import numpy as np
import pytest

import stackloft
from stackloft.model.errors import InputError, UsageError
from stackloft.sectioning.array_axis import along_axis
from stackloft.testing.phantoms import write_phantom
from stackloft.testing.phantoms.writing import write_photos


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """An odd ellipsoid in an odd place, nearly isotropic; straight and tilted."""
    folder = tmp_path_factory.mktemp("axis")
    made = {"a": 21, "b": 15, "c": 26}
    for name, options in {
        "straight": {"form": "dicom"},
        "turned": {"form": "dicom", "cosines": 5, "origin": (50.0, -9.0, 210.0)},
        "tilted": {"form": "dicom", "tilt": 14.0, "cosines": 2},
        "labels": {"form": "nrrd", "label": 3, "cosines": 5},
        "segment": {"form": "dicom-seg", "cosines": 5},
    }.items():
        form = options.pop("form")
        write_phantom(
            "ellipsoid", form, folder / name, parameters=made, rotation=3, sections=24, pixel_size=1.6,
            slab_points=3, stretch=1.2, empty=2, **options,
        )  # fmt: skip
    return folder


def source(scans, name):
    return scans / name / "scan.nrrd" if name == "labels" else scans / name


def figures(path, axis, method):
    body = stackloft.measure(path, method, axis=axis).objects[0]
    return body.volume.value, body.area.value if body.area else None


@pytest.mark.parametrize(
    ("name", "axes"),
    [("straight", "12"), ("turned", "12"), ("tilted", "1"), ("labels", "12"), ("segment", "12")],
)
def test_voxels_are_the_same_along_every_axis(scans, name, axes):
    expected, _ = figures(source(scans, name), "0", "voxel")
    for axis in axes:
        assert figures(source(scans, name), axis, "voxel")[0] == pytest.approx(
            expected, rel=2e-3
        )  # end sections of few pixels


@pytest.mark.parametrize(("name", "axes"), [("turned", "12"), ("tilted", "1")])
def test_the_loft_is_the_same_body_along_every_axis(scans, name, axes):
    exact = 4 / 3 * np.pi * 21 * 15 * 26
    straight = figures(source(scans, name), "0", "loft")
    assert straight[0] == pytest.approx(exact, rel=5e-3)
    for axis in axes:
        volume, area = figures(source(scans, name), axis, "loft")
        assert volume == pytest.approx(exact, rel=5e-3)
        assert area == pytest.approx(straight[1], rel=5e-3)


@pytest.mark.parametrize("name", ["turned", "tilted"])
def test_every_voxel_stays_where_it_is_in_space(scans, name):
    stack = stackloft.read(scans / name)
    rng = np.random.default_rng(1)
    for axis in (1, 2) if name == "turned" else (1,):
        turned = along_axis(stack, axis)
        assert np.linalg.det(turned.affine[:3, :3]) == pytest.approx(1.0)
        for _ in range(20):
            k, row, column = (int(rng.integers(side)) for side in (len(turned), *turned.shape))
            y, x = np.array([row, column]) * turned.pixel_spacing[k]
            place = turned.affine @ [x, y, turned.positions[k], 1.0]
            old = np.linalg.solve(stack.affine, place)[:3]
            index = old / [*stack.pixel_spacing[0, ::-1], 1.0]
            number = int(np.argmin(np.abs(stack.positions - index[2])))
            assert abs(stack.positions[number] - index[2]) < 1e-3
            assert np.allclose(index[:2], np.round(index[:2]), atol=1e-3)
            assert stack.decode(number)[round(index[1]), round(index[0])] == turned.decode(k)[row, column]


@pytest.mark.parametrize(("rotation", "axis"), [((0, 0, 0), 0), ((90, 0, 0), 1), ((0, 90, 0), 2)])
def test_auto_cuts_a_rod_across_its_length(tmp_path, rotation, axis):
    rod = {"radius": 7.3, "height": 50}
    options = {"sections": 20 if axis == 0 else 10, "pixel_size": 1.5, "slab_points": 2, "rotation": rotation}
    write_phantom("cylinder", "nrrd", tmp_path, parameters=rod, **options)
    found = stackloft.measure(tmp_path / "scan.nrrd", "voxel", axis="auto")
    told = next(each.message for each in found.warnings if each.code == "axis-chosen")
    assert f"axis {axis} was chosen" in told
    assert found.objects[0].volume.value == pytest.approx(np.pi * 7.3**2 * 50, rel=0.06)


def test_auto_prefers_filled_sections(tmp_path):
    """A ring lying flat: cut across its axis every section has a hole; cut upright, one or two pieces."""
    z, y, x = np.mgrid[:14, :50, :50].astype(float)
    tube = np.hypot(np.hypot(x - 24.5, y - 24.5) - 16, z - 6.5)
    np.savez(
        tmp_path / "ring.npz", np.where(tube < 5, 900.0, 0.0).astype(np.float32), spacing=[1.0, 1.0, 1.0]
    )
    found = stackloft.measure(tmp_path / "ring.npz", "voxel", axis="auto")
    told = next(each.message for each in found.warnings if each.code == "axis-chosen")
    assert "0: 0 % of sections filled" in told
    assert "axis 1 was chosen" in told


def test_what_another_axis_cannot_do_is_refused(scans, tmp_path):
    with pytest.raises(InputError, match=r"need the whole scan in memory.*found: 0\.\d* MB|found: 0 MB"):
        stackloft.measure(scans / "straight", axis="1", memory=0.01)
    with pytest.raises(InputError, match=r"sheared along this axis.*use --axis 0 or 1"):
        stackloft.measure(scans / "tilted", axis="2")
    write_phantom("cone", "dicom", tmp_path / "uneven", positions=(1, 2, 4, 8, 11, 12), pixel_size=2.0)
    with pytest.raises(InputError, match="unequal distances"):
        stackloft.measure(tmp_path / "uneven", axis="1", settings={"reader": {"allow_gaps": True}})
    _photos(tmp_path / "photos")
    with pytest.raises(UsageError, match="photographs have one axis"):
        stackloft.measure(tmp_path / "photos", axis="1")


def _photos(folder):
    from stackloft.testing import phantoms  # noqa: PLC0415

    write_photos(phantoms.make("cone"), folder, sections=3, pixel_size=2.0)
