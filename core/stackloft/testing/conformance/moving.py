"""Moving, scaling, mirroring and opening products, to see what that does to their figures."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance.tet_ellipsoid import MIRROR_TET, MIRROR_TRIANGLE


@singledispatch
def transformed(product: Any, matrix: FloatArray, shift: FloatArray) -> Any:
    """Return `product` with every point P at matrix·P + shift; orientation stays outward.

    Parameters
    ----------
    product : Segmentation, ContourStack, LoftedSolid, TriMesh or TetMesh
        For a ContourStack `matrix` must keep the axis: [[a, b, 0], [c, d, 0], [0, 0, e]], e > 0.
    matrix : (3, 3) array
        A similarity.
    shift : (3,) array
        mm
    """
    message = f"no way to move a {type(product).__name__}"
    raise NotImplementedError(message)


@transformed.register
def _(product: ContourStack, matrix: FloatArray, shift: FloatArray) -> ContourStack:
    if np.any(matrix[2, :2]) or np.any(matrix[:2, 2]) or matrix[2, 2] <= 0:
        message = "a stack keeps its axis"
        raise ValueError(message)

    def moved(loop: Loop) -> Loop:
        return replace(loop, points=frozen_floats(loop.points @ matrix[:2, :2].T + shift[:2]))

    sections = tuple(
        replace(section, z=float(matrix[2, 2] * section.z + shift[2]), loops=tuple(map(moved, section.loops)))
        for section in product.sections
    )
    return replace(product, sections=sections)


@transformed.register
def _(product: LoftedSolid, matrix: FloatArray, shift: FloatArray) -> LoftedSolid:
    def moved(patches: FloatArray) -> FloatArray:
        points = patches @ matrix.T + shift
        return frozen_floats(points[:, ::-1, :, ::-1] if np.linalg.det(matrix) < 0 else points)

    shells = tuple(replace(shell, patches=moved(shell.patches)) for shell in product.shells)
    return replace(product, shells=shells)


@transformed.register
def _(product: TriMesh, matrix: FloatArray, shift: FloatArray) -> TriMesh:
    faces = product.faces[:, ::-1] if np.linalg.det(matrix) < 0 else product.faces
    return replace(
        product, vertices=frozen_floats(product.vertices @ matrix.T + shift), faces=frozen_ints(faces)
    )


@transformed.register
def _(product: TetMesh, matrix: FloatArray, shift: FloatArray) -> TetMesh:
    elements, faces = product.elements, product.faces
    if np.linalg.det(matrix) < 0:
        elements, faces = elements[:, MIRROR_TET], faces[:, MIRROR_TRIANGLE]
    nodes = frozen_floats(product.nodes @ matrix.T + shift)
    return replace(product, nodes=nodes, elements=frozen_ints(elements), faces=frozen_ints(faces))


@transformed.register
def _(product: Segmentation, matrix: FloatArray, shift: FloatArray) -> Segmentation:
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = matrix, shift
    return replace(product, stack=replace(product.stack, affine=frozen_floats(move @ product.stack.affine)))


@singledispatch
def started_elsewhere(product: Any, steps: int) -> Any:
    """Return the same product with its loops (columns, vertices) begun `steps` later."""
    message = f"no start to shift in a {type(product).__name__}"
    raise NotImplementedError(message)


@started_elsewhere.register
def _(product: ContourStack, steps: int) -> ContourStack:
    """Begin each section's loop at another vertex."""

    def rolled(loop: Loop, by: int) -> Loop:
        corners = np.sort((loop.corners - by) % len(loop.points))
        return replace(
            loop, points=frozen_floats(np.roll(loop.points, -by, axis=0)), corners=frozen_ints(corners)
        )

    sections = tuple(
        replace(section, loops=tuple(rolled(loop, steps * (k + 1)) for loop in section.loops))
        for k, section in enumerate(product.sections)
    )
    return replace(product, sections=sections)


