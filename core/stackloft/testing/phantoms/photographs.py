"""Sections as a folder of pictures: exact coverage, or as a camera would have seen them."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.answer import answer, stack_toml
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.files import made_folder, write_json, write_whole
from stackloft.testing.phantoms.frame import Frame, framed
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.placing import Placing
from stackloft.testing.phantoms.realism import PLATES, Realism, photograph

FORMATS = {
    "png": "PNG",
    "jpg": "JPEG",
    "jpeg": "JPEG",
    "tif": "TIFF",
    "tiff": "TIFF",
    "bmp": "BMP",
    "webp": "WEBP",
}
"""Suffix to Pillow's name of the format."""
LEVELS = {"white": (230.0, 60.0), "black": (25.0, 200.0)}
"""Grey levels of plate and body in noise-free pictures, of 255."""


@dataclass(frozen=True, slots=True)
class Photographs:
    """How a phantom is photographed.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> camera = Photographs(sections=5, pixel_size=1.0)
    >>> files = camera.write(phantoms.make("cone"), Path(tempfile.mkdtemp()))
    >>> [file.name for file in files][3:]
    ['slice_04.png', 'slice_05.png', 'stack.toml', 'answer.json']
    """

    sections: int = 11
    placing: Placing | tuple[float, ...] = "mid"
    """``mid``, ``faces`` or positions in mm (`stackloft.testing.phantoms.placing`)."""
    pixel_size: float = 0.3
    """mm"""
    realism: Realism | None = None
    """None: noise-free grey pictures whose levels are exact coverage."""
    plate: Literal["white", "black"] = "white"
    suffix: str = "png"
    """png, jpg, tif, bmp or webp (lossless where realism is None)."""
    bits: Literal[8, 16] = 8
    """16 for noise-free PNG and TIFF."""
    turn: float = 0.0
    """Degrees by which the body lies turned in the picture."""
    mirror: bool = False
    margin: float = 6.0
    """Plate around the body, mm; negative lets the picture's border cut it."""
    points: int = 3000
    """Points on each outline; the polygon's area is short by about 7/points²."""
    tell: tuple[str, ...] = ("kind", "pixel_size", "thickness", "specimen")
    """Keys of ``stack.toml`` (`stackloft.testing.phantoms.answer.KEYS`); none: no such file."""

    def __post_init__(self) -> None:
        if self.suffix not in FORMATS:
            raise UsageError(
                "unknown picture format", where="suffix", found=self.suffix, expected=", ".join(FORMATS)
            )
        if self.plate not in PLATES:
            raise UsageError("unknown plate", where="plate", found=self.plate, expected=", ".join(PLATES))
        if self.bits not in {8, 16} or (
            self.bits == 16 and (self.realism or FORMATS[self.suffix] not in {"PNG", "TIFF"})
        ):
            raise UsageError(
                "16 bits are for noise-free PNG and TIFF", where="bits", found=f"{self.bits}, {self.suffix}"
            )

    def write(self, phantom: Phantom, folder: Path) -> list[Path]:
        """Write pictures, ``stack.toml`` and ``answer.json`` into `folder`; return the files in that order.

        Raises
        ------
        UsageError
            An option that does not suit the body.
        OutputError
            The system refuses; no half-written file is left.
        """
        positions = phantom.positions(self.sections, self.placing)
        background = "light" if self.plate == "white" else "dark"
        toml = stack_toml(phantom, positions, self.tell, self.pixel_size, background)
        cuts = [phantom.section(float(z), self.points) for z in positions]
        frame = framed(cuts, self.pixel_size, self.margin, self.turn, self.mirror)
        made_folder(folder)
        digits = max(2, len(str(len(cuts))))
        files = []
        for i, (z, loops) in enumerate(zip(positions, cuts, strict=True), start=1):
            content = self.encoded(self.picture(phantom, float(z), loops, frame, i))
            files.append(write_whole(folder / f"slice_{i:0{digits}d}.{self.suffix}", content))
        if toml:
            files.append(write_whole(folder / "stack.toml", toml.encode()))
        files.append(write_json(folder / "answer.json", answer(phantom, positions)))
        return files

    def picture(
        self, phantom: Phantom, z: float, loops: tuple[Loop, ...], frame: Frame, index: int = 1
    ) -> NDArray[Any]:
        """Return one section's picture: (rows, columns) or (rows, columns, 3), uint8 or uint16."""
        covered = coverage(frame.polygons(loops), frame.shape)
        if self.realism is None:
            plate, body = LEVELS[self.plate]
            grey = plate + (body - plate) * covered
            return (
                np.round(grey * 257).astype(np.uint16) if self.bits == 16 else np.round(grey).astype(np.uint8)
            )
        own = _body_frame(phantom, z, frame)
        seen = photograph(covered, own, self.pixel_size, PLATES[self.plate], self.realism, index)
        return np.round(seen).astype(np.uint8)

    def encoded(self, picture: NDArray[Any]) -> bytes:
        """Return the picture as a file's content."""
        from PIL import Image  # noqa: PLC0415 - only where pictures are written

        form = FORMATS[self.suffix]
        quality = self.realism.quality if self.realism else 95
        options: dict[str, Any] = {
            "JPEG": {"quality": quality, "subsampling": 0},
            "WEBP": {"quality": quality, "lossless": self.realism is None},
        }.get(form, {})
        stream = io.BytesIO()
        Image.fromarray(picture).save(stream, form, **options)
        return stream.getvalue()


def _body_frame(phantom: Phantom, z: float, frame: Frame) -> FloatArray:
    """Return every pixel's point in the body's own frame, (3, rows, columns) mm."""
    plane = frame.bench()
    bench = np.stack([plane[0], plane[1], np.full(frame.shape, z)]) - phantom.offset[:, None, None]
    return np.tensordot(phantom.rotation.T, bench, axes=1)
