"""Where an element of a frame is found: its own functional group, the shared one, or the file itself."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from stackloft.model.arrays import FloatArray

if TYPE_CHECKING:
    from pydicom import Dataset

    from stackloft_plugins.readers.dicom_plain import PlainHeader


class Lookup:
    """Finds an element in a frame's own group, then the shared one, then the file."""

    def __init__(self, data: Dataset | PlainHeader, groups: tuple[Dataset, ...]) -> None:
        self._data = data
        self._groups = groups

    def get(self, sequence: str, keyword: str) -> Any:
        """Return the element's value, None where there is none; no `sequence`: the file's own."""
        for holder in self._holders(sequence):
            value = holder.get(keyword)
            if value is not None and value != "":
                return value
        return None

    def floats(self, sequence: str, keyword: str, count: int) -> FloatArray | None:
        """Return the element's `count` finite numbers, None where there is none."""
        value = self.get(sequence, keyword)
        if value is None:
            return None
        numbers = np.array(value, dtype=np.float64).reshape(-1)
        if numbers.shape != (count,) or not all(map(math.isfinite, numbers.tolist())):
            message = f"{keyword} is no {count} finite numbers"
            raise ValueError(message)
        return numbers

    def _holders(self, sequence: str) -> Iterator[Dataset | PlainHeader]:
        for group in self._groups if sequence else ():
            items = group.get(sequence)
            if items:
                yield items[0]
        yield self._data
