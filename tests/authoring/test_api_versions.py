"""A plug-in for another major contract is refused, one for a later minor one warned of, in a run."""

import pytest

from stackloft.model.errors import PluginError, UsageError
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.testing.conformance.ellipsoids import contour_stack
from stackloft.testing.conformance.throwaway import installed

SOURCE = """
from dataclasses import dataclass
from typing import ClassVar
from stackloft.contracts.options import option
from stackloft.contracts.recipe import Recipe
from stackloft_plugins.integrators.cavalieri import Cavalieri
@dataclass(frozen=True)
class Later(Cavalieri):
    api: ClassVar[str] = "API"
    trim: float = option(0.0, "what is cut off", unit="mm", ge=0)
later = Recipe(("integrator.later",), "later")
"""
GROUPS = {
    "stackloft.integrators": {"later": "acme_later:Later"},
    "stackloft.recipes": {"later": "acme_later:later"},
}


def run(folder, api, **settings):
    with installed(folder, "acme-later", GROUPS, {"acme_later": SOURCE.replace("API", api)}):
        request = MeasureRequest("body", method="later", settings={"integrator.later": settings})
        return measure(request, product=contour_stack(1)).result


def test_a_later_minor_version_is_warned_of_and_measures(tmp_path):
    result = run(tmp_path, "1.4")
    assert result.objects[0].volume.value > 0
    (message,) = [notice.message for notice in result.warnings if notice.code == "plugin-api-minor"]
    assert "integrator.later is written for contract 1.4, this stackloft offers 1" in message


def test_another_major_version_is_refused_by_name(tmp_path):
    with pytest.raises(PluginError, match=r"integrator.later of acme-later 1.0 is .*api 2 does not fit"):
        run(tmp_path, "2")


def test_an_unknown_option_is_refused_with_the_nearest_name(tmp_path):
    with pytest.raises(UsageError, match="did you mean trim"):
        run(tmp_path, "1", trimm="1mm")
