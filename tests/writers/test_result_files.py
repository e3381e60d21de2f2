"""JSON and CSV hold the result exactly, and the JSON keeps to its published schema."""

import csv
import dataclasses
import io
import json
import math
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from stackloft.model.errors import OutputError
from stackloft.model.measurement import EndReport, Figure, Measurement, MethodRow, Result, SectionRow
from stackloft.model.notices import Notice
from stackloft_plugins.writers.csv import HEADER, CsvWriter
from stackloft_plugins.writers.json import JsonWriter

SCHEMA = json.loads((Path(__file__).parents[2] / "docs" / "measurement.schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def full_result():
    volume = Figure(178042.31234567, "mm^3", "loft", 312.5, (177430.0, 178655.0))
    area = Figure(np.float64(15320.4), "mm^2", "loft")
    return Result(
        source={"path": "apple", "reader": "photos", "digest": "ab" * 32},
        objects=(
            Measurement(
                id=1,
                volume=volume,
                area=area,
                methods={
                    "loft": MethodRow(volume, area, 0.25),
                    "cavalieri": MethodRow(Figure(178100.0, "mm^3", "cavalieri"), None, 0.001),
                    "fem": MethodRow(None, None, 0.0, "no mesher is installed"),
                },
                derived={
                    "equivalent_diameter": 69.8,
                    "sphericity": 0.998,
                    "specific_surface": 0.086,
                    "density": None,
                },
                uncertainty_budget=({"source": "scale", "volume": 100.0, "area": float("nan")},),
                ends=(
                    EndReport("round", 2.8, "areas", True, 520.0, 310.0),
                    EndReport("face", 0.0, "stack.toml"),
                ),
                sections=(
                    SectionRow(1, -0.1, 1000.125, 112.0, (1 / 3, -2.5), 1, 0),
                    SectionRow(2, 5.5, 0.0, 0.0, (math.nan, math.nan), 0, 0),
                ),
                mesh={"order": 2, "elements": 10, "nodes": 40, "min_scaled_jacobian": 0.3, "inverted": 0},
            ),
        ),
        warnings=(Notice("end-guessed", "the first end lies 2.8 mm beyond; ± 0.52 cm³"),),
        recipe={"method": "loft", "options": {"reconstructor.loft": {"points": np.int64(33)}}},
        provenance={"versions": {"numpy": "2.4.6"}, "seconds": {"total": 0.3}, "stackloft": "0.1.0"},
    )


def written(result, writer=None):
    stream = io.BytesIO()
    (writer or JsonWriter()).write(result, stream)
    return stream.getvalue().decode("utf-8")


def test_the_schema_is_a_valid_schema():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_a_full_result_keeps_to_the_schema():
    document = json.loads(written(full_result()))
    VALIDATOR.validate(document)
    assert document["schema"] == "stackloft.measurement/1"
    (body,) = document["objects"]
    assert body["volume"] == {
        "value": 178042.31234567,
        "unit": "mm^3",
        "standard_uncertainty": 312.5,
        "interval95": [177430.0, 178655.0],
        "method": "loft",
    }
    assert body["area"]["standard_uncertainty"] is None
    assert body["area"]["interval95"] is None
    assert body["methods"]["cavalieri"]["area"] is None
    assert body["methods"]["fem"] == {
        "volume": None,
        "area": None,
        "seconds": 0.0,
        "error": "no mesher is installed",
    }
    assert body["ends"][0] == {"kind": "round", "length": 2.8, "reason": "areas"}
    assert body["sections"][0]["centroid"] == [1 / 3, -2.5]


def test_what_is_not_a_number_is_null_and_never_nan():
    text = written(full_result())
    assert "NaN" not in text
    assert "Infinity" not in text
    body = json.loads(text)["objects"][0]
    assert body["sections"][1]["centroid"] is None
    assert body["uncertainty_budget"] == [{"source": "scale", "volume": 100.0, "area": None}]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_figure_that_is_no_number_is_refused_before_a_byte_is_written(value):
    result = full_result()
    broken = dataclasses.replace(result.objects[0], volume=Figure(value, "mm^3", "loft"))
    stream = io.BytesIO()
    with pytest.raises(OutputError, match="not a finite number"):
        JsonWriter().write(dataclasses.replace(result, objects=(broken,)), stream)
    assert stream.getvalue() == b""


def test_a_method_that_gives_volume_alone_keeps_to_the_schema():
    result = full_result()
    alone = dataclasses.replace(result.objects[0], area=None, ends=(), derived={}, mesh=None)
    document = json.loads(written(dataclasses.replace(result, objects=(alone,))))
    VALIDATOR.validate(document)
    assert document["objects"][0]["area"] is None
    assert document["objects"][0]["derived"]["density"] is None


@pytest.mark.parametrize(
    "path",
    [(), ("source",), ("objects", 0), ("objects", 0, "volume"), ("objects", 0, "ends", 0), ("provenance",)],
)
def test_the_schema_refuses_a_key_too_many_and_a_key_too_few(path):
    for change in (lambda part: part.update(extra=1), lambda part: part.pop(next(iter(part)))):
        document = json.loads(written(full_result()))
        part = document
        for key in path:
            part = part[key]
        change(part)
        assert not VALIDATOR.is_valid(document)


def test_every_floating_number_reads_back_to_the_bit():
    result = full_result()
    body = json.loads(written(result, JsonWriter(indent=0)))["objects"][0]
    assert body["volume"]["value"] == result.objects[0].volume.value
    assert [row["z"] for row in body["sections"]] == [-0.1, 5.5]


def test_csv_has_units_in_its_header_and_a_row_per_section():
    rows = list(csv.reader(io.StringIO(written(full_result(), CsvWriter()), newline="")))
    assert tuple(rows[0]) == HEADER
    assert "z [mm]" in HEADER
    assert "area [mm^2]" in HEADER
    assert len(rows) == 3
    first = dict(zip(HEADER, rows[1], strict=True))
    assert float(first["centroid x [mm]"]) == 1 / 3
    assert float(first["area [mm^2]"]) == 1000.125
    assert rows[2][5:7] == ["", ""], "a section without a body has no centroid"
