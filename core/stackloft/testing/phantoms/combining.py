"""Bodies made of bodies: moved, hollowed, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from stackloft.testing.phantoms.body import Body, Field, Patch
from stackloft.testing.phantoms.dual import Array


def moved(body: Body, offset: ArrayLike) -> Body:
    """Return the body moved by `offset` (3) mm in its own frame.

    Examples
    --------
    >>> from stackloft.testing.phantoms.ellipsoids import ellipsoid
    >>> float(moved(ellipsoid(2, 2, 2), (5, 0, 0)).fields[0](np.array([[7.0], [0], [0]]))[0])
    0.0
    """
    shift = np.asarray(offset, dtype=float)[:, None]

    def field(inner: Field) -> Field:
        return lambda X: inner(X - shift)

    def patch(inner: Patch) -> Patch:
        return replace(inner, surface=lambda u, v: inner.surface(u, v) + shift)

    return replace(
        body,
        fields=tuple(field(one) for one in body.fields),
        patches=tuple(patch(one) for one in body.patches),
        tips=body.tips + shift[:, 0],
    )


def turned_over(patch: Patch) -> Patch:
    """Return the patch with its outward side turned inward: u and v change places."""
    return Patch(lambda u, v: patch.surface(v, u), patch.v, patch.u, patch.rules[::-1])


def hollowed(body: Body, *cavities: Body, parameters: Mapping[str, float]) -> Body:
    """Return the body less cavities of one field each, which lie inside it and do not touch.

    Volumes subtract, areas add.

    Examples
    --------
    >>> from stackloft.testing.phantoms.ellipsoids import ellipsoid
    >>> shell = hollowed(ellipsoid(3, 3, 3), ellipsoid(1, 1, 1), parameters={})
    >>> round(shell.volume / np.pi * 3 / 4, 9), round(shell.area / np.pi / 4, 9)
    (26.0, 10.0)
    """

    def outside(field: Field) -> Field:
        def value(X: Array) -> Array:
            found: Array = -field(X)
            return found

        return value

    inner = [patch for cavity in cavities for patch in cavity.patches]
    return Body(
        fields=body.fields + tuple(outside(cavity.fields[0]) for cavity in cavities),
        patches=body.patches + tuple(turned_over(patch) for patch in inner),
        volume=body.volume - sum(cavity.volume for cavity in cavities),
        area=body.area + sum(cavity.area for cavity in cavities),
        tips=body.tips,
        parameters=parameters,
        detail=181,
    )


def together(*bodies: Body, parameters: Mapping[str, float]) -> Body:
    """Return bodies that do not touch as one; volumes and areas add.

    Examples
    --------
    >>> from stackloft.testing.phantoms.ellipsoids import ellipsoid
    >>> ball = ellipsoid(1, 1, 1)
    >>> pair = together(ball, moved(ball, (3, 0, 0)), parameters={})
    >>> pair.parts, round(pair.area / np.pi, 9)
    (((0,), (1,)), 8.0)
    """
    counts = np.cumsum([0] + [len(body.fields) for body in bodies])
    return Body(
        fields=tuple(field for body in bodies for field in body.fields),
        patches=tuple(patch for body in bodies for patch in body.patches),
        volume=sum(body.volume for body in bodies),
        area=sum(body.area for body in bodies),
        tips=np.concatenate([body.tips for body in bodies]),
        parameters=parameters,
        parts=tuple(tuple(range(a, b)) for a, b in pairwise(counts.tolist())),
        detail=241,
    )
