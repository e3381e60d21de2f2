"""Every installed method on every body against stored bounds, and the orders that theory gives.

`python tests/accuracy/test_matrix.py > tests/accuracy/bounds.toml` renews the bounds from measured figures.
"""

import math
import os
import sys
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from stackloft.pipeline.plan import method_names
from stackloft.report.accuracy_files import write_accuracy, write_heat_map
from stackloft.report.whole_file import whole_file
from stackloft.studies.accuracy import AccuracyRequest, studied_methods, study_accuracy
from stackloft.studies.accuracy_axes import FULL, QUICK
from stackloft.studies.accuracy_bodies import BODIES
from stackloft.studies.accuracy_table import finest

BOUNDS = Path(__file__).with_name("bounds.toml")
SCANNED = ("ellipsoid, pose 1", "potato 1", "box")
"""Bodies that are also run along the axes that need scans."""

HEAD = """\
# The promise of every method on every body: |error| of volume and area in percent at the finest value of
# the axis (the quick levels of stackloft.studies.accuracy_axes). No figure: the method gives none there.
# Printed anew by `python tests/accuracy/test_matrix.py`: measured, 25 % added, rounded up to a round figure.
"""
PROOF = Path(__file__).parents[2] / "docs" / "proof"
FINER = replace(QUICK, sections=QUICK.sections[-1:])
"""On the axis that all bodies are run along, the finer value alone."""
BY_LABEL = {body.label: body for body in BODIES}


def axes_of(label):
    return ("sections", "points", "pixel", "pose") if label in SCANNED else ("sections",)


def study(body):
    return study_accuracy(AccuracyRequest((body,), axes_of(body.label), FINER))


def bounds():
    return tomllib.loads(BOUNDS.read_text(encoding="utf-8"))


@cache
def studied(label):
    return study(BY_LABEL[label])


@cache
def refined(label):
    """The two methods whose theory is exact, at both values."""
    return study_accuracy(AccuracyRequest((BY_LABEL[label],), ("sections",), QUICK, ("cavalieri", "frustum")))


def test_there_are_enough_bodies_and_each_has_its_bounds():
    assert len(BODIES) >= 20
    assert set(bounds()) == set(BY_LABEL)


@pytest.mark.parametrize("label", BY_LABEL)
def test_every_method_keeps_its_promise(label):
    found = {(row.axis, row.method): row for row in finest(studied(label).rows)}
    promised = {(axis, method) for axis in axes_of(label) for method in bounds()[label][axis]}
    assert {key for key, row in found.items() if row.failure is None} <= promised
    for axis in axes_of(label):
        for method, bound in bounds()[label][axis].items():
            row = found[axis, method]
            assert row.failure is None, f"{method}, {axis}: {row.failure}"
            for name, error in (("V", row.volume_error), ("S", row.area_error)):
                assert (error is None) == (name not in bound), f"{method}, {axis}: {name}"
                assert error is None or abs(error) <= bound[name], f"{method}, {axis}: {name} {error:+.4f} %"


def test_every_installed_method_is_in_every_case():
    rows = studied("box").rows
    cases = {(row.axis, row.value) for row in rows}
    surfaces = {"polyhedral", "repair"}
    methods = set(method_names("all")) - surfaces - {"fem-tetwild", "tetwild"}  # too slow
    assert set(studied_methods()) == methods | surfaces
    assert {row.method for row in rows} == methods
    assert len(rows) == len(cases) * len(methods)
    assert all(row.failure or row.volume_error is not None for row in rows)


@pytest.mark.parametrize("label", [body.label for body in BODIES if body.ellipsoid])
def test_cavalieri_errs_on_ellipsoids_by_one_over_two_m_squared(label):
    rows = [row for row in refined(label).rows if row.method == "cavalieri"]
    assert [row.value for row in rows] == [7, 14]
    for row in rows:
        assert row.expected_volume_error == pytest.approx(50.0 / row.value**2)
        assert row.volume_error == pytest.approx(row.expected_volume_error, abs=1e-5)


def orders(method, *labels):
    return [order for label in labels for order in refined(label).orders if order.method == method]


