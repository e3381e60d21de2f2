"""Rings, holes, cavities, limbs and pieces: their figures, sections and Euler characteristics agree.

Independent of the bodies' patches, both figures follow from sections along three axes: V = ∫A dz, and with n
the outward normal and ds along a section's loops, ∮√(1 − n_z²) ds dz is ∫(1 − n_z²) dS; over three axes that
is 2S.
"""

import csv
import json

import numpy as np
import pytest
from skimage.measure import euler_number

from stackloft.geometry.polygon_distance import inside_grid
from stackloft.model.errors import UsageError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.body import deciding
from stackloft.testing.phantoms.nesting import contains
from stackloft.testing.phantoms.quadrature import figures

NAMES = sorted(set(phantoms.NAMES) - set(phantoms.SOLID))
BODIES = {
    f"{case.name} {' '.join(case.poses)}": phantoms.make(case.name, **case.body) for case in phantoms.TOPOLOGY
}
POSES = {label: (case, phantom) for case in phantoms.TOPOLOGY for label, phantom in case.phantoms()}
QUICK = ["torus leaning", "tube leaning", "blind-hole leaning", "hollow-sphere in pose 1", "y-branch upright"]
QUICK += ["apple square to its core", "two-bodies as made", "ring-branch leaning", "horseshoe upright"]
AXES = [None, (90, 0, 0), (0, 90, 0)]


def slopes(phantom, bench):
    """Value, unit outward normal and slope of the field that decides at bench points (3, n)."""
    own = phantom.rotation.T @ (bench - phantom.offset[:, None])
    fields, step = phantom.body.fields, 1e-6
    values = np.array([field(own) for field in fields])
    each = [
        [(f(own + step * e[:, None]) - f(own - step * e[:, None])) / (2 * step) for e in np.eye(3)]
        for f in fields
    ]
    gradients = np.array(each)
    lengths = np.linalg.norm(gradients, axis=1)
    pick, n = deciding(values / lengths, phantom.body.parts), np.arange(bench.shape[1])
    return (
        values[pick, n],
        phantom.rotation @ (gradients[pick, :, n] / lengths[pick, n, None]).T,
        lengths[pick, n],
    )


def integrated(phantom, sections):
    """Volume and ∫(1 − n_z²) dS of the sections by the midpoint rule."""
    volume = area = 0.0
    for z in phantom.positions(sections):
        for loop in phantom.section(float(z), 300):
            following = np.roll(loop.points, -1, axis=0)
            middle = np.column_stack([(loop.points + following) / 2, np.full(len(following), z)]).T
            normal = slopes(phantom, middle)[1]
            volume += loop.signed_area
            area += np.linalg.norm(following - loop.points, axis=1) @ np.sqrt(
                np.clip(1 - normal[2] ** 2, 0, 1)
            )
    return np.array([volume, area]) * phantom.height / sections


def figures_by_sections(phantom, sections):
    along = np.array([integrated(phantom.posed(axis), sections) for axis in AXES])
    return along[:, 0], along[:, 1].sum() / 2


@pytest.mark.parametrize("name", NAMES)
def test_closed_form_figures_are_the_integrals_of_the_patches(name):
    body = phantoms.make(name).body
    assert figures(body.patches) == pytest.approx((body.volume, body.area), rel=1e-11)


@pytest.mark.parametrize("label", ["ring-branch leaning", "y-branch leaning"])
def test_figures_by_sections_along_three_axes(label):
    phantom = POSES[label][1]
    volumes, area = figures_by_sections(phantom, 24)
    assert volumes.mean() == pytest.approx(phantom.volume, rel=4e-3)
    assert area == pytest.approx(phantom.area, rel=6e-3)


@pytest.mark.prove
def test_figures_by_sections_along_three_axes_of_all_bodies(proof):
    rows = []
    for label, phantom in BODIES.items():
        volumes, area = figures_by_sections(phantom.posed((11, 23, 37)), 80)
        rows.append([label, f"{100 * (volumes.mean() / phantom.volume - 1):+.4f}",
                     f"{100 * (area / phantom.area - 1):+.4f}"])  # fmt: skip
        assert volumes.mean() == pytest.approx(phantom.volume, rel=1e-3)
        assert area == pytest.approx(phantom.area, rel=3e-3)
    proof(
        "topology-phantoms",
        "Closed forms against 3 × 80 sections, midpoint rule",
        ["body", "V by sections %", "S by sections %"],
        rows,
    )


