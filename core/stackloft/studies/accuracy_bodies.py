"""The bodies of the accuracy study: phantoms with exact answers, and what a person would tell of each.

All are cut at mid-thickness, so that every method sees the same sections. Where the end cannot be told from
areas (a blunt, a plane or a curved end), it is told how the body ends and how far beyond the outermost
section; of a body in another pose the height is told, as a calliper gives it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import UsageError
from stackloft.model.slice_stack import Hints
from stackloft.registry import nearest
from stackloft.testing import phantoms
from stackloft.testing.phantoms import Phantom


@dataclass(frozen=True, slots=True)
class AccuracyBody:
    """One body in its own pose."""

    label: str
    phantom: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    told: bool = False
    """Whether it is told how and where the body ends."""
    pose: int | None = None
    """Seed of a random pose."""

    def make(self) -> Phantom:
        """Return the body, moved away from the origin."""
        return phantoms.make(self.phantom, rotation=self.pose, offset=(12.3, -31.7, 118.9), **self.parameters)

    def hints(self, phantom: Phantom, positions: FloatArray, *, posed: bool = False) -> Hints:
        """Return what is told of `phantom` to those who see it at `positions`.

        Parameters
        ----------
        phantom : Phantom
        positions : (m,) array
            mm
        posed : bool
            Whether it was turned away from its own pose: then the height alone is told.
        """
        if posed:
            return Hints(specimen=self.label, height=phantom.height)
        if not self.told:
            return Hints(specimen=self.label)
        low, high = phantom.extent()
        reach = (float(positions[0]) - low, high - float(positions[-1]))
        first, last = (_end(kind, length) for kind, length in zip(phantom.end_kinds, reach, strict=True))
        return Hints(specimen=self.label, ends=(first, last))

    @property
    def ellipsoid(self) -> bool:
        """Whether Cavalieri's error is known beforehand."""
        return self.phantom == "ellipsoid"

    @property
    def ending(self) -> str:
        """How it ends along z in its own pose: ``face``, ``round``, ``point``, or several with a slash."""
        return "/".join(dict.fromkeys(self.make().end_kinds))


def _end(kind: str, length: float) -> End:
    return End({"face": EndKind.FLAT, "point": EndKind.POINT}.get(kind, EndKind.ROUND), length)


def _bodies() -> Iterator[AccuracyBody]:
    yield AccuracyBody("ellipsoid", "ellipsoid")
    yield AccuracyBody("ellipsoid, pose 1", "ellipsoid", pose=1)
    yield AccuracyBody("ellipsoid 1:0.4:0.3, pose 3", "ellipsoid", {"a": 40, "b": 16, "c": 12}, pose=3)
    yield AccuracyBody("ellipsoid 1:1:0.5", "ellipsoid", {"a": 30, "b": 30, "c": 15})
    for seed in range(4):
        yield AccuracyBody(f"potato {seed}", "potato", {"seed": seed})
    yield AccuracyBody("potato 4, pose 6", "potato", {"seed": 4}, pose=6)
    yield AccuracyBody("apple", "apple")
    yield AccuracyBody("flat apple", "apple", {"diameter": 70, "flatness": 0.8})
    for p, n in ((2, 2.5), (2, 4), (2.5, 2), (3, 2.5), (3, 4), (4, 2)):
        told = p > 2
        yield AccuracyBody(f"superellipsoid p{p:g} n{n:g}", "superellipsoid", {"p": p, "n": n}, told=told)
    yield AccuracyBody("double cone", "double-cone")
    yield AccuracyBody("cone", "cone", told=True)
    yield AccuracyBody("banana", "banana", told=True)
    yield AccuracyBody("box", "box", told=True)
    yield AccuracyBody("prism", "prism", told=True)
    yield AccuracyBody("cylinder", "cylinder", told=True)
    yield AccuracyBody("frustum", "frustum", told=True)
    yield AccuracyBody("twisted bar", "twisted-bar", told=True)
    yield AccuracyBody("meat", "meat", told=True)
    yield AccuracyBody("two-lobed", "two-lobed")
    yield AccuracyBody("dumbbell", "dumbbell")


BODIES = tuple(_bodies())


def bodies_named(labels: tuple[str, ...]) -> tuple[AccuracyBody, ...]:
    """Return the bodies with one of `labels`, or made from a phantom of that name; all when none is given.

    Raises
    ------
    UsageError
        A label that no body has, with the nearest one.

    Examples
    --------
    >>> [body.label for body in bodies_named(("box", "apple"))]
    ['apple', 'flat apple', 'box']
    """
    known = [name for body in BODIES for name in (body.label, body.phantom)]
    for label in labels:
        if label not in known:
            hint = nearest(label, list(dict.fromkeys(known)))
            raise UsageError(f"no body {label!r} in the study", where="--body", fix=hint)
    return tuple(body for body in BODIES if not labels or {body.label, body.phantom} & set(labels))


def phase(label: str, number: float) -> tuple[float, float]:
    """Return where the pixel grid lies under a body, two fractions of a pixel, the same in every run.

    Examples
    --------
    >>> phase("box", 20) == phase("box", 20) != phase("box", 21)
    True
    """
    seed = [int.from_bytes(label.encode()[:8].ljust(8), "little"), len(label), round(1000 * number)]
    x, y = np.random.default_rng(seed).uniform(size=2)
    return float(x), float(y)
