"""What is told of a plug-in without importing it."""

import sys

import pytest

from stackloft.registry import catalogue
from stackloft.registry.child import ask_child
from stackloft.registry.glance import glance
from stackloft.testing.conformance.throwaway import installed

CLASS = "class Reader:\n    api: ClassVar[str] = '1'\n"
SOURCES = {
    "plain": (CLASS, "ok", "1"),
    "assigned": ("class Reader:\n    api = '1.3'\n", "newer", "1.3"),
    "major": ("class Reader:\n    api = '2'\n", "refused", "2"),
    "inherited": ("class Base:\n    api = '1'\nclass Reader(Base):\n    pass\n", "ok", "1"),
    "from elsewhere": ("from acme_base import Reader\n", "missing package", None),
    "computed": ("class Reader:\n    api = str(1)\n", "ok", None),
    "no such class": ("class Reder:\n    api = '1'\n", "stale", None),
    "star": ("from json import *\n", "ok", None),
    "syntax": ("def (:\n", "unreadable", None),
    "guarded import": (f"try:\n    import acme_none\nexcept ImportError:\n    pass\n{CLASS}", "ok", "1"),
    "recipe": ("Reader = Recipe(('integrator.voxel',), 'mine')\n", "ok", "1"),
    "recipe of old": ("Reader: Recipe = Recipe((), 'mine', api='3')\n", "refused", "3"),
}


@pytest.mark.parametrize("name", SOURCES)
def test_the_source_tells_state_and_api(tmp_path, name):
    source, state, api = SOURCES[name]
    with installed(
        tmp_path, "acme-look", {"stackloft.readers": {"look": "acme_look:Reader"}}, {"acme_look": source}
    ):
        (listing,) = [x for x in catalogue("reader") if x.name == "look"]
        found = glance(listing)
        assert (found.state, found.api) == (state, api)
        assert bool(found.reason) == (state != "ok")
        assert "acme_look" not in sys.modules


def test_a_child_that_hangs_is_ended():
    assert ask_child("time:sleep", 30, timeout=0.5).fault == "did not end within 0.5 s"


def test_a_child_s_chatter_is_not_its_answer():
    answer = ask_child("builtins:print", "hello")
    assert (answer.value, answer.fault, answer.stderr) == (None, "", "hello\n")
