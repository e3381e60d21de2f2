"""The paper's statistics from the paper's table, and least squares through the origin on its own."""

from pathlib import Path

import numpy as np
import pytest

from stackloft.studies.regression import regress, regression_of
from stackloft.studies.specimen_table import Specimen
from stackloft.studies.through_origin import fit_through_origin

TABLE = Path(__file__).parents[2] / "sample_stacks" / "goni2007_table1.csv"

# Goñi, Purlis & Salvadori (2007): MARE, mean RE (%), r, α₀, its R², β₀, its R²
PAPER = {
    "Granny Smith": (1.95, -1.25, 0.9917, 6.1117, 0.9336, 5.0085, 0.9725),
    "Red Delicious": (1.69, -1.01, 0.9978, 5.6312, 0.9828, 5.0961, 0.9582),
    "Meat piece": (1.36, -0.95, 0.9954, 6.1068, 0.9460, 6.3729, 0.9644),
}


@pytest.mark.parametrize("group", PAPER)
def test_the_paper_s_twenty_rows_give_the_paper_s_figures(group):
    (found,) = (one for one in regress(TABLE).groups if one.group == group)
    a, b = found.area_by_weight, found.area_by_volume
    mare, mean, r, alpha, alpha_r2, beta, beta_r2 = PAPER[group]
    assert (round(found.mare, 2), round(found.mean_relative_error, 2)) == (mare, mean)
    assert round(found.correlation, 4) == r
    assert (round(a.coefficient, 4), round(a.r_squared, 4)) == (alpha, alpha_r2)
    assert (round(b.coefficient, 4), round(b.r_squared, 4)) == (beta, beta_r2)


def test_all_twenty_rows_are_read_in_their_groups():
    found = regress(TABLE)
    assert [group.count for group in found.groups] == [6, 6, 8]
    assert len(found.specimens) == 20


def test_the_fit_is_where_the_sum_of_squares_is_least():
    rng = np.random.default_rng(3)
    x = rng.uniform(1, 9, 12)
    y = 2.5 * x + rng.normal(size=12)
    fit = fit_through_origin(x, y)

    def ssr(a):
        return ((y - a * x) ** 2).sum()

    step = 1e-4
    assert ssr(fit.coefficient) < min(ssr(fit.coefficient - step), ssr(fit.coefficient + step))
    assert fit.r_squared == pytest.approx(1 - ssr(fit.coefficient) / ((y - y.mean()) ** 2).sum())
    assert fit.r_squared_uncentred == pytest.approx(1 - ssr(fit.coefficient) / (y**2).sum())


def test_the_standard_error_is_the_estimates_spread_and_the_interval_holds_the_truth():
    rng = np.random.default_rng(11)
    x = np.linspace(2, 5, 8)
    fits = [fit_through_origin(x, 3.0 * x + rng.normal(scale=0.4, size=8)) for _ in range(4000)]
    spread = np.std([fit.coefficient for fit in fits])
    assert np.sqrt(np.mean([fit.standard_error**2 for fit in fits])) == pytest.approx(spread, rel=0.03)
    held = np.mean([fit.interval95[0] < 3.0 < fit.interval95[1] for fit in fits])
    assert held == pytest.approx(0.95, abs=0.012)


def test_what_does_not_vary_has_no_correlation_and_no_r_squared():
    rows = [Specimen(str(k), "g", 100.0, 90.0, 89.0, 120.0) for k in range(3)]
    (group,) = regression_of(rows).groups
    assert group.correlation is None
    assert group.area_by_weight.r_squared is None
    assert group.area_by_weight.standard_error == pytest.approx(0, abs=1e-12)


def test_scaling_the_bodies_scales_the_figures():
    rows = regress(TABLE).specimens
    big = [
        Specimen(x.sample, x.group, 8 * x.weight, 8 * x.volume_measured, 8 * x.volume_estimated,
                 4 * x.area_estimated)
        for x in rows
    ]  # fmt: skip
    for before, after in zip(regression_of(rows).groups, regression_of(big).groups, strict=True):
        assert after.area_by_weight.coefficient == pytest.approx(before.area_by_weight.coefficient)
        assert after.area_by_volume.r_squared == pytest.approx(before.area_by_volume.r_squared)
        assert after.mare == pytest.approx(before.mare)
