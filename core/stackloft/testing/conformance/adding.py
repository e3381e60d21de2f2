"""Two bodies in one product, to see whether their figures are the sums of those of each alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import singledispatch
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import StackloftError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance.check import must
from stackloft.testing.conformance.moving import transformed

_SMALLER = 0.7
_APART = 1.5
"""Body lengths from one body's middle to the other's."""


def must_add_up(body: Any, figures: Callable[[Any], tuple[float | None, float | None]], slack: float) -> None:
    """Check that volume and area of two bodies in one product are the sums of each one's.

    Refusing two bodies is no fault; measuring only one of them is.

    Parameters
    ----------
    body : Segmentation, ContourStack, LoftedSolid, TriMesh or TetMesh
        One body.
    figures : callable
        From a product to its volume and area.
    slack : float
        Relative difference allowed.
    """
    other = another(body)
    try:
        together = figures(beside(body, other))
    except StackloftError:
        return
    for name, one, two, both in zip(("volume", "area"), figures(body), figures(other), together, strict=True):
        if one is not None and two is not None and both is not None:
            change = both / (one + two) - 1.0
            told = f"two bodies in one {type(body).__name__} have {1.0 + change:.4g} times"
            must(abs(change) <= slack, f"{told} the sum of their {name}s")


def another(product: Any) -> Any:
    """Return a second body for `beside`, smaller where the product can hold one of another size."""
    if isinstance(product, Segmentation):
        return _seen(product, lambda picture: picture[:, ::-1])
    points = _points(product)
    shift = np.array([_APART * np.ptp(points[:, 0]) + (1.0 - _SMALLER) * points[:, 0].mean(), 0.0, 0.0])
    height = 1.0 if isinstance(product, ContourStack) else _SMALLER
    return transformed(product, np.diag([_SMALLER, _SMALLER, height]), shift)


@singledispatch
def beside(product: Any, other: Any) -> Any:
    """Return one product that holds both bodies; they must not meet."""
    message = f"no way to lay a {type(other).__name__} beside a {type(product).__name__}"
    raise NotImplementedError(message)


@beside.register
def _(product: ContourStack, other: ContourStack) -> ContourStack:
    pairs = zip(product.sections, other.sections, strict=True)
    return replace(product, sections=tuple(replace(a, loops=a.loops + b.loops) for a, b in pairs))


@beside.register
def _(product: LoftedSolid, other: LoftedSolid) -> LoftedSolid:
    return replace(product, shells=product.shells + other.shells)


@beside.register
def _(product: TriMesh, other: TriMesh) -> TriMesh:
    vertices = np.concatenate([product.vertices, other.vertices])
    faces = np.concatenate([product.faces, other.faces + len(product.vertices)])
    return replace(product, vertices=frozen_floats(vertices), faces=frozen_ints(faces))


@beside.register
def _(product: TetMesh, other: TetMesh) -> TetMesh:
    first = len(product.nodes)
    return replace(
        product,
        nodes=frozen_floats(np.concatenate([product.nodes, other.nodes])),
        elements=frozen_ints(np.concatenate([product.elements, other.elements + first])),
        faces=frozen_ints(np.concatenate([product.faces, other.faces + first])),
        groups=frozen_ints(np.concatenate([product.groups, other.groups])),
    )


@beside.register
def _(product: Segmentation, other: Segmentation) -> Segmentation:
    rows, columns = product.stack.shape

    def decode(k: int) -> Picture:
        return np.concatenate([product.stack.decode(k), other.stack.decode(k)], axis=1)

    return replace(product, stack=replace(product.stack, decode=decode, shape=(rows, 2 * columns)))


def _seen(product: Segmentation, change: Callable[[Picture], Picture]) -> Segmentation:
    decode = product.stack.decode
    return replace(product, stack=replace(product.stack, decode=lambda k: change(decode(k))))


def _points(product: Any) -> FloatArray:
    if isinstance(product, ContourStack):
        return np.concatenate([loop.points for section in product.sections for loop in section.loops])
    if isinstance(product, LoftedSolid):
        return np.concatenate([shell.patches.reshape(-1, 3) for shell in product.shells])
    return np.asarray(product.vertices if isinstance(product, TriMesh) else product.nodes)