def test_frustums_lose_their_ends_by_first_order_at_faces_and_second_at_round_ends():
    for order in orders("frustum", "box", "prism", "cylinder", "twisted bar"):
        assert order.theory == 1.0
        assert order.volume == pytest.approx(1.0, abs=0.15)
    for order in orders("frustum", "ellipsoid", "potato 1", "apple"):
        assert order.theory == 2.0
        assert order.volume == pytest.approx(2.0, abs=0.3)


def test_cavalieri_is_of_second_order():
    found = orders("cavalieri", "ellipsoid", "potato 0", "apple", "banana", "meat", "frustum")
    assert np.median([order.volume for order in found]) == pytest.approx(2.0, abs=0.2)


def test_the_loft_is_of_fourth_order_in_points():
    seen = [order for label in ("ellipsoid, pose 1", "potato 1") for order in studied(label).orders]
    for order in (x for x in seen if (x.method, x.axis) == ("loft", "points")):
        assert order.theory == 4.0
        assert order.volume > 3.5
        assert order.area > 3.0


def told(values, digits):
    return ["–" if x is None else f"{x:.{digits}f}" for x in values]


def as_rows(found):
    for line in found.summaries():
        if line.measured or line.failed:
            errors = told((line.volume_rms, line.volume_worst, line.area_rms, line.area_worst), 4)
            seen = told((line.volume_order, line.theory, line.area_order), 1)
            yield (line.method, line.axis, line.measured, line.failed, *errors, *seen)


@pytest.mark.prove
def test_the_full_matrix(proof, tmp_path):
    found = study_accuracy(AccuracyRequest(levels=FULL))
    assert len(list(write_accuracy(found, tmp_path))) == 5
    for row in found.rows:
        if row.expected_volume_error is not None:
            assert row.volume_error == pytest.approx(row.expected_volume_error, abs=1e-5)
    by_method = {line.method: line for line in found.summaries() if line.axis == "sections"}
    assert by_method["cavalieri"].volume_order == pytest.approx(2.0, abs=0.1)
    assert by_method["frustum"].volume_rms > 5 * by_method["loft"].volume_rms
    write_proof(found, proof)


def write_proof(found, proof):
    header = ("method", "axis", "cases", "failed", "V rms %", "V worst %", "S rms %", "S worst %", "V order",
              "theory", "S order")  # fmt: skip
    claim = (
        f"{len(BODIES)} bodies by every method, errors at the finest value of each axis (docs/accuracy.md)"
    )
    proof("accuracy", claim, header, as_rows(found))
    expected = [row for row in found.rows if row.expected_volume_error is not None]
    proof(
        "accuracy-cavalieri", "Cavalieri on ellipsoids, sections at mid-thickness: +1/(2m²)",
        ("body", "sections", "V error %", "theory %"),
        [(x.body, x.value, f"{x.volume_error:+.6f}", f"{x.expected_volume_error:+.6f}") for x in expected],
    )  # fmt: skip
    proof(
        "accuracy-failures", "Cases of the accuracy study without figures",
        ("method", "reason", "cases", "bodies"),
        [
            (method, reason.replace("|", "/"), len(rows), ", ".join(dict.fromkeys(row.body for row in rows)))
            for (method, reason), rows in found.failures().items()
        ],
    )  # fmt: skip
    if os.environ.get("STACKLOFT_PROOF"):
        with whole_file(PROOF / "accuracy.png") as stream:
            write_heat_map(found, stream)


def rounded_up(error):
    if error is None:
        return None
    wanted = max(1.25 * abs(error), 1e-4)
    ten = 10.0 ** math.floor(math.log10(wanted))
    return next(float(f"{k * ten:.2g}") for k in (1, 1.5, 2, 3, 5, 7, 10) if k * ten >= wanted)


def renewed():
    yield HEAD
    for body in BODIES:
        rows = [row for row in finest(study(body).rows) if row.failure is None]
        for axis in axes_of(body.label):
            yield f'["{body.label}".{axis}]'
            for row in rows:
                if row.axis == axis:
                    both = [rounded_up(row.volume_error), rounded_up(row.area_error)]
                    known = [f"{name} = {x:g}" for name, x in zip("VS", both, strict=True) if x is not None]
                    yield f"{row.method} = {{ {', '.join(known)} }}"
            yield ""


if __name__ == "__main__":
    sys.stdout.write("\n".join(renewed()))
