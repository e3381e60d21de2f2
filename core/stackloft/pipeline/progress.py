"""How a run tells what it is doing."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """Told about each stage of a run, always from the calling thread."""

    def begin(self, stage: str, total: int | None) -> None:
        """Start `stage` (``read``, ``sections``, ``loft``, …) of `total` steps, None when not known."""
        ...

    def advance(self, steps: int = 1) -> None:
        """Tell that `steps` of the current stage are done."""
        ...

    def end(self) -> None:
        """Tell that the current stage is over."""
        ...


class Silence:
    """A `Progress` that tells nobody."""

    def begin(self, stage: str, total: int | None) -> None:
        """Ignore it."""

    def advance(self, steps: int = 1) -> None:
        """Ignore it."""

    def end(self) -> None:
        """Ignore it."""
