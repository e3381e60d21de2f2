"""How a section's loops are numbered for people, and the links that ``stack.toml`` fixes by these numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError

Links = tuple[tuple[int, int], ...]


def by_size(polygons: Sequence[FloatArray]) -> list[int]:
    """Return the loops in the order of their numbers: the largest is number 1.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> by_size([square, 3 * square, -2 * square])
    [1, 2, 0]
    """
    sizes = np.array([abs(polygon_area(polygon)) for polygon in polygons])
    return [int(k) for k in np.argsort(-sizes, kind="stable")]


def said_links(slices: Mapping[int, Mapping[str, Any]], names: Sequence[str]) -> dict[str, Links]:
    """Return the links that overrides by slice number (from 1) fix, by the slice's name."""
    return {
        names[number - 1]: tuple(said["links"])
        for number, said in slices.items()
        if "links" in said and number <= len(names)
    }


def numbered_links(
    links: Links, before: Sequence[FloatArray], after: Sequence[FloatArray], names: tuple[str, str]
) -> list[tuple[int, int]]:
    """Return links by number as pairs of indices into the loops of two sections, holes clockwise.

    Raises
    ------
    InputError
        A section has no loop of that number, or a hole is linked to an outline.
    """
    orders = by_size(before), by_size(after)
    for link in links:
        for number, order, name in zip(link, orders, names, strict=True):
            if number > len(order):
                raise InputError(
                    "links name a loop that is not there",
                    where=f"stack.toml, links from {names[0]} to {names[1]}",
                    found=f"loop {number} of {name}",
                    expected=f"1 to {len(order)}",
                    fix="the overview picture shows the loops' numbers, the largest first",
                )
    pairs = [(orders[0][i - 1], orders[1][j - 1]) for i, j in links]
    for (i, j), link in zip(pairs, links, strict=True):
        if (polygon_area(before[i]) < 0.0) != (polygon_area(after[j]) < 0.0):
            raise InputError(
                "links join a hole to an outline",
                where=f"stack.toml, links from {names[0]} to {names[1]}",
                found=f"{link[0]} → {link[1]}",
                fix="link holes to holes and outlines to outlines",
            )
    return pairs
