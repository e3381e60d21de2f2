"""The phantoms by name."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from difflib import get_close_matches
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stackloft.model.arrays import frozen_floats
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms import ellipsoids, polyhedra, round_solids
from stackloft.testing.phantoms.apple import apple
from stackloft.testing.phantoms.banana import banana
from stackloft.testing.phantoms.body import Body
from stackloft.testing.phantoms.coil import coil
from stackloft.testing.phantoms.drilled import blind_hole, tube
from stackloft.testing.phantoms.hollow import hollow_sphere, two_cavities, walnut
from stackloft.testing.phantoms.limbs import horseshoe, y_branch
from stackloft.testing.phantoms.meat import meat
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.phantoms.potato import potato
from stackloft.testing.phantoms.rings import ring_with_branch, torus
from stackloft.testing.phantoms.twisted_bar import twisted_bar
from stackloft.testing.phantoms.two_bodies import two_bodies
from stackloft.testing.phantoms.two_lobed import dumbbell, two_lobed

SOLID: dict[str, Callable[..., Body]] = {
    "apple": apple,
    "banana": banana,
    "box": polyhedra.box,
    "cone": round_solids.cone,
    "cylinder": round_solids.cylinder,
    "double-cone": ellipsoids.double_cone,
    "dumbbell": dumbbell,
    "ellipsoid": ellipsoids.ellipsoid,
    "frustum": round_solids.frustum,
    "meat": meat,
    "potato": potato,
    "prism": polyhedra.prism,
    "superellipsoid": ellipsoids.superellipsoid,
    "twisted-bar": twisted_bar,
    "two-lobed": two_lobed,
}
"""Bodies of which, in their own frame, every section across z is one loop without a hole."""
BODIES: dict[str, Callable[..., Body]] = SOLID | {
    "blind-hole": blind_hole,
    "coil": coil,
    "hollow-sphere": hollow_sphere,
    "horseshoe": horseshoe,
    "ring-branch": ring_with_branch,
    "torus": torus,
    "tube": tube,
    "two-bodies": two_bodies,
    "two-cavities": two_cavities,
    "walnut": walnut,
    "y-branch": y_branch,
}
"""Name to the function that makes the body; the function's keywords are the phantom's parameters."""
NAMES = tuple(BODIES)


def make(
    name: str,
    *,
    rotation: ArrayLike | int | None = None,
    offset: ArrayLike = (0.0, 0.0, 0.0),
    **parameters: Any,
) -> Phantom:
    """Return the phantom called `name`.

    Parameters
    ----------
    name : str
        One of `NAMES`.
    rotation : (3, 3) matrix, three Euler angles in degrees, seed, or None
        The pose's turn (about x, then y, then z); None: the body's own frame.
    offset : (3)
        The pose's shift, mm.
    **parameters
        The body's own: sizes in mm, exponents, seed; see each body's docstring.

    Raises
    ------
    UsageError
        Unknown name (the nearest one is suggested), unknown or impossible parameter.

    Examples
    --------
    >>> make("box", a=10, b=20, c=30, rotation=(0, 0, 45), offset=(3, -7, 11)).volume
    6000
    >>> make("potatoe")
    Traceback (most recent call last):
    stackloft.model.errors.UsageError: potatoe: no such phantom; fix: did you mean potato?
    """
    build = body_maker(name)
    known = inspect.signature(build).parameters
    for key in parameters:
        if key not in known:
            raise UsageError("unknown parameter", where=name, found=key, expected=", ".join(known) or "none")
    place = np.asarray(offset, dtype=float)
    if place.shape != (3,) or not np.isfinite(place).all():
        raise UsageError("not an offset", where="offset", found=str(offset), expected="three lengths in mm")
    return Phantom(name, build(**parameters), frozen_floats(rotation_matrix(rotation)), frozen_floats(place))


def body_maker(name: str) -> Callable[..., Body]:
    """Return the function that makes the body called `name`, or raise UsageError with the nearest name."""
    wanted = name.strip().lower().replace("_", "-")
    if wanted not in BODIES:
        near = get_close_matches(wanted, BODIES, n=1, cutoff=0.5)
        fix = f"did you mean {near[0]}?" if near else f"one of {', '.join(NAMES)}"
        raise UsageError("no such phantom", where=name, fix=fix)
    return BODIES[wanted]
