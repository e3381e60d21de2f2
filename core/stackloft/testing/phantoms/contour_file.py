"""Sections as exact loops in a CSV file: ``section,z,loop,x,y,corner``, millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stackloft.model.arrays import frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.answer import answer, stack_toml
from stackloft.testing.phantoms.files import made_folder, write_json, write_whole
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.placing import Placing

HEADER = "section,z,loop,x,y,corner"


@dataclass(frozen=True, slots=True)
class Contours:
    """How a phantom's exact sections are written.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> files = Contours(sections=3).write(phantoms.make("box"), Path(tempfile.mkdtemp()))
    >>> [file.name for file in files]
    ['contours.csv', 'stack.toml', 'answer.json']
    >>> files[0].read_text().splitlines()[2]
    '1,-26.666666666666664,1,-30.0,-20.0,1'
    """

    sections: int = 11
    placing: Placing | tuple[float, ...] = "mid"
    points: int = 400
    """About how many points a loop gets."""
    shuffle: int | None = None
    """A seed: every loop starts anywhere and runs either way round; None: as `Phantom.section` gives it."""
    tell: tuple[str, ...] = ("specimen",)
    """Keys of ``stack.toml`` beside the file; none: no such file."""

    def write(self, phantom: Phantom, target: Path) -> list[Path]:
        """Write ``contours.csv``, ``stack.toml`` and ``answer.json`` into the folder `target`, or, where its
        suffix is ``.csv``, that file alone; return the files.

        Raises
        ------
        UsageError
            An option that does not suit the body.
        OutputError
            The system refuses; no half-written file is left.
        """  # noqa: D205
        stack = phantom.contour_stack(self.sections, self.placing, self.points)
        content = contour_csv(stack, phantom.name, self.shuffle).encode()
        if target.suffix.lower() == ".csv":
            made_folder(target.parent)
            return [write_whole(target, content)]
        if "pixel_size" in self.tell:
            raise UsageError("exact contours have no pixel size", where="tell", found="pixel_size")
        toml = stack_toml(phantom, stack.positions, self.tell, {})
        made_folder(target)
        files = [write_whole(target / "contours.csv", content)]
        if toml:
            files.append(write_whole(target / "stack.toml", toml.encode()))
        files.append(write_json(target / "answer.json", answer(phantom, stack.positions)))
        return files


def contour_csv(stack: ContourStack, name: str, shuffle: int | None = None) -> str:
    """Return the stack as CSV text; numbers are written so that they read back to the bit."""
    rng = None if shuffle is None else np.random.default_rng(shuffle)
    lines = [f"# {name}, exact sections, mm", HEADER]
    for i, section in enumerate(stack.sections, start=1):
        for k, loop in enumerate(section.loops, start=1):
            given = loop if rng is None else _restarted(loop, rng)
            corners = set(given.corners.tolist())
            lines += [
                f"{i},{section.z!r},{k},{x!r},{y!r},{int(j in corners)}"
                for j, (x, y) in enumerate(given.points.tolist())
            ]
    return "\n".join(lines) + "\n"


def _restarted(loop: Loop, rng: np.random.Generator) -> Loop:
    """Return the loop from a random start, in a random direction."""
    k = len(loop.points)
    order = np.roll(np.arange(k), -int(rng.integers(k)))[:: int(rng.choice([1, -1]))]
    place = np.empty(k, dtype=int)
    place[order] = np.arange(k)
    return Loop(loop.points[order], frozen_ints(np.sort(place[loop.corners])), loop.hole)
