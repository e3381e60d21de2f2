"""CSV as bytes: a header and rows, numbers written so that they read back to the bit."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any, BinaryIO


def write_rows(header: Sequence[str], rows: Iterable[Sequence[Any]], stream: BinaryIO) -> None:
    r"""Write `header` and `rows` as UTF-8 CSV; None is an empty cell.

    Examples
    --------
    >>> write_rows(["a", "b"], [[0.1, None]], stream := io.BytesIO())
    >>> stream.getvalue()
    b'a,b\n0.1,\n'
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([_plain(value) for value in row] for row in rows)
    stream.write(text.getvalue().encode())


def _plain(value: Any) -> Any:
    return repr(float(value)) if isinstance(value, float) else value
