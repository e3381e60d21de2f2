"""Methods are judged by their known biases; who falls out is named with the likely reason."""

import pytest

from stackloft.model.bias import Bias
from stackloft.model.measurement import Integral
from stackloft.pipeline.agreement import claim, disagreements, judged
from stackloft.pipeline.plan import Method

ONE = Bias(-1.0, 1.0, "of no reason")


def claims(*values, bias=ONE):
    return [claim(name, value, bias, None) for name, value in zip("abcdef", values, strict=False)]


def test_figures_within_their_biases_agree():
    assert judged(claims(100.0, 101.0, 99.5), "volume", "mm³") == []
    assert judged(claims(100.0), "volume", "mm³") == []


def test_a_figure_that_is_known_to_be_high_is_no_outlier():
    high = claim("mesh", 110.0, Bias(8.0, 12.0, "stairs"), None)
    assert judged([*claims(100.0, 100.5), high], "area", "mm²") == []
    low = claim("mesh", 100.2, Bias(8.0, 12.0, "stairs"), None)
    (notice,) = judged([*claims(100.0, 100.5), low], "area", "mm²")
    assert notice.code == "method-disagrees"
    assert notice.message.startswith("mesh: its area, 100.2 mm²")
    assert notice.message.endswith("likely because stairs")


@pytest.mark.parametrize(("value", "side"), [(120.0, "above"), (80.0, "below")])
def test_the_outlier_is_named_with_side_and_reason(value, side):
    (notice,) = judged(claims(100.0, 101.0, value), "volume", "mm³")
    assert f"c: its volume, {value:g} mm³" in notice.message
    assert side in notice.message
    assert "a and b agree on" in notice.message


def test_the_standard_uncertainty_counts_twice_over():
    far = claim("c", 106.0, ONE, 2.1)
    assert judged([*claims(100.0, 100.0), far], "volume", "mm³") == []
    assert len(judged([*claims(100.0, 100.0), claim("c", 106.0, ONE, 1.0)], "volume", "mm³")) == 1


@pytest.mark.parametrize("values", [(100.0, 120.0), (100.0, 100.5, 120.0, 120.5)])
def test_without_a_majority_nobody_is_blamed(values):
    (notice,) = judged(claims(*values), "volume", "mm³")
    assert "no majority tells which is off" in notice.message


def test_what_an_integrator_says_of_one_body_wins_and_the_unknown_have_no_say():
    methods = [
        Method("a", volume_bias=ONE),
        Method("b", volume_bias=ONE),
        Method("c", volume_bias=ONE),
        Method("d"),
    ]
    told = Bias(-1.0, 30.0, "half a slab")
    integrals = [
        Integral(100.0, 7.0),
        Integral(100.0, 9.0),
        Integral(120.0, None, volume_bias=told),
        Integral(5.0, 1.0),
    ]
    assert disagreements(list(zip(methods, integrals, strict=True))) == ()
    without = [*integrals[:2], Integral(120.0, None), integrals[3]]
    (notice,) = disagreements(list(zip(methods, without, strict=True)))
    assert notice.message.startswith("c: its volume")
