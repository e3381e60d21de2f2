"""Tables of numbers as lines of text that read back to the same bits."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray


def rows(table: NDArray[Any], start: str = "", joint: str = " ", first: int | None = None) -> str:
    r"""Return a line per row, each number in its shortest text that reads back to the same.

    Parameters
    ----------
    table : (n, k) array
    start : str
        What each line begins with.
    joint : str
        What stands between numbers.
    first : int, optional
        Lines are numbered from here on.

    Examples
    --------
    >>> import numpy as np
    >>> rows(np.array([[0.1, 2.0], [3.0, 1e-20]]), first=7)
    '7 0.1 2.0\n8 3.0 1e-20\n'
    """
    lines = (joint.join(map(repr, row)) for row in table.tolist())
    if first is None:
        return "".join(f"{start}{line}\n" for line in lines)
    return "".join(f"{start}{number}{joint}{line}\n" for number, line in enumerate(lines, first))
