r"""A pinhole camera above the slices.

::

          o  lens              a plane at distance D is seen with pixels of D / f,
         /|\                   f being the lens's focal length in pixels
        / | \
       /  |  \                 fixed:     every cut face at the same distance (slices laid on a table)
      /---|---\   face 1       receding:  slices taken off the top: face k is z_k - z_1 further away
     /----|----\  face 2       principal point: where the optical axis meets the picture; all pictures
          |                    are scaled about it
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length
from stackloft.testing.phantoms.frame import Frame

Motion = Literal["fixed", "receding"]
MOTIONS: tuple[Motion, ...] = ("fixed", "receding")


@dataclass(frozen=True, slots=True)
class Camera:
    """Where the camera hangs, and whether the cut faces stay where the first one was.

    Examples
    --------
    >>> Camera.parse("1m:fixed")
    Camera(distance=1000.0, plane='fixed', principal=None)
    >>> Camera(distance=600.0).pixel_sizes(0.3, np.array([5.0, 65.0]))
    array([0.3 , 0.33])
    """

    distance: float
    """mm from the lens to the first cut face"""
    plane: Motion = "receding"
    principal: tuple[float, float] | None = None
    """(column, row) in pixels; None: the picture's centre"""

    def __post_init__(self) -> None:
        if not (np.isfinite(self.distance) and self.distance > 0):
            raise UsageError("must be positive", where="camera", found=f"{self.distance:g} mm")
        if self.plane not in MOTIONS:
            raise UsageError(
                "unknown plane", where="camera", found=repr(self.plane), expected=", ".join(MOTIONS)
            )

    @classmethod
    def parse(cls, text: str) -> Camera:
        """Return the camera written as ``DISTANCE[:fixed|receding]``."""
        distance, _, plane = text.partition(":")
        motion = next((known for known in MOTIONS if known == plane), None) if plane else "receding"
        if motion is None:
            raise UsageError("unknown plane", where="camera", found=repr(plane), expected=", ".join(MOTIONS))
        return cls(parse_length(distance, "camera"), motion)

    def depths(self, positions: FloatArray) -> FloatArray:
        """Return each cut face's distance from the lens, (m) mm."""
        travelled = positions - positions[0] if self.plane == "receding" else np.zeros(len(positions))
        depths: FloatArray = self.distance + travelled
        return depths

    def pixel_sizes(self, pixel_size: float, positions: FloatArray) -> FloatArray:
        """Return the pixel size on each cut face, (m) mm; `pixel_size` is the first one's."""
        sizes: FloatArray = pixel_size * self.depths(positions) / self.distance
        return sizes

    def frames(self, first: Frame, positions: FloatArray) -> list[Frame]:
        """Return the frame of each picture; `first` is that of the first one."""
        rows, columns = first.shape
        centre = np.array(self.principal or ((columns - 1) / 2, (rows - 1) / 2))
        axis = first.origin + centre * first.pixel_size
        return [
            replace(first, pixel_size=float(size), origin=axis - centre * size)
            for size in self.pixel_sizes(first.pixel_size, positions)
        ]
