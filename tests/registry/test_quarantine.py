"""A broken stranger is reported with its reason and breaks nothing else."""

import pytest

from stackloft.model.errors import PluginError
from stackloft.registry import Loaded, Quarantined, catalogue, find, load, probe_all
from stackloft.testing.conformance.throwaway import installed

HEAD = """
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar
from stackloft.contracts.options import option
from stackloft.model.contour_stack import ContourStack
"""
GOOD = """
@dataclass(frozen=True)
class Reader:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (ContourStack,)
    pitch: float = option(1.0, "pitch", unit="mm", gt=0)
    def probe(self, path): return 0.0
    def read(self, path): return ContourStack(())
"""

BROKEN = {
    "import error": ("import no_such_module_at_all", "ModuleNotFoundError: No module named"),
    "exits": ("raise SystemExit(3)", "SystemExit: 3"),
    "syntax": ("def (:", "SyntaxError"),
    "no such class": (HEAD, "AttributeError"),
    "not frozen": (HEAD + GOOD.replace("frozen=True", "frozen=False"), "dataclass that is not frozen"),
    "no dataclass": (HEAD + GOOD.replace("@dataclass(frozen=True)", ""), "is not a dataclass"),
    "major api": (HEAD + GOOD.replace('"1"', '"2"'), "api 2 does not fit this stackloft's contract 1"),
    "odd api": (HEAD + GOOD.replace('"1"', "1"), "api must be text"),
    "no api": (HEAD + GOOD.replace('api: ClassVar[str] = "1"', ""), "has no api version"),
    "no probe": (HEAD + GOOD.replace("def probe", "def prob"), r"has no method probe\(\)"),
    "no produces": (HEAD + GOOD.replace("produces:", "makes:"), "produces must be a tuple of types"),
    "accepts a word": (HEAD + GOOD.replace("(Path,)", "('Path',)"), "accepts must be a tuple of types"),
    "mutable default": (
        HEAD + GOOD.replace('option(1.0, "pitch", unit="mm", gt=0)', "field(default_factory=list)"),
        "option pitch has a mutable default",
    ),
    "no default": (
        HEAD + GOOD.replace(' = option(1.0, "pitch", unit="mm", gt=0)', ""),
        "option pitch has no default",
    ),
    "raises on inspection": (
        HEAD + GOOD + "\nclass Meta(type):\n    def __getattr__(cls, name): raise RuntimeError(name)\n"
        "class Odd(metaclass=Meta): pass\nReader = Odd\n",
        "RuntimeError: api",
    ),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_plugins_are_quarantined_with_their_reason(tmp_path, fault):
    source, reason = BROKEN[fault]
    with installed(
        tmp_path, "broken-one", {"stackloft.readers": {"broken": "broken_one:Reader"}}, {"broken_one": source}
    ):
        (listing,) = [x for x in catalogue("reader") if x.distribution == "broken-one"]
        outcome = load(listing)
        assert isinstance(outcome, Quarantined)
        with pytest.raises(
            PluginError, match=f"reader.broken of broken-one 1.0 is quarantined; found: .*{reason}"
        ):
            find("reader", "broken")
        assert find("recipe", "loft").name == "loft"
        assert all(probe.reader.name != "broken" for probe in probe_all(tmp_path))


def test_a_failing_import_keeps_its_traceback(tmp_path):
    source = "def deep():\n    return 1 / 0\ndeep()\n"
    with installed(
        tmp_path, "broken-two", {"stackloft.readers": {"b": "broken_two:Reader"}}, {"broken_two": source}
    ):
        (listing,) = [x for x in catalogue("reader") if x.name == "b"]
        outcome = load(listing)
        assert isinstance(outcome, Quarantined)
        assert outcome.reason == "ZeroDivisionError: division by zero"
        assert "in deep" in outcome.traceback


def test_the_healthy_twin_loads_and_a_minor_version_is_only_noticed(tmp_path):
    source = HEAD + GOOD.replace('"1"', '"1.7"')
    with installed(
        tmp_path, "good-one", {"stackloft.readers": {"good": "good_one:Reader"}}, {"good_one": source}
    ):
        outcome = find("reader", "good")
        assert isinstance(outcome, Loaded)
        assert [notice.code for notice in outcome.notices] == ["plugin-api-minor"]


@pytest.mark.parametrize(
    ("recipe", "reason"),
    [
        ("42", "is not a Recipe but int"),
        ("Recipe(steps=(), summary='')", "has no steps"),
        ("Recipe(steps=('loft',), summary='')", "step 'loft' is not family.name"),
        ("Recipe(steps=('reader.photos',), summary='')", "step 'reader.photos' is not family.name"),
        ("Recipe(steps=('integrator.x',), summary='', api='3')", "api 3 does not fit"),
    ],
)
def test_broken_recipes(tmp_path, recipe, reason):
    source = f"from stackloft.contracts.recipe import Recipe\nmine = {recipe}\n"
    with (
        installed(
            tmp_path, "broken-r", {"stackloft.recipes": {"mine": "broken_r:mine"}}, {"broken_r": source}
        ),
        pytest.raises(PluginError, match=reason),
    ):
        find("recipe", "mine")
