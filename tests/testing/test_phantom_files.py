"""Pictures carry exact coverage; files are whole, named and told as asked."""

import csv
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from stackloft.model.errors import OutputError, UsageError
from stackloft.testing import phantoms
from stackloft.testing.phantoms import samples
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.photographs import LEVELS
from stackloft.testing.phantoms.samples import SAMPLES


def shoelace(p):
    x, y = p.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def clipped_area(polygon, column, row):
    """Sutherland–Hodgman against one pixel, then the shoelace: a slow second route."""
    for axis, bound, sign in ((0, column, 1), (0, column + 1, -1), (1, row, 1), (1, row + 1, -1)):
        kept = []
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            da, db = sign * (a[axis] - bound), sign * (b[axis] - bound)
            if da >= 0:
                kept.append(a)
            if da * db < 0:
                kept.append(a + (b - a) * da / (da - db))
        polygon = np.array(kept)
        if len(polygon) < 3:
            return 0.0
    return shoelace(polygon)


@given(seed=st.integers(0, 10**6), k=st.integers(3, 9))
@settings(max_examples=40, deadline=None)
def test_coverage_equals_clipping_pixel_by_pixel(seed, k):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, k))
    polygon = np.array([4.0, 3.0]) + rng.uniform(0.5, 2.9) * np.column_stack([np.cos(angle), np.sin(angle)])
    found = coverage([polygon], (6, 8))
    expected = [[clipped_area(polygon, j, i) for j in range(8)] for i in range(6)]
    assert np.abs(found - expected).max() < 1e-12


def test_coverage_sums_to_the_area_and_holes_count_against_it():
    t = 2 * np.pi * np.arange(500) / 500
    ring = np.column_stack([np.cos(t), np.sin(t)])
    outer, hole = 20.3 + 15.7 * ring, (20.3 + 6.1 * ring)[::-1]
    total = coverage([outer, hole], (41, 41)).sum()
    assert total == pytest.approx(shoelace(outer) + shoelace(hole), rel=1e-13)


def test_vertices_on_pixel_corners_and_edges_along_pixel_sides():
    square = np.array([[1.0, 1.0], [3.0, 1.0], [3.0, 4.0], [1.0, 4.0]])
    expected = np.zeros((5, 4))
    expected[1:4, 1:3] = 1
    assert (coverage([square], (5, 4)) == expected).all()


def test_what_leaves_the_picture_is_cut_off():
    square = np.array([[-5.0, -2.0], [2.5, -2.0], [2.5, 9.0], [-5.0, 9.0]])
    assert coverage([square], (3, 4)).tolist() == [[1.0, 1.0, 0.5, 0.0]] * 3


@pytest.mark.parametrize(
    ("plate", "bits", "tolerance"), [("white", 8, 2e-3), ("black", 8, 2e-3), ("black", 16, 1e-5)]
)
def test_noise_free_grey_levels_sum_to_the_section_areas(tmp_path, plate, bits, tolerance):
    phantom = phantoms.make("potato", rotation=2, offset=(3.3, -8.1, 40.0))
    files = phantoms.write_photos(phantom, tmp_path, sections=4, plate=plate, bits=bits, pixel_size=0.4)
    ground, body = (level * (257 if bits == 16 else 1) for level in LEVELS[plate])
    for file, z in zip(files, phantom.positions(4), strict=False):
        grey = np.asarray(Image.open(file), dtype=float)
        area = ((grey - ground) / (body - ground)).sum() * 0.4**2
        assert area == pytest.approx(phantom.section(z, 3000)[0].signed_area, rel=tolerance)


