"""``stackloft plugins check`` on the built-in plug-ins and on what is not installed."""

import json

import pytest


@pytest.mark.parametrize(
    "name", ["photos", "reader.numpy", "contours", "writer.json", "writer.csv", "stl", "recipe.loft"]
)
def test_built_ins_hold(stackloft, name):
    run = stackloft("plugins", "check", name, "--json")
    assert run.returncode == 0, run.stdout + run.stderr
    told = json.loads(run.stdout)
    assert told["passed"]
    assert len(told["checks"]) >= 4


def test_an_expected_failure_is_told_with_its_reason(stackloft):
    run = stackloft("plugins", "check", "reader.contours")
    assert run.returncode == 0
    assert "expected failure" in run.stdout
    assert "a table cut off between two rows" in run.stdout


def test_a_class_that_is_not_registered_is_checked_by_its_place(stackloft):
    run = stackloft("plugins", "check", "stackloft_plugins.writers.stl:StlWriter")
    assert run.returncode == 0, run.stderr
    assert "8 of 8 checks hold" in run.stdout


@pytest.mark.parametrize(
    ("name", "status", "words"),
    [
        ("loft", 1, "2 plug-ins are called 'loft'; fix: name one: reconstructor.loft, recipe.loft"),
        ("hystogram", 1, "did you mean histogram?"),
        ("json:JSONDecoder", 2, "which family a plug-in belongs to cannot be told"),
        ("no_such:Thing", 1, "no_such:Thing cannot be imported"),
    ],
)
def test_what_cannot_be_checked_is_one_line(stackloft, name, status, words):
    run = stackloft("plugins", "check", name)
    assert (run.returncode, run.stdout) == (status, "")
    assert words in run.stderr
