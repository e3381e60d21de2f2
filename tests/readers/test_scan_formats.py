"""One phantom in every format gives the same figures; tilt and orientation change them hardly at all."""

import json
from dataclasses import replace

import numpy as np
import pytest

import stackloft
from stackloft.testing import phantoms
from stackloft.testing.phantoms import write_phantom
from stackloft.testing.phantoms.scans import WRITERS

SCANS = {
    "dicom": {},
    "dicom, implicit": {"syntax": "implicit"},
    "dicom, big endian": {"syntax": "big-endian"},
    "dicom, deflated": {"syntax": "deflated"},
    "dicom, RLE": {"syntax": "rle"},
    "dicom, JPEG-LS": {"syntax": "jpeg-ls"},
    "dicom, JPEG 2000": {"syntax": "jpeg-2000"},
    "dicom, enhanced": {"multiframe": True},
    "nrrd": {},
    "nifti": {},
    "tiff": {},
    "bruker": {},
}
LABELS = {"nrrd": {}, "nifti": {}, "tiff": {}, "dicom-seg": {}}
FILES = {"nrrd": "scan.nrrd", "nifti": "scan.nii.gz", "tiff": "scan.tif"}
SLABS = {"sections": 14, "pixel_size": 1.4, "cosines": 3, "origin": (12.5, -80.0, 33.3)}


def figures(folder, name, body="potato", **options):
    """Volume and area of a phantom written in one form, as the loft measures it."""
    form = name.split(",")[0]
    write_phantom(body, form, folder, **options)
    source = folder / FILES[form] if form in FILES else folder
    found = stackloft.measure(source).objects[0]
    known = json.loads((folder / "answer.json").read_text())
    return np.array([found.volume.value, found.area.value]), np.array(
        [known["volume"]["value"], known["area"]["value"]]
    )


def table(tmp_path, forms, **options):
    """Rows of (form, volume, area, difference from the first) and the greatest difference."""
    first, rows, worst = None, [], 0.0
    for name, more in forms.items():
        own = {
            key: value
            for key, value in options.items()
            if not (name == "tiff" and key in {"cosines", "origin"})
        }
        found, _ = figures(tmp_path / name.replace(",", "").replace(" ", "_"), name, **own, **more)
        first = found if first is None else first
        off = np.abs(found / first - 1)
        worst = max(worst, float(off.max()))
        rows.append((name, f"{found[0]:.4f}", f"{found[1]:.4f}", f"{off[0]:.1e}", f"{off[1]:.1e}"))
    return rows, worst


def test_grey_slabs_measure_the_same_in_these_formats(tmp_path):
    scanner = phantoms.Scans(sections=8, pixel_size=2.5, cosines=3, origin=(12.5, -80.0, 33.3), slab_points=2)
    volume = scanner.volume(phantoms.make("potato"))
    first = None
    for name in ("dicom", "dicom, RLE", "nrrd", "nifti", "tiff", "bruker"):
        form = name.split(",")[0]
        folder = tmp_path / name
        folder.mkdir()
        WRITERS[form](replace(volume, **SCANS[name]), folder)
        found = stackloft.measure(folder / FILES[form] if form in FILES else folder).objects[0]
        got = np.array([found.volume.value, found.area.value])
        first = got if first is None else first
        assert np.abs(got / first - 1).max() < 1e-6, name


def test_contours_measure_the_same_as_a_table_and_as_a_structure_set(tmp_path):
    first, _ = figures(tmp_path / "csv", "contours", sections=9)
    other, _ = figures(tmp_path / "rs", "rtstruct", sections=9, cosines=3, origin=(1, 2, 3))
    assert np.abs(other / first - 1).max() < 1e-6


@pytest.mark.prove
def test_one_phantom_in_every_format(tmp_path, proof):
    scans, worst = table(tmp_path / "grey", SCANS, **SLABS)
    labels, worst_label = table(tmp_path / "label", LABELS, **SLABS, label=1)
    first, _ = figures(tmp_path / "csv", "contours", sections=11)
    curves = [("contours", f"{first[0]:.4f}", f"{first[1]:.4f}", "0.0e+00", "0.0e+00")]
    worst_curve = 0.0
    for seed in (None, 1, 2):
        other, _ = figures(
            tmp_path / f"rs{seed}", "rtstruct", sections=11, cosines=seed, origin=(40, -7, 300)
        )
        off = np.abs(other / first - 1)
        worst_curve = max(worst_curve, float(off.max()))
        turned = "axial" if seed is None else f"turned, seed {seed}"
        curves.append(
            (f"rtstruct, {turned}", f"{other[0]:.4f}", f"{other[1]:.4f}", f"{off[0]:.1e}", f"{off[1]:.1e}")
        )
    kinds = [("grey slabs", row) for row in scans] + [("label map", row) for row in labels]
    kinds += [("curves", row) for row in curves]
    proof(
        "scan-formats",
        "A potato in every format: its figures by the loft, how far they are from the first of their kind",
        ("what", "format", "volume, mm³", "area, mm²", "volume differs by", "area differs by"),
        [(kind, *row) for kind, row in kinds],
    )
    assert max(worst, worst_label, worst_curve) < 1e-6


def turned(tmp_path, tilts, seeds, **options):
    """Rows of (tilt, orientation, errors, changes against the straight scan) and the greatest change."""
    straight, exact = figures(tmp_path / "straight", "dicom", **options)
    rows, worst = [], 0.0
    for tilt in tilts:
        for seed in seeds:
            found, _ = figures(tmp_path / f"{tilt}_{seed}", "dicom", tilt=tilt, cosines=seed, **options)
            change, error = 100 * (found / straight - 1), 100 * (found / exact - 1)
            worst = max(worst, float(np.abs(change).max()))
            where = "axial" if seed is None else f"seed {seed}"
            rows.append((f"{tilt:g}°", where, *(f"{value:+.3f} %" for value in (*error, *change))))
    return rows, worst


def test_tilt_and_orientation_change_little(tmp_path):
    options = {"body": "ellipsoid", "sections": 10, "pixel_size": 2.5, "slab_points": 2}
    _, worst = turned(tmp_path, (20,), (4,), **options)
    assert worst < 0.2


@pytest.mark.prove
def test_any_tilt_and_orientation_change_less_than_a_fifth_of_a_per_cent(tmp_path, proof):
    rows, worst = turned(
        tmp_path, (-20, -15, -10, -5, 5, 10, 15, 20), (None, 1, 2), sections=16, pixel_size=1.0
    )
    proof(
        "scan-tilt",
        "A potato's grey slabs, tilted and turned: errors, and changes against the straight scan",
        ("tilt", "orientation", "V error", "S error", "V change", "S change"),
        rows,
    )
    assert worst < 0.2
