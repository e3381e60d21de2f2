"""Charts as PNG bytes: matplotlib without a display, without its global state, imported when one is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#1b6ca8", "#c8442b", "#3b8a3e", "#8a5a9e", "#c98a1b", "#4d4d4d", "#1aa6a6", "#a83268")
"""Told apart in print and by most colour-blind eyes; markers differ as well."""
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DPI = 130


@contextmanager
def chart(
    stream: BinaryIO, *, columns: int = 1, rows: int = 1, size: tuple[float, float] = (6.4, 4.6)
) -> Iterator[tuple[Figure, list[Axes]]]:
    """Give a figure and its axes, row by row, to draw on; it is written to `stream` as PNG at the end.

    Parameters
    ----------
    stream : binary file
    columns, rows : int
        Axes side by side and below each other.
    size : tuple
        Width and height of the whole, inches.

    Examples
    --------
    >>> import io
    >>> with chart(png := io.BytesIO()) as (_, (axes,)):
    ...     _ = axes.plot([1, 2], [3, 4])
    >>> png.getvalue()[1:4]
    b'PNG'
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - takes 0.3 s
    from matplotlib.figure import Figure as NewFigure  # noqa: PLC0415

    figure = NewFigure(figsize=size, dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, columns, squeeze=False)
    axes: list[Axes] = list(grid.ravel())
    for one in axes:
        one.grid(visible=True, alpha=0.25, linewidth=0.6)
        one.spines[["top", "right"]].set_visible(False)
    yield figure, axes
    figure.savefig(stream, format="png")


def as_label(text: str) -> str:
    r"""Return a person's own words as matplotlib shows them: no formula, and never hidden from a legend.

    Examples
    --------
    >>> as_label("_2$ apples")
    ' _2\\$ apples'
    """
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown
