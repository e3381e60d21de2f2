"""Two bodies in one stack."""

from __future__ import annotations

from stackloft.testing.phantoms.body import Body
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.combining import moved, together
from stackloft.testing.phantoms.ellipsoids import ellipsoid
from stackloft.testing.phantoms.potato import potato


def two_bodies(gap: float = 9.0, seed: int = 4) -> Body:
    """Return a potato and a smaller ellipsoid beside it and higher up, about `gap` mm apart.

    Together they are the answer: V and S are sums.

    Examples
    --------
    >>> pair = two_bodies()
    >>> round(pair.volume - potato(radius=24, seed=4).volume - ellipsoid(17, 20, 22).volume, 6)
    0.0
    """
    positive(gap=gap)
    within(4, 60, gap=gap)
    half = gap / 2
    return together(
        moved(potato(radius=24.0, seed=seed), (-26.0 - half, 0.0, -4.0)),
        moved(ellipsoid(17.0, 20.0, 22.0), (17.0 + half, 3.0, 11.0)),
        parameters={"gap": gap, "seed": seed},
    )