def test_turn_and_mirror_keep_the_areas(tmp_path):
    phantom = phantoms.make("meat")
    sums = []
    for i, options in enumerate(({}, {"turn": 33.0}, {"mirror": True}, {"turn": 90.0, "mirror": True})):
        common = {"sections": 2, "pixel_size": 0.5, "plate": "black", "bits": 16}
        files = phantoms.write_photos(phantom, tmp_path / str(i), **common, **options)
        sums.append(np.asarray(Image.open(files[0]), dtype=float) - LEVELS["black"][0] * 257)
    totals = [s.sum() for s in sums]
    assert totals == pytest.approx([totals[0]] * 4, rel=1e-4)
    assert sums[0].shape == sums[2].shape != sums[1].shape


def test_mirroring_mirrors(tmp_path):
    """The centroid's distances from the left in the two pictures add up to the width, to a pixel."""
    phantom = phantoms.make("meat")
    centroids = []
    for mirror in (False, True):
        file = phantoms.write_photos(
            phantom, tmp_path / f"{mirror}", sections=2, pixel_size=0.5, mirror=mirror
        )[1]
        body = LEVELS["white"][0] - np.asarray(Image.open(file), dtype=float)
        rows, columns = np.indices(body.shape)
        centroids.append(np.array([(columns * body).sum(), (rows * body).sum()]) / body.sum())
        width = body.shape[1]
    assert abs(centroids[0][0] + centroids[1][0] - (width - 1)) < 1
    assert abs(centroids[0][0] - centroids[1][0]) > 4
    assert abs(centroids[0][1] - centroids[1][1]) < 0.01


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "bmp", "webp"])
@pytest.mark.parametrize("realistic", [False, True])
def test_every_format_reads_back(tmp_path, suffix, realistic):
    files = phantoms.write_phantom("apple", "photos", tmp_path, sections=2, pixel_size=0.8, suffix=suffix,
                                   realistic=realistic)  # fmt: skip
    pictures = [np.asarray(Image.open(file).convert("L")) for file in files[:2]]
    assert pictures[0].shape == pictures[1].shape
    assert np.ptp(pictures[0].astype(int)) > 100


def test_realism_is_seeded_and_leaves_the_edge_where_it_is(tmp_path):
    first, again, other = (
        phantoms.write_phantom(
            "meat", "photos", tmp_path / name, sections=3, pixel_size=0.4, realistic=True, seed=seed
        )
        for name, seed in (("a", 1), ("b", 1), ("c", 2))
    )
    assert first[0].read_bytes() == again[0].read_bytes() != other[0].read_bytes()
    grey = np.asarray(Image.open(first[1]).convert("L"), dtype=float)
    plate, flesh = np.median(grey[:8]), np.median(grey[grey < 120])
    area = (grey < (plate + flesh) / 2).sum() * 0.4**2
    z = json.loads(first[-1].read_text())["positions"][1]
    assert area == pytest.approx(phantoms.make("meat").section(z, 1000)[0].signed_area, rel=6e-3)


def test_answer_and_stack_toml(tmp_path):
    files = phantoms.write_phantom(
        "meat", "photos", tmp_path, sections=11, placing="faces", pixel_size=1.0,
        rotation=(0, 0, 20), offset=(1, 2, 3),
        tell=("kind", "pixel_size", "thickness", "ends", "height", "background", "specimen"),
    )  # fmt: skip
    said = tomllib.loads((tmp_path / "stack.toml").read_text())
    assert said == {
        "kind": "face", "pixel_size": "1.0mm", "thickness": "16mm", "ends": "face,round", "height": "176mm",
        "background": "light", "specimen": "meat",
    }  # fmt: skip
    known = json.loads(files[-1].read_text())
    assert known["volume"]["value"] == phantoms.make("meat").volume
    assert known["positions"] == pytest.approx([3.0 + 16 * i for i in range(11)])


def test_positions_and_end_lengths_can_be_told(tmp_path):
    phantoms.write_phantom("cone", "photos", tmp_path, placing=(-39.0, 0.0, 30.0), pixel_size=2.0,
                           tell=["positions", "end_lengths"])  # fmt: skip
    said = tomllib.loads((tmp_path / "stack.toml").read_text())
    assert said == {"positions": "0,39,69mm", "ends": "flat:1mm,point:10mm"}


