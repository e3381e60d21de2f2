"""Bodies whose sections are more than one loop: rings, holes, cavities, limbs, pieces; and their poses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from stackloft.testing.phantoms.catalogue import make
from stackloft.testing.phantoms.phantom import Phantom

_OFFSET = (31.7, -112.2, 57.3)
Turn = tuple[float, float, float] | int | None


class Topology(NamedTuple):
    """A body, how it lies, and what Euler knows of it."""

    name: str
    """Of the catalogue."""
    body: dict[str, Any]
    """Its parameters."""
    poses: dict[str, Turn]
    """Pose name to rotation, as `stackloft.testing.phantoms.make` takes it."""
    euler: int
    """Euler characteristic of its boundary: 2 for each closed sheet, less 2 for each handle."""

    def phantoms(self) -> Iterator[tuple[str, Phantom]]:
        """Yield (label, phantom) for every pose, well away from the origin."""
        for pose, rotation in self.poses.items():
            label = f"{self.name} {pose}"
            yield label, make(self.name, rotation=rotation, offset=_OFFSET, **self.body)


TOPOLOGY = (
    Topology("torus", {}, {"flat": None, "upright": (90, 0, 0), "leaning": (35, 20, 0)}, 0),
    Topology("tube", {}, {"upright": None, "lying": (90, 0, 0), "leaning": (25, 30, 0)}, 0),
    Topology("blind-hole", {}, {"upright": None, "upside down": (180, 0, 0), "leaning": (25, 30, 0)}, 2),
    Topology("hollow-sphere", {}, {"as made": None, "in pose 1": 1}, 4),
    Topology("two-cavities", {}, {"as made": None, "in pose 2": 2}, 6),
    Topology("dumbbell", {"tilt": 0.0}, {"upright": None, "lying": (90, 0, 0), "leaning": (60, 25, 0)}, 2),
    Topology("y-branch", {}, {"upright": None, "upside down": (180, 0, 0), "leaning": (20, 15, 0)}, 2),
    Topology("y-branch", {"mirror": 1}, {"mirrored": None, "mirrored, leaning": (20, -15, 0)}, 2),
    Topology(
        "apple", {"stem": 0.3, "calyx": 0.25}, {"square to its core": (90, 0, 0), "askew": (70, 15, 0)}, 2
    ),
    Topology("walnut", {}, {"as made": None, "in pose 3": 3}, 4),
    Topology(
        "horseshoe", {}, {"upright": None, "upside down": (180, 0, 0), "lying": (90, 0, 0), "askew": 5}, 2
    ),
    Topology("coil", {}, {"upright": None, "lying": (90, 0, 0), "leaning": (20, 10, 0)}, 2),
    Topology("ring-branch", {}, {"flat": None, "upright": (0, -90, 0), "leaning": (40, -30, 0)}, 0),
    Topology("two-bodies", {}, {"as made": None, "in pose 4": 4}, 4),
)
"""What every method, writer and picture is tried on beside the solid bodies."""
