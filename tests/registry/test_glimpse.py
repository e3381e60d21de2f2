"""What shells are told of options is what the plug-ins really have."""

import pytest

from stackloft.registry import catalogue, fields_of, find
from stackloft.registry.glimpse import glimpse_options
from stackloft.registry.scan import Listing
from stackloft.testing.conformance.throwaway import installed

OWN = [x for x in catalogue() if x.distribution == "stackloft" and x.family != "recipe"]


@pytest.mark.parametrize("listing", OWN, ids=lambda listing: listing.key)
def test_the_text_tells_every_option_with_its_choices(listing):
    fields = fields_of(find(listing.family, listing.name).plugin)
    seen = {option.name: option for option in glimpse_options(listing)}
    assert list(seen) == [field.name for field in fields]
    for field in fields:
        words = field.choices or (("true", "false") if field.annotation is bool else ())
        assert set(seen[field.name].choices) == set(words), field.name


def test_inherited_and_imported_options_are_seen_and_nothing_is_imported(tmp_path):
    modules = {
        "acme_words": "RULES = {'left': 1, 'right': 2}\nraise SystemExit('imported')\n",
        "acme_base": "from acme_words import RULES\nclass Base:\n"
        "    side: str = option('left', 'which side', choices=(*sorted(RULES), 'both'))\n",
        "acme_options": "from typing import ClassVar\nfrom acme_base import Base as B\nclass Mine(B):\n"
        "    api: ClassVar[str] = '1'\n    mirrored: bool = False\n    _hidden: int = 3\n",
    }
    with installed(tmp_path, "acme-options", {}, modules):
        found = glimpse_options(Listing("integrator", "mine", "acme-options", "1", "acme_options:Mine"))
    assert [(x.name, x.help, x.choices) for x in found] == [
        ("side", "which side", ("left", "right", "both")),
        ("mirrored", "", ("true", "false")),
    ]


@pytest.mark.parametrize(
    "source", ["def (:", "Mine = make()", "class Mine(Mine): pass", "from gone import Mine"]
)
def test_text_that_tells_nothing_is_no_error(tmp_path, source):
    with installed(tmp_path, "acme-odd", {}, {"acme_odd": source}):
        assert glimpse_options(Listing("integrator", "m", "acme-odd", "1", "acme_odd:Mine")) == ()