def test_contours_read_back_to_the_bit(tmp_path):
    phantom = phantoms.make("cylinder", rotation=4)
    stack = phantom.contour_stack(3, points=50)
    (file,) = phantoms.write_contours(phantom, tmp_path / "c.csv", sections=3, points=50)
    rows = list(csv.DictReader(line for line in file.read_text().splitlines() if not line.startswith("#")))
    for i, section in enumerate(stack.sections, start=1):
        own = [row for row in rows if row["section"] == str(i)]
        assert [[float(row["x"]), float(row["y"])] for row in own] == section.loops[0].points.tolist()
        assert [k for k, row in enumerate(own) if row["corner"] == "1"] == section.loops[0].corners.tolist()
        assert {float(row["z"]) for row in own} == {section.z}


def test_shuffled_contours_hold_the_same_loops(tmp_path):
    phantom = phantoms.make("twisted-bar")
    tables = []
    for shuffle in (None, 5):
        (file,) = phantoms.write_contours(
            phantom, tmp_path / f"{shuffle}.csv", sections=3, points=40, shuffle=shuffle
        )
        lines = [line for line in file.read_text().splitlines() if line[0].isdigit()]
        tables.append(lines)
    assert tables[0] != tables[1]
    assert sorted(tables[0]) == sorted(tables[1])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"form": "dicomm"}, "unknown form"),
        ({"suffix": "gif"}, "unknown picture format"),
        ({"plate": "red"}, "unknown plate"),
        ({"bits": 16, "suffix": "jpg"}, "16 bits"),
        ({"tell": ("weight",)}, "unknown key"),
        ({"placing": (-30.0, 0.0, 1.0)}, "not equally spaced"),
        ({"pixel_size": -1.0}, "positive"),
        ({"pixel_size": 1e-4}, "impossible size"),
        ({"piksel_size": 1.0}, "did you mean pixel_size"),
        ({"form": "contours", "realistic": True}, "no realism"),
        ({"form": "contours", "tell": ("pixel_size",)}, "no pixel size"),
    ],
)
def test_wrong_options_are_refused_before_anything_is_written(tmp_path, options, message):
    with pytest.raises(UsageError, match=message):
        phantoms.write_phantom("ellipsoid", **({"form": "photos", "folder": tmp_path / "out"} | options))
    assert not (tmp_path / "out").exists()


def test_a_file_in_the_way_is_named(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(OutputError, match=r"out: is a file"):
        phantoms.write_phantom("box", "contours", tmp_path / "out")


def test_a_failing_disk_leaves_no_half_file(tmp_path, monkeypatch):
    def full(self, content):
        self.touch()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OutputError, match="no space left"):
        phantoms.write_phantom("box", "contours", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_samples_are_small_and_carry_the_exact_answer():
    for name, options in SAMPLES.items():
        folder = Path(__file__).parents[2] / "sample_stacks" / name
        assert sum(file.stat().st_size for file in folder.iterdir()) < 2_000_000
        assert len(list(folder.glob("slice_*.jpg"))) == options["sections"]
        known = json.loads((folder / "answer.json").read_text())
        phantom = phantoms.make(name, rotation=options["rotation"], **options["parameters"])
        assert known["volume"]["value"] == pytest.approx(phantom.volume, rel=1e-9)
        assert known["area"]["value"] == pytest.approx(phantom.area, rel=1e-9)
        assert known["height"] == pytest.approx(phantom.height, rel=1e-9)


def test_samples_can_be_made_anew(tmp_path, monkeypatch):
    coarse = {name: {**options, "pixel_size": 1.5} for name, options in SAMPLES.items()}
    monkeypatch.setattr(samples, "SAMPLES", coarse)
    samples.main([str(tmp_path)])
    assert sorted(folder.name for folder in tmp_path.iterdir()) == ["apple", "meat"]
    with pytest.raises(UsageError, match="one folder"):
        samples.main([])