@started_elsewhere.register
def _(product: LoftedSolid, steps: int) -> LoftedSolid:
    rolled = (replace(x, patches=frozen_floats(np.roll(x.patches, -steps, axis=1))) for x in product.shells)
    return replace(product, shells=tuple(rolled))


@started_elsewhere.register
def _(product: TriMesh, steps: int) -> TriMesh:
    count = len(product.vertices)
    vertices = frozen_floats(np.roll(product.vertices, -steps, axis=0))
    faces = np.roll(np.roll((product.faces - steps) % count, 1, axis=1), steps, axis=0)
    return replace(product, vertices=vertices, faces=frozen_ints(faces))


@started_elsewhere.register
def _(product: TetMesh, steps: int) -> TetMesh:
    count = len(product.nodes)
    return replace(
        product,
        nodes=frozen_floats(np.roll(product.nodes, -steps, axis=0)),
        elements=frozen_ints(np.roll((product.elements - steps) % count, steps, axis=0)),
        faces=frozen_ints((product.faces - steps) % count),
    )


@started_elsewhere.register
def _(product: Segmentation, steps: int) -> Segmentation:
    """Begin each slice's crop at another pixel."""

    def cropped(index: int, picture: Picture) -> SectionField:
        section = product.field_of(index, picture)
        row, column = section.offset
        return replace(section, values=section.values[steps:, steps:], offset=(row + steps, column + steps))

    return replace(product, field_of=cropped)


def turned_over(stack: ContourStack) -> ContourStack:
    """Return the stack with every loop run the other way round."""

    def reversed_loop(loop: Loop) -> Loop:
        corners = np.sort(len(loop.points) - 1 - loop.corners)
        return replace(loop, points=frozen_floats(loop.points[::-1]), corners=frozen_ints(corners))

    sections = tuple(replace(x, loops=tuple(map(reversed_loop, x.loops))) for x in stack.sections)
    return replace(stack, sections=sections)


def inside_out(product: Any) -> Any:
    """Return a solid, surface or mesh with its outside inside."""
    if isinstance(product, LoftedSolid):
        shells = tuple(replace(x, patches=frozen_floats(x.patches[:, ::-1, :, ::-1])) for x in product.shells)
        return replace(product, shells=shells)
    if isinstance(product, TetMesh):
        elements, faces = product.elements[:, MIRROR_TET], product.faces[:, MIRROR_TRIANGLE]
        return replace(product, elements=frozen_ints(elements), faces=frozen_ints(faces))
    return replace(product, faces=frozen_ints(product.faces[:, ::-1]))


def emptied(product: Any) -> Any:
    """Return the product with nothing in it."""
    if isinstance(product, ContourStack):
        return replace(product, sections=())
    if isinstance(product, LoftedSolid):
        return replace(product, shells=())
    if isinstance(product, Segmentation):
        return replace(product, field_of=lambda k, picture: _without_body(product.field_of(k, picture)))
    if isinstance(product, TetMesh):
        nothing = frozen_ints(np.empty((0, 10)))
        return replace(product, elements=nothing, faces=nothing[:, :6], groups=nothing[:, 0])
    return replace(product, vertices=frozen_floats(np.empty((0, 3))), faces=frozen_ints(np.empty((0, 3))))


def _without_body(section: SectionField) -> SectionField:
    lowest = float(section.values.min())
    return replace(section, values=frozen_floats(np.full(section.values.shape, lowest)))


def opened(product: Any) -> tuple[str, Any]:
    """Return the product with a piece missing, and what is missing."""
    if isinstance(product, LoftedSolid):
        shell = product.shells[0]
        gap = replace(shell, patches=frozen_floats(shell.patches[:, :-1]))
        return "a solid with a column of patches missing", replace(product, shells=(gap,))
    return "a surface with a triangle missing", replace(product, faces=frozen_ints(product.faces[:-1]))
