"""How far off a loft's figures may be because an end's position was guessed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.model.bias import Bias
from stackloft.model.measurement import EndReport

_GUESSED = "where the body ends was guessed: give --height or --ends"


def guess_biases(
    ends: Sequence[EndReport], volume: float, area: float
) -> tuple[Bias, Bias] | tuple[None, None]:
    """Return the biases of volume and area that guessed ends allow; None when no end was guessed.

    Parameters
    ----------
    ends : sequence of EndReport
    volume, area : float
        The body's, mm³ and mm².

    Examples
    --------
    >>> guess_biases([EndReport("face", 0.0, "told")], 10.0, 20.0)
    (None, None)
    >>> guess_biases([EndReport("round", 2.0, "areas", True, 0.5, 0.2)], 10.0, 20.0)[0].high
    6.0
    """
    effects = [(end.volume_effect or 0.0, end.area_effect or 0.0) for end in ends if end.guessed]
    if not effects:
        return None, None
    off = 1.0 + 100.0 * np.sum(effects, axis=0) / [volume, area]
    return Bias(-float(off[0]), float(off[0]), _GUESSED), Bias(-float(off[1]), float(off[1]), _GUESSED)
