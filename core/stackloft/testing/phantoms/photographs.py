"""Sections as a folder of pictures: exact coverage, or as a camera would have seen them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.answer import answer, stack_toml
from stackloft.testing.phantoms.camera import Camera
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.files import made_folder, write_json, write_whole
from stackloft.testing.phantoms.frame import Frame, framed
from stackloft.testing.phantoms.laying import Laying
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.picture_format import FORMATS, encoded
from stackloft.testing.phantoms.placing import Placing
from stackloft.testing.phantoms.realism import PLATES, Realism, Thing, photograph
from stackloft.testing.phantoms.reference_object import GREY, ReferenceObject

LEVELS = {"white": (230.0, 60.0), "black": (25.0, 200.0)}
"""Grey levels of plate and body in noise-free pictures, of 255."""
MARKED = (64.0, 110.0, 120.0)
"""Colour of fiducial marks, in realistic pictures."""


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
    """mm; under a camera, on the first picture's cut face"""
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
    camera: Camera | None = None
    """None: every picture at one scale, as a scanner sees it."""
    reference: ReferenceObject | None = None
    """An object of known size on the plate."""
    laying: Laying | None = None
    """None: every slice lies on the one before; else how far off it does."""
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
        toml = stack_toml(phantom, positions, self.tell, self._told())
        cuts = [phantom.section(float(z), self.points) for z in positions]
        frames = self.frames(cuts, positions)
        marks = self.laying.outlines(cuts) if self.laying is not None else []
        made_folder(folder)
        digits = max(2, len(str(len(cuts))))
        files = []
        for i, (z, loops) in enumerate(zip(positions, cuts, strict=True), start=1):
            content = self.encoded(self.picture(phantom, float(z), loops, frames[i - 1], i, marks))
            files.append(write_whole(folder / f"slice_{i:0{digits}d}.{self.suffix}", content))
        if toml:
            files.append(write_whole(folder / "stack.toml", toml.encode()))
        files.append(write_json(folder / "answer.json", answer(phantom, positions)))
        return files

    def frames(self, cuts: Sequence[Sequence[Loop]], positions: FloatArray) -> list[Frame]:
        """Return where each picture's pixels lie on its own cut face."""
        margin = self.margin + (self.laying.room(cuts) if self.laying is not None else 0.0)
        frame = framed(cuts, self.pixel_size, margin, self.turn, self.mirror)
        if self.reference is not None:
            frame = self.reference.widened(frame)
        frames = [frame] * len(positions) if self.camera is None else self.camera.frames(frame, positions)
        return frames if self.laying is None else self.laying.frames(frames, cuts)

    def picture(
        self,
        phantom: Phantom,
        z: float,
        loops: tuple[Loop, ...],
        frame: Frame,
        index: int = 1,
        marks: Sequence[Loop] = (),
    ) -> NDArray[Any]:
        """Return one section's picture: (rows, columns) or (rows, columns, 3), uint8 or uint16."""
        covered = coverage(frame.polygons(loops), frame.shape)
        thing = _together(self._thing(frame, index), _painted(marks, frame))
        if self.realism is None:
            plate, body = LEVELS[self.plate]
            grey = plate + (body - plate) * covered
            if thing is not None:
                grey += (GREY - grey) * thing[0]
            return (
                np.round(grey * 257).astype(np.uint16) if self.bits == 16 else np.round(grey).astype(np.uint8)
            )
        own = _body_frame(phantom, z, frame)
        seen = photograph(covered, own, frame.pixel_size, PLATES[self.plate], self.realism, index, thing)
        return np.round(seen).astype(np.uint8)

    def encoded(self, picture: NDArray[Any]) -> bytes:
        """Return the picture as a file's content; what a camera took says so in its EXIF."""
        quality = self.realism.quality if self.realism else None
        return encoded(picture, self.suffix, quality, by_camera=self.camera is not None)

    def _thing(self, frame: Frame, index: int) -> Thing | None:
        """Return the reference object's coverage and colours in picture `index`, or None."""
        if self.reference is None or not self.reference.shown(index):
            return None
        size = self._reference_scale(frame)
        outline = self.reference.polygon(frame.shape, size)
        return coverage([outline], frame.shape), self.reference.colours(frame.shape, size)

    def _reference_scale(self, frame: Frame) -> float:
        """Return the pixel size on the reference object's own plane, mm."""
        if self.camera is None or self.reference is None:
            return frame.pixel_size
        focal = self.camera.distance / self.pixel_size
        face = self.camera.distance if self.reference.stays else frame.pixel_size * focal
        return (face - self.reference.height) / focal

    def _told(self) -> dict[str, str]:
        """Return the values of ``stack.toml`` that are the camera's."""
        told = {
            "pixel_size": f'"{self.pixel_size!r}mm"',
            "background": '"light"' if self.plate == "white" else '"dark"',
        }
        if self.reference is not None:
            told["reference"] = f'"{self.reference.kind}:{self.reference.size:.12g}mm"'
            told["reference_height"] = f'"{self.reference.height:.12g}mm"'
            told["reference_stays"] = str(self.reference.stays).lower()
        if self.laying is not None and self.laying.marks:
            told["fiducials"] = f'"disc:{self.laying.marks:.12g}mm"'
        if self.camera is not None:
            told["camera"] = (
                f'{{ distance = "{self.camera.distance:.12g}mm", plane = "{self.camera.plane}" }}'
            )
        return told


def _painted(marks: Sequence[Loop], frame: Frame) -> Thing | None:
    """Return the marks' coverage and colour; None when there are none."""
    if not marks:
        return None
    colour = np.array(MARKED)[:, None, None] * np.ones((1, *frame.shape))
    return coverage(frame.polygons(marks), frame.shape), colour


def _together(one: Thing | None, other: Thing | None) -> Thing | None:
    """Return two things, which do not overlap, as one."""
    if one is None or other is None:
        return one or other
    return one[0] + other[0], np.where(other[0] > 0, other[1], one[1])


def _body_frame(phantom: Phantom, z: float, frame: Frame) -> FloatArray:
    """Return every pixel's point in the body's own frame, (3, rows, columns) mm."""
    plane = frame.bench()
    bench = np.stack([plane[0], plane[1], np.full(frame.shape, z)]) - phantom.offset[:, None, None]
    return np.tensordot(phantom.rotation.T, bench, axes=1)
