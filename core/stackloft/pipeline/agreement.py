r"""Whether the methods of one run agree, each judged by what is known of its errors.

::

    loft          |--x--|            each method's figure x, and the true values that its known bias
    cavalieri    |---x---|           allows; the truth is looked for where most of them overlap;
    frustum           x-----------|  whoever does not reach there is named
    voxel                                |--x--|   <- outlier
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from stackloft.model.bias import Bias
from stackloft.model.measurement import Integral
from stackloft.model.notices import Notice
from stackloft.pipeline.plan import Method

COVERAGE = 2.0
"""Standard uncertainties by which a figure may be off besides its bias."""


@dataclass(frozen=True, slots=True)
class Claim:
    """What one method's figure says about the truth."""

    method: str
    value: float
    low: float
    high: float
    """The true values that the figure is compatible with lie between these."""
    reason: str
    """The likely reason when they do not include the truth."""


def claim(method: str, value: float, bias: Bias, uncertainty: float | None) -> Claim:
    """Return a figure's claim.

    Examples
    --------
    >>> found = claim("loft", 100.0, Bias(0.0, 25.0, "steps"), 1.0)
    >>> found.low, found.high
    (78.0, 102.0)
    """
    low, high = bias.truths(value)
    spread = COVERAGE * (uncertainty or 0.0)
    return Claim(method, value, low - spread, high + spread, bias.reason)


def disagreements(found: Sequence[tuple[Method, Integral]]) -> tuple[Notice, ...]:
    """Return a notice for each figure that its method's known bias does not reconcile with the others.

    Parameters
    ----------
    found : sequence of (Method, Integral)
        The methods that gave figures. One about whose bias nothing is known has no say.
    """
    notices: list[Notice] = []
    for name, unit in (("volume", "mm³"), ("area", "mm²")):
        claims = [
            claim(method.name, value, bias, getattr(integral, f"{name}_uncertainty"))
            for method, integral in found
            for value in [getattr(integral, name)]
            for bias in [getattr(integral, f"{name}_bias") or getattr(method, f"{name}_bias")]
            if value is not None and bias is not None
        ]
        notices += judged(claims, name, unit)
    return tuple(notices)


def judged(claims: Sequence[Claim], name: str, unit: str) -> list[Notice]:
    """Return the notices on one quantity: the outliers by name, or that nobody can say who is wrong.

    Examples
    --------
    >>> bias = Bias(-1.0, 1.0, "a guessed end")
    >>> claims = [claim(m, v, bias, None) for m, v in (("a", 100.0), ("b", 101.0), ("c", 120.0))]
    >>> (notice,) = judged(claims, "volume", "mm³")
    >>> notice.message.partition(";")[0]
    'c: its volume, 120 mm³, is 19 % above what a and b agree on (100 to 101 mm³)'
    """
    if len(claims) < 2:
        return []
    agreeing = _largest_agreement(claims)
    low, high = max(x.low for x in agreeing), min(x.high for x in agreeing)
    outliers = [x for x in claims if x.high < low or x.low > high]
    if 2 * len(agreeing) <= len(claims):
        return [_split(claims, name, unit)]
    names = _listed([x.method for x in claims if x not in outliers])
    return [_outlier(x, low, high, names, name, unit) for x in outliers]


def _largest_agreement(claims: Sequence[Claim]) -> list[Claim]:
    """Return the claims that share a value, as many as possible; of equally many the first method's."""
    groups = [[y for y in claims if y.low <= x.low <= y.high] for x in claims]
    return max(groups, key=lambda group: (len(group), claims[0] in group))


def _outlier(x: Claim, low: float, high: float, names: str, name: str, unit: str) -> Notice:
    off = x.value / low - 1.0 if x.value < low else x.value / high - 1.0
    side = "below" if off < 0 else "above"
    return Notice(
        "method-disagrees",
        f"{x.method}: its {name}, {x.value:.4g} {unit}, is {100 * abs(off):.2g} % {side} what {names} agree"
        f" on ({low:.4g} to {high:.4g} {unit}); likely because {x.reason}",
    )


def _split(claims: Sequence[Claim], name: str, unit: str) -> Notice:
    figures = _listed([f"{x.method} {x.value:.4g}" for x in claims])
    reasons = _listed([f"for {x.method}, {x.reason}" for x in claims])
    return Notice(
        "method-disagrees",
        f"the methods differ in {name} ({figures} {unit}) by more than their known errors, and no majority"
        f" tells which is off; possible: {reasons}",
    )


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
