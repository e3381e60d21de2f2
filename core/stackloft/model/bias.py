"""What is known about a method's error."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Bias:
    """Where a method's figure may lie, relative to the truth.

    Examples
    --------
    >>> Bias(0.0, 25.0, "stair-stepped").truths(125.0)
    (100.0, 125.0)
    """

    low: float
    """%: the least error that is to be expected, negative where the method errs low."""
    high: float
    """%: the greatest."""
    reason: str
    """Why; and what is the likely reason when the figure lies outside nevertheless."""

    def truths(self, figure: float) -> tuple[float, float]:
        """Return the least and the greatest true value that `figure` is compatible with."""
        return figure / (1.0 + self.high / 100.0), figure / (1.0 + self.low / 100.0)
