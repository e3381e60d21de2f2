"""The whole route on photographs of bodies of every topology: segment, trace, link, loft, integrate."""

from __future__ import annotations

import pytest

import stackloft
from stackloft.testing import phantoms

VOLUME, AREA = 0.5, 1.0
SECTIONS = 21
POSES = {label: phantom for kind in phantoms.TOPOLOGY for label, phantom in kind.phantoms()}


def errors(phantom, folder, pixel_size=0.3):
    """Errors of V and S in percent, signed, the ends told as on exact contours."""
    placing = "faces" if any(phantom.plane_ends) else "mid"
    phantoms.write_photos(phantom, folder, pixel_size=pixel_size, sections=SECTIONS, placing=placing)
    body = stackloft.measure(folder, "loft", ends=",".join(phantom.end_kinds)).objects[0]
    return 100 * (body.volume.value / phantom.volume - 1), 100 * (body.area.value / phantom.area - 1)


@pytest.mark.parametrize("label", ["torus leaning", "tube lying", "y-branch leaning"])
def test_photographs_of_every_topology(tmp_path, label):
    volume, area = errors(POSES[label], tmp_path)
    assert abs(volume) <= VOLUME
    assert abs(area) <= AREA


@pytest.mark.prove
def test_photographs_of_all_bodies_in_all_poses(tmp_path, proof):
    rows = {label: errors(phantom, tmp_path / label) for label, phantom in POSES.items()}
    proof(
        "loft-topology-photographs",
        "The loft on bodies of every topology: photographs of 0.3 mm pixels, 21 sections, 33 points",
        ("body", "V %", "S %"),
        [(label, f"{v:+.3f}", f"{a:+.3f}") for label, (v, a) in rows.items()],
    )
    for label, (volume, area) in rows.items():
        assert abs(volume) <= VOLUME, label
        assert abs(area) <= AREA, label
