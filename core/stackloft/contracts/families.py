"""One Protocol per plug-in family, and the families' names.

A plug-in is a frozen dataclass whose fields are its options (see `stackloft.contracts.options`).
Every family shares three class variables:

``api``
    Version of this contract, ``"1"``. Another major version is refused.
``accepts``
    The product types it takes (``Path`` for readers).
``produces``
    The product types it may return.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO, ClassVar, Protocol, runtime_checkable

from stackloft.model.measurement import Integral

API = "1"
FAMILIES = ("reader", "segmenter", "reconstructor", "mesher", "integrator", "writer", "recipe")
"""Entry-point groups are ``stackloft.<family>s``."""


class Plugin(Protocol):
    """What every plug-in class carries."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]


@runtime_checkable
class Reader(Protocol):
    """Turns a file or folder into a product (SliceStack, Segmentation, ContourStack or TriMesh)."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]

    def probe(self, path: Path) -> float:
        """Return the confidence, 0 to 1, that this reader is meant for `path`.

        Looks at content, not at suffixes alone; opens at most a few files; raises nothing;
        writes nothing.
        """
        ...

    def read(self, path: Path) -> Any:
        """Return the product.

        Raises
        ------
        InputError
            What is there cannot be measured: names file, found, expected and fix. Spacing that
            nobody gave is such an error; it is never assumed.
        """
        ...


@runtime_checkable
class Segmenter(Protocol):
    """Turns a SliceStack into a Segmentation.

    A class variable ``general = True`` marks one that fits any slices; it is taken when several
    segmenters are installed and nobody names one.
    """

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]

    def segment(self, stack: Any) -> Any:
        """Return the Segmentation; decodes no more slices here than its method needs."""
        ...


@runtime_checkable
class Reconstructor(Protocol):
    """Turns sections (or fields, or a surface) into a solid or a surface."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]

    def reconstruct(self, product: Any) -> Any:
        """Return a LoftedSolid or a TriMesh."""
        ...


@runtime_checkable
class Mesher(Protocol):
    """Fills a closed solid with tetrahedra."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]

    def mesh(self, solid: Any) -> Any:
        """Return a TetMesh."""
        ...


@runtime_checkable
class Integrator(Protocol):
    """Integrates volume, area or both over a product."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]

    def integrate(self, product: Any) -> Integral:
        """Return volume (mm³) and area (mm²); a quantity the method cannot give is None.

        Raises
        ------
        InputError
            The product is open, empty or otherwise not measurable.
        """
        ...


@runtime_checkable
class Writer(Protocol):
    """Writes one product into an open binary file; the caller makes the file whole or absent."""

    api: ClassVar[str]
    accepts: ClassVar[tuple[type, ...]]
    produces: ClassVar[tuple[type, ...]]
    suffixes: ClassVar[tuple[str, ...]]
    """File suffixes it serves, lower case, with the dot; the first is the usual one."""

    def write(self, product: Any, stream: BinaryIO) -> None:
        """Write `product` to `stream`."""
        ...
