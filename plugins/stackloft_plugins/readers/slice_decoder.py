"""What decodes a slice: the picture without reference object and marks, as seen from above."""

from __future__ import annotations

from collections.abc import Callable

from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.picture_decode import PictureHeader, decode_picture
from stackloft_plugins.readers.reference_sighting import Found
from stackloft_plugins.readers.slice_faces import turned_back


def decoder(
    headers: tuple[PictureHeader, ...],
    found: tuple[Found | None, ...],
    paper: int,
    over: tuple[str | None, ...],
) -> Callable[[int], Picture]:
    """Return what gives the picture of a slice by its number, from 0.

    Parameters
    ----------
    headers, found, over
        For each slice: its file, the reference object to hide, and how it was turned over.
    paper : int
        Grey level behind what is transparent.
    """
    if any(found):
        from stackloft_plugins.readers.reference_find import hide  # noqa: PLC0415 - needs OpenCV

    def decode(number: int) -> Picture:
        picture = decode_picture(headers[number], paper)
        reference = found[number]
        seen = picture if reference is None else hide(picture, reference)
        return turned_back(seen, over[number])

    return decode


def hiding(
    decode: Callable[[int], Picture], found: tuple[tuple[Found, ...], ...]
) -> Callable[[int], Picture]:
    """Return the same pictures with plate where the fiducial marks lie."""
    from stackloft_plugins.readers.reference_find import hide  # noqa: PLC0415 - needs OpenCV

    def without_marks(number: int) -> Picture:
        picture = decode(number)
        for mark in found[number]:
            picture = hide(picture, mark)
        return picture

    return without_marks
