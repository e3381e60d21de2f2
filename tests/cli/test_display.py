"""What people read: figures, tables, progress."""

import io

import pytest
from rich.console import Console
from rich.progress import Progress

from stackloft.cli.progress import RichProgress, progress_display
from stackloft.cli.result_table import show_result
from stackloft.cli.units import in_unit, with_uncertainty
from stackloft.model.measurement import EndReport, Figure, Measurement, MethodRow, Result
from stackloft.model.notices import Notice
from stackloft.pipeline.progress import Silence


@pytest.mark.parametrize(
    ("value", "unit", "power", "text"),
    [
        (178042.3, "cm", 3, "178.04 cm³"),
        (178042.3, "mm", 3, "178040 mm³"),
        (178042.3, "in", 3, "10.865 in³"),
        (15320.4, "m", 2, "0.015320 m²"),
        (0.5, "um", 1, "500.00 µm"),
    ],
)
def test_a_figure_in_every_unit(value, unit, power, text):
    assert in_unit(value, unit, power) == text


@pytest.mark.parametrize(
    ("uncertainty", "text"),
    [
        (312.0, "178.04 ± 0.31 cm³"),
        (4560.0, "178.0 ± 4.6 cm³"),
        (99000.0, "178 ± 99 cm³"),
        (None, "178.04 cm³"),
    ],
)
def test_an_uncertain_figure_shows_no_digit_more_than_is_meant(uncertainty, text):
    assert with_uncertainty(178042.3, uncertainty, "cm", 3) == text


def shown(result, files=()):
    stream = io.StringIO()
    show_result(Console(file=stream, width=100), result, files, "cm")
    return stream.getvalue()


def test_table_with_everything_there_is():
    volume, area = Figure(178042.3, "mm^3", "loft", 312.0), Figure(15320.4, "mm^2", "loft")
    body = Measurement(
        id=1,
        volume=volume,
        area=area,
        methods={"loft": MethodRow(volume, area, 0.2), "fem": MethodRow(None, None, 0.0, "no mesher")},
        derived={"equivalent_diameter": 69.8, "sphericity": 0.998, "density": 0.85},
        ends=(
            EndReport("round", 2.8, "the parabola", guessed=True, volume_effect=520.0, area_effect=31.0),
            EndReport("face", 0.0, "given: the outermost section is the face"),
        ),
    )
    source = {"path": "stacks/apple", "reader": "photos", "digest": ""}
    text = shown(Result(source, (body,), (Notice("end-guessed", "give [--height]"),)), ["out/[a].json"])
    for words in (
        "apple · 0 sections · method loft",
        "178.04 ± 0.31 cm³",
        "153.20 cm²",
        "6.9800 cm",
        "0.9980",
        "0.8500 g/cm³",
        "round, 0.280 cm beyond the section; guessed, ± 0.520 cm³, ± 0.310 cm²",
        "face; given: the outermost section is the face",
        "no mesher",
        "end-guessed  give [--height]",
        "out/[a].json",
    ):
        assert words in text, words


def test_a_method_without_an_area_says_so():
    body = Measurement(id=1, volume=Figure(1000.0, "mm^3", "cavalieri"), area=None)
    assert "not given by this method" in shown(Result({"path": "a"}, (body,)))


def test_progress_is_silent_when_nobody_watches_or_quiet_is_asked(capsys):
    for quiet in (True, False):
        with progress_display(quiet=quiet) as progress:
            assert isinstance(progress, Silence)
    assert capsys.readouterr().err == ""


def test_progress_draws_each_stage_with_its_steps():
    stream = io.StringIO()
    with Progress(console=Console(file=stream, force_terminal=True, width=80)) as display:
        progress = RichProgress(display)
        progress.begin("sections", 3)
        for _ in range(3):
            progress.advance()
        progress.end()
        progress.begin("loft", None)
        progress.end()
        assert [task.finished for task in display.tasks if task.visible] == [True, True]
    assert "sections" in stream.getvalue()
    assert "loft" in stream.getvalue()