@pytest.mark.parametrize("label", QUICK)
def test_loops_lie_on_the_body_and_nest(label):
    phantom = POSES[label][1]
    for section in phantom.contour_stack(7, points=120).sections:
        for i, loop in enumerate(section.loops):
            bench = np.column_stack([loop.points, np.full(len(loop.points), section.z)]).T
            value, _, slope = slopes(phantom, bench)
            assert np.abs(value / slope).max() < 1e-9
            others = [other for k, other in enumerate(section.loops) if k != i]
            depth = {sum(contains(other.points, point) for other in others) for point in loop.points[::7]}
            assert len(depth) == 1  # crosses nobody
            assert loop.hole == (depth.pop() % 2 == 1)
            assert (loop.signed_area < 0) == loop.hole


def euler_characteristic(phantom, steps):
    """Of the boundary, from sections filled on a grid: twice that of the solid."""
    z = phantom.positions(steps)
    cuts = [phantom.section(float(height), 200) for height in z]
    points = np.concatenate([loop.points for cut in cuts for loop in cut])
    pitch = float(z[1] - z[0])
    x, y = (np.arange(points[:, k].min() - pitch, points[:, k].max() + pitch, pitch) for k in (0, 1))
    filled = np.zeros((steps + 2, len(y), len(x)), dtype=bool)
    for i, cut in enumerate(cuts, start=1):
        start = np.concatenate([loop.points for loop in cut])
        end = np.concatenate([np.roll(loop.points, -1, axis=0) for loop in cut])
        filled[i] = inside_grid(x, y, start, end)
    return 2 * euler_number(filled, connectivity=1)


@pytest.mark.parametrize("label", ["torus leaning", "ring-branch leaning", "two-cavities in pose 2"])
def test_sections_have_the_bodys_euler_characteristic(label):
    case, phantom = POSES[label]
    assert euler_characteristic(phantom, 30) == case.euler


@pytest.mark.prove
@pytest.mark.parametrize("label", POSES)
def test_sections_of_every_pose_have_the_bodys_euler_characteristic(label):
    case, phantom = POSES[label]
    assert euler_characteristic(phantom, 90) == case.euler


def test_which_loops_a_section_has():
    torus = phantoms.make("torus")
    assert [loop.hole for loop in torus.section(3.0)] == [False, True]
    upright = torus.posed((90, 0, 0))
    assert [len(upright.section(z)) for z in (-35.0, 0.0, 35.0)] == [1, 2, 1]
    blind = phantoms.make("blind-hole")
    assert [len(blind.section(z)) for z in (-39.0, 0.0, 39.0)] == [1, 2, 2]
    assert [len(blind.section(z)) for z in blind.extent()] == [
        1,
        2,
    ]  # its faces: one whole, one with its hole
    assert len(blind.section(40.0 - 52.0)) == 1  # at the floor itself
    cavities = phantoms.make("two-cavities")
    assert max(len(cavities.section(z)) for z in np.linspace(-12, 12, 25)) == 3
    assert len(phantoms.make("y-branch").section(30.0)) == 2
    assert len(phantoms.make("coil", rotation=(90, 0, 0)).section(0.0)) == 5


def test_mirror_images_are_mirror_images():
    left, right = (phantoms.make("y-branch", mirror=mirror) for mirror in (0, 1))
    for z in (-30.0, 10.0, 30.0):
        a, b = (np.concatenate([loop.points for loop in body.section(z)]) for body in (left, right))
        assert a[:, 0].min() == pytest.approx(-b[:, 0].max(), abs=0.02)
        assert a[:, 0].max() == pytest.approx(-b[:, 0].min(), abs=0.02)


def test_holes_reach_the_csv_file(tmp_path):
    phantoms.write_phantom("tube", "contours", tmp_path, sections=4, points=60)
    rows = [line for line in (tmp_path / "contours.csv").read_text().splitlines() if not line.startswith("#")]
    assert {row["loop"] for row in csv.DictReader(rows)} == {"1", "2"}
    assert json.loads((tmp_path / "answer.json").read_text())["ends"] == ["face", "face"]


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("torus", {"radius": 31.0}),
        ("tube", {"offset": 20.0}),
        ("blind-hole", {"depth": 80.0}),
        ("hollow-sphere", {"offset": 16.0}),
        ("two-cavities", {"first": 20.0}),
        ("coil", {"pitch": 13.0}),
        ("ring-branch", {"limb": 11.0}),
        ("y-branch", {"left_angle": 10.0}),
        ("horseshoe", {"radius": 28.0}),
        ("two-bodies", {"gap": 1.0}),
    ],
)
def test_bodies_that_would_touch_themselves_are_refused(name, parameters):
    with pytest.raises(UsageError):
        phantoms.make(name, **parameters)
