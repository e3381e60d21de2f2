"""Gauss rules on triangle and tetrahedron: every monomial, exact rational answers, scikit-fem beside."""

from fractions import Fraction
from math import factorial, prod

import numpy as np
import pytest

from stackloft.geometry.lagrange_simplex import exponents
from stackloft.geometry.simplex_gauss import HIGHEST, simplex_gauss

POINTS = {2: (1, 3, 6, 6, 7, 12, 15, 16, 19, 25), 3: (1, 4, 8, 14, 14, 24, 35, 46, 59, 81)}
RULES = [(dimension, degree) for dimension in (2, 3) for degree in range(1, HIGHEST + 1)]


def exact(powers):
    """∫ x^a y^b z^c over the unit simplex: a! b! c! / (a + b + c + dimension)! (Stroud 1971)."""
    return Fraction(prod(map(factorial, powers)), factorial(sum(powers) + len(powers)))


@pytest.mark.parametrize(("dimension", "degree"), RULES)
def test_every_monomial_up_to_the_degree(dimension, degree):
    points, weights = simplex_gauss(dimension, degree)
    assert len(weights) == POINTS[dimension][degree - 1]
    assert weights.min() > 0
    assert points.min() > 0
    assert points.sum(axis=1).max() < 1
    for powers in exponents(dimension, degree).tolist():
        found = (points**powers).prod(axis=1) @ weights
        assert found == pytest.approx(float(exact(powers)), rel=2e-15)


@pytest.mark.parametrize(("dimension", "degree"), RULES)
def test_no_rule_promises_less_than_it_holds_by_much(dimension, degree):
    # a rule that were exact far beyond its degree would mean that the check above cannot fail
    points, weights = simplex_gauss(dimension, degree)
    beyond = [p for p in exponents(dimension, degree + 3).tolist() if sum(p) == degree + 3]
    off = [abs((points**p).prod(axis=1) @ weights / float(exact(p)) - 1) for p in beyond]
    assert max(off) > 1e-6


@pytest.mark.parametrize(("dimension", "degree"), RULES)
def test_scikit_fem_finds_the_same(dimension, degree):
    from skfem.element import ElementLineP1, ElementTetP1, ElementTriP1  # noqa: PLC0415
    from skfem.quadrature import get_quadrature  # noqa: PLC0415

    if dimension == 2 or degree <= 4:
        theirs, weights = get_quadrature(ElementTriP1 if dimension == 2 else ElementTetP1, degree)
    else:  # it has no rules of higher degree for the tetrahedron: its line rule, collapsed (Duffy 1982)
        x, w = get_quadrature(ElementLineP1, degree + 2)
        a, b, c = (grid.ravel() for grid in np.meshgrid(x[0], x[0], x[0]))
        weights = (w[:, None, None] * w[:, None] * w).transpose(1, 0, 2).ravel() * (1 - a) ** 2 * (1 - b)
        theirs = np.array([a, b * (1 - a), c * (1 - a) * (1 - b)])
    ours, own_weights = simplex_gauss(dimension, degree)
    coefficients = np.random.default_rng(degree).normal(size=len(exponents(dimension, degree)))

    def polynomial(x):
        return (x[:, None, :] ** exponents(dimension, degree)).prod(axis=2) @ coefficients

    assert polynomial(ours) @ own_weights == pytest.approx(
        polynomial(theirs.T) @ weights, rel=1e-12, abs=1e-14
    )
