"""``--scale-uncertainty`` reaches every reader of scans, the sections and the notices."""

import json
import subprocess
import sys

import pytest

import stackloft
from stackloft.testing.phantoms import write_phantom

FORMS = {"dicom": "", "dicom-seg": "", "bruker": "", "rtstruct": "", "nrrd": "scan.nrrd", "tiff": "scan.tif"}


@pytest.fixture(scope="module")
def cones(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cones")
    for form in FORMS:
        more = {} if form == "rtstruct" else {"pixel_size": 3.0, "slab_points": 1, "sections": 6}
        write_phantom("cone", form, folder / form, **more)
    return folder


@pytest.mark.parametrize("form", FORMS)
def test_every_scan_takes_it(cones, form):
    source = cones / form / FORMS[form]
    method = "frustum" if form == "rtstruct" else "voxel"
    plain, told = (stackloft.measure(source, method, **more) for more in ({}, {"scale_uncertainty": "0.2%"}))
    assert told.objects[0].volume.value == plain.objects[0].volume.value
    (message,) = [notice.message for notice in told.warnings if notice.code == "scale-uncertainty"]
    assert message == "the voxel size is known to 0.2 %: volume to 0.6 %, area to 0.4 % by that alone"
    assert "scale-uncertainty" not in [notice.code for notice in plain.warnings]


def test_stack_toml_tells_it_and_the_flag_wins(cones, tmp_path):
    write_phantom("cone", "nrrd", tmp_path, pixel_size=3.0, slab_points=1, sections=6)
    (tmp_path / "stack.toml").write_text('scale_uncertainty = "0.5%"\n')
    stack = stackloft.read(tmp_path / "scan.nrrd")
    assert stack.scale_uncertainty.common == pytest.approx(0.005)
    assert stack.scale_uncertainty.isotropic
    assert stackloft.read(tmp_path / "scan.nrrd", scale_uncertainty=0.1).scale_uncertainty.common == 0.001


def test_identifiers_are_written_on_request_alone(cones):
    for form in ("dicom", "dicom-seg", "rtstruct"):
        command = [sys.executable, "-m", "stackloft.cli", "info", str(cones / form), "--json"]
        plain, kept = (
            subprocess.run([*command, *more], capture_output=True, text=True, check=True)
            for more in ([], ["--keep-identifiers"])
        )
        assert not [word for word in ("Grey", "PH-2007", "20070101") if word in plain.stdout + plain.stderr]
        assert json.loads(kept.stdout)["provenance"]["PatientName"] == "Phantom^Grey"
