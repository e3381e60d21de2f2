"""Names, birth dates, identifiers and free text reach no output, message or file."""

import json
import subprocess
import sys

import numpy as np
import pytest

from stackloft_plugins.readers.dicom import DicomReader

SECRETS = ("Grey", "PH-2007", "20070101", "disc slabs", "Doctor", "1.2.826.0.1")


@pytest.fixture
def told(series, edit):
    for path in series.iterdir():
        edit(path, ReferringPhysicianName="Doctor^Who", PatientComments="Grey, born 20070101")
    return series


def test_nothing_private_is_in_the_stack(told):
    stack = DicomReader().read(told)
    text = repr((stack.names, stack.notices, dict(stack.provenance), stack.hints))
    assert not [secret for secret in SECRETS if secret in text]


def test_identifiers_are_kept_where_that_is_asked_for(told):
    stack = DicomReader(keep_identifiers=True).read(told)
    assert stack.provenance["PatientID"] == "PH-2007"
    assert stack.provenance["PatientName"] == "Phantom^Grey"


def test_a_private_value_that_is_wrong_is_not_quoted(told):
    path = told / "IM0003"
    spoilt = (
        path.read_bytes()
        .replace(b"DA\x08\x0020070101", b"DA\x08\x00Greyer!!")
        .replace(b"IS\x02\x006 ", b"IS\x02\x00G ")
    )
    assert spoilt != path.read_bytes()
    path.write_bytes(spoilt)
    run = subprocess.run(
        [sys.executable, "-m", "stackloft.cli", "info", told, "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert not [secret for secret in SECRETS if secret in run.stdout + run.stderr]


def test_info_tells_geometry_and_no_person(told):
    command = [sys.executable, "-W", "default", "-m", "stackloft.cli", "info", str(told)]
    for extra in ([], ["--json"]):
        run = subprocess.run([*command, *extra], capture_output=True, text=True, check=True)
        assert not [secret for secret in SECRETS if secret in run.stdout + run.stderr]
    facts = json.loads(run.stdout)
    assert facts["reader"] == "dicom"
    assert facts["slices"] == 8
    assert np.allclose(np.array(facts["affine"])[:3, 0], [0, 1, 0])
    assert facts["thickness"] == [2.5, 2.5]
    assert np.allclose(facts["pitch"], 2.5)
    assert facts["provenance"]["positions"].startswith("Image Position")
