"""Which of the ways to a scale a stack of photographs takes, with its notices."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft_plugins.readers.picture_decode import PictureHeader
from stackloft_plugins.readers.picture_scale import Bench, PictureScale, measured_scale, told_scale
from stackloft_plugins.readers.reference_sighting import Found
from stackloft_plugins.readers.reference_stack import Sightings, find_in_stack
from stackloft_plugins.readers.scale_notices import plane_notice, reference_notices
from stackloft_plugins.readers.scale_said import ScaleSaid

_DISAGREE = 0.005  # relative


@dataclass(frozen=True, slots=True, eq=False)
class ScaledSlices:
    """The pictures that are used."""

    headers: tuple[PictureHeader, ...]
    numbers: tuple[int, ...]
    """Their numbers in the folder, from 0."""
    total: int
    """Pictures in the folder."""
    bench: Bench


def require_scale(said: ScaleSaid, where: Path) -> None:
    """Raise InputError when nobody tells a scale: it is never assumed."""
    if not said.explicit and said.reference is None:
        raise InputError(
            "pixel size is unknown",
            where=str(where),
            fix=f'give --pixel-size 0.21mm, --reference disc:24.25mm, or pixel_size = "0.21mm" in {NAME}; '
            "for a flatbed scan --set reader.dpi=true",
        )


def scale_of(
    slices: ScaledSlices, said: StackFile, paper: int
) -> tuple[PictureScale, tuple[Found | None, ...]]:
    """Return the scale, and the reference object in each picture, to be hidden from the segmenter.

    Raises
    ------
    InputError
        No reference object where one was announced, no resolution tag, a wrong number of sizes.
    """
    bench, headers = slices.bench, slices.headers
    sightings = Sightings((None,) * len(headers), ("",) * len(headers))
    if bench.said.reference is not None:
        sightings = find_in_stack(headers, bench.said.reference, bench, paper)
    if bench.said.explicit:
        scale = told_scale(headers, bench, _own_sizes(slices, said))
        more = _check_told(scale, slices, sightings)
    else:
        scale = measured_scale(headers, bench, sightings.found)
        more = reference_notices(headers, sightings.found, sightings.reasons)
    seen = [one is not None for one in sightings.found]
    notices = (*plane_notice(bench, headers, seen), *sightings.notices, *more)
    return replace(scale, notices=notices), sightings.found


def profiles(headers: Sequence[PictureHeader]) -> dict[str, str]:
    """Return what the provenance says of colour profiles; pixels are taken as they are."""
    named = Counter(header.tags.profile for header in headers if header.tags.profile)
    listed = ", ".join(f"{name} ({count} of {len(headers)})" for name, count in sorted(named.items()))
    return {"colour profile": f"{listed}; not applied"} if listed else {}


def _own_sizes(slices: ScaledSlices, said: StackFile) -> list[float | None]:
    """Return what is told of each picture by itself: a list of sizes, then ``[slice.N] pixel_size``."""
    sizes = slices.bench.said.pixel_sizes
    if sizes is not None and len(sizes) not in {slices.total, len(slices.numbers)}:
        raise InputError(
            "pixel sizes and pictures differ in number",
            where=slices.bench.said.source,
            found=f"{len(sizes)} sizes for {slices.total} pictures",
            expected="one size for each picture, in the natural order of the file names",
        )
    own: list[float | None] = [None] * len(slices.numbers)
    for k, number in enumerate(slices.numbers):
        if sizes is not None:
            own[k] = sizes[number] if len(sizes) == slices.total else sizes[k]
        override = said.slice.get(number + 1)
        if override is not None and override.pixel_size is not None:
            own[k] = override.pixel_size
    return own


def _check_told(scale: PictureScale, slices: ScaledSlices, sightings: Sightings) -> tuple[Notice, ...]:
    """Return a notice when the reference object contradicts the pixel size that was told."""
    if not any(sightings.found):
        return ()
    measured = measured_scale(slices.headers, slices.bench, sightings.found).spacing
    off = scale.spacing[:, 0] / measured[:, 0] - 1
    k = int(np.argmax(np.abs(off)))
    if abs(off[k]) < _DISAGREE:
        return ()
    message = (
        f"{slices.headers[k].path.name}: the pixel size told is {100 * off[k]:+.1f} % off what the reference "
        "object says; the one told is used"
    )
    return (Notice("scale-disagrees", message),)
