"""How well the pixel size of slices is known."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.errors import InputError


@dataclass(frozen=True, slots=True, eq=False)
class ScaleUncertainty:
    """Relative standard uncertainty of the pixel size.

    The part common to all slices (the reference object's own size, where its edge is seen) scales the
    body in its section planes, so that the volume moves by twice as much. The parts of the slices are
    independent of each other.

    Examples
    --------
    >>> ScaleUncertainty(0.002, np.array([0.001, 0.001])).each.tolist()
    [0.001, 0.001]
    """

    common: float
    """Relative, the same error in every slice."""
    each: FloatArray
    """(m) relative, independent from slice to slice."""
    source: str = ""
    """Where it comes from, for people."""
    isotropic: bool = False
    """Whether the common part scales the body along the axis too, as a scanner's calibration does; the volume
    then moves by three times as much."""

    def __post_init__(self) -> None:
        values = np.append(self.each, self.common)
        if not (np.isfinite(values).all() and (values >= 0).all()):
            raise InputError("a scale's uncertainty is finite and not negative", found=str(values.min()))


def scale_of_slices(scale: ScaleUncertainty | None, numbers: IntArray) -> ScaleUncertainty | None:
    """Return the uncertainty of the slices with these numbers alone.

    Examples
    --------
    >>> scale_of_slices(ScaleUncertainty(0.01, np.array([0.1, 0.2, 0.3])), np.array([2])).each.tolist()
    [0.3]
    """
    return None if scale is None else replace(scale, each=scale.each[numbers])
