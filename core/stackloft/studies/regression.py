"""The statistics of Goñi, Purlis & Salvadori (2007), Table 2: how good the volumes are, and area by weight.

Per group, with RE = (V_estimated − V_measured)/V_measured:

======================  =======================================================
mean RE, MARE           Σ RE/n and Σ |RE|/n, %
r                       Pearson's correlation of measured and estimated volume
density                 weight over measured volume, g/cm³
α₀                      S = α₀·W^(2/3), S in cm², W in g, through the origin
β₀                      S = β₀·V^(2/3), V the measured volume in cm³
======================  =======================================================

Similar bodies of one density have areas that go with the 2/3 power of weight and of volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.studies.specimen_table import Specimen, read_table
from stackloft.studies.through_origin import OriginFit, fit_through_origin

SCHEMA = "stackloft.regression/1"
EXPONENT = 2.0 / 3.0
_UNITS = {
    "weight": "g",
    "volume_measured": "cm^3",
    "volume_estimated": "cm^3",
    "area_estimated": "cm^2",
    "relative_error": "%",
    "mean_relative_error": "%",
    "mare": "%",
    "density": "g/cm^3",
    "density_deviation": "g/cm^3",
    "area_by_weight": "cm^2/g^(2/3)",
    "area_by_volume": "1",
}


@dataclass(frozen=True, slots=True)
class GroupStatistics:
    """One group's figures."""

    group: str
    count: int
    mean_relative_error: float
    """%, signed: negative when the estimates are low."""
    mare: float
    """Mean absolute relative error, %."""
    correlation: float | None
    """Pearson's r; None when a column does not vary."""
    density: float
    """Mean of weight/measured volume, g/cm³."""
    density_deviation: float
    """Standard deviation of it, n − 1, g/cm³."""
    area_by_weight: OriginFit
    """α₀, cm²/g^(2/3)"""
    area_by_volume: OriginFit
    """β₀, dimensionless"""


@dataclass(frozen=True, slots=True)
class Regression:
    """A whole table's statistics."""

    specimens: tuple[Specimen, ...]
    groups: tuple[GroupStatistics, ...]

    def members(self, group: str) -> tuple[Specimen, ...]:
        """Return the specimens of `group` in the table's order."""
        return tuple(specimen for specimen in self.specimens if specimen.group == group)

    def as_json(self) -> dict[str, Any]:
        """Return everything in JSON's types, ready for `json.dump`."""
        samples = [
            {**asdict(x), "relative_error": x.relative_error, "density": x.density} for x in self.specimens
        ]
        groups = [asdict(group) for group in self.groups]
        return {"schema": SCHEMA, "units": dict(_UNITS), "groups": groups, "samples": samples}


def regress(path: Path) -> Regression:
    """Return the statistics of the table at `path` (`stackloft.studies.specimen_table`).

    Raises
    ------
    InputError
        The table is wrong somewhere; row and column are named.
    """
    return regression_of(read_table(path))


def regression_of(specimens: Sequence[Specimen]) -> Regression:
    """Return the statistics of specimens, groups in the order in which they first appear.

    Examples
    --------
    >>> cubes = (27.0, 64.0, 125.0)
    >>> rows = [Specimen(str(v), "cubes", 1.1 * v, v, 0.99 * v, 6 * v ** (2 / 3)) for v in cubes]
    >>> group, = regression_of(rows).groups
    >>> round(group.mean_relative_error, 9), round(group.area_by_volume.coefficient, 9)
    (-1.0, 6.0)
    """
    names = dict.fromkeys(specimen.group for specimen in specimens)
    groups = (_statistics(name, [x for x in specimens if x.group == name]) for name in names)
    return Regression(tuple(specimens), tuple(groups))


def _statistics(name: str, rows: Sequence[Specimen]) -> GroupStatistics:
    weight = np.array([row.weight for row in rows])
    measured = np.array([row.volume_measured for row in rows])
    estimated = np.array([row.volume_estimated for row in rows])
    area = np.array([row.area_estimated for row in rows])
    errors = np.array([row.relative_error for row in rows])
    density = weight / measured
    return GroupStatistics(
        name,
        len(rows),
        float(errors.mean()),
        float(np.abs(errors).mean()),
        _correlation(measured, estimated),
        float(density.mean()),
        float(density.std(ddof=1)),
        fit_through_origin(weight**EXPONENT, area),
        fit_through_origin(measured**EXPONENT, area),
    )


def _correlation(x: FloatArray, y: FloatArray) -> float | None:
    """Return Pearson's r, None when x or y does not vary beyond rounding."""
    a, b = x - x.mean(), y - y.mean()
    if np.abs(a).max() <= 1e-12 * np.abs(x).max() or np.abs(b).max() <= 1e-12 * np.abs(y).max():
        return None
    return float(a @ b / np.sqrt((a @ a) * (b @ b)))
