"""What decodes a slice: the picture without reference object and marks, as seen from above."""

from __future__ import annotations

from dataclasses import dataclass, replace

from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.picture_decode import PictureHeader, decode_picture
from stackloft_plugins.readers.reference_sighting import Found
from stackloft_plugins.readers.slice_faces import turned_back


@dataclass(frozen=True, slots=True)
class SliceDecoder:
    """Gives the picture of a slice by its number, from 0."""

    headers: tuple[PictureHeader, ...]
    """Of each slice's file."""
    hidden: tuple[tuple[Found, ...], ...]
    """Of each slice: what plate is put over."""
    paper: int
    """Grey level behind what is transparent."""
    over: tuple[str | None, ...]
    """How each slice was turned over."""
    marks: tuple[tuple[Found, ...], ...] = ()
    """Likewise, of each slice when it has been turned back; empty: nothing."""

    def __call__(self, number: int) -> Picture:
        """Return the picture with its colours."""
        return self._seen(number, decode_picture(self.headers[number], self.paper))

    def luminance(self, number: int) -> Picture:
        """Return its luminance alone where that is quicker."""
        return self._seen(number, decode_picture(self.headers[number], self.paper, luminance=True))

    def hiding(self, more: tuple[tuple[Found, ...], ...]) -> SliceDecoder:
        """Return the same with plate over more of each slice, marks seen on the slices as they are given."""
        return replace(self, marks=more)  # the marks of slices that are turned over lie where they are seen

    def _seen(self, number: int, picture: Picture) -> Picture:
        from stackloft_plugins.readers.reference_find import hide  # noqa: PLC0415 - needs OpenCV

        for found in self.hidden[number]:
            hide(picture, found)
        seen = turned_back(picture, self.over[number])
        for mark in self.marks[number] if self.marks else ():
            hide(seen, mark)
        return seen
