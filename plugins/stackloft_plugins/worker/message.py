"""Arrays and plain values as one run of bytes, and back."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

_VALUES = "__values__"


def pack(arrays: Mapping[str, NDArray[Any]], values: Any = None) -> bytes:
    """Return named arrays and one JSON value as bytes (NumPy's ``.npz``, nothing pickled).

    Examples
    --------
    >>> arrays, values = unpack(pack({"points": np.eye(2)}, {"fine": True}))
    >>> arrays["points"].shape, values
    ((2, 2), {'fine': True})
    """
    stream = io.BytesIO()
    text = np.frombuffer(json.dumps(values).encode(), dtype=np.uint8)
    named: dict[str, Any] = {_VALUES: text, **arrays}
    np.savez(stream, **named)
    return stream.getvalue()


def unpack(content: bytes) -> tuple[dict[str, NDArray[Any]], Any]:
    """Return what `pack` was given.

    Raises
    ------
    ValueError
        Not such bytes, or not all of them.
    """
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return arrays, json.loads(arrays.pop(_VALUES).tobytes())
    except Exception as error:  # zipfile, zlib, numpy and json each raise their own
        raise ValueError(f"not a message: {error}") from error
