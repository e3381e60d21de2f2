"""Which of a folder's frames belong together: one series, one volume, one shape and orientation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Sequence

import numpy as np

from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.slice_geometry import SAME_PLACE, normal_of

PARALLEL = 1e-3
"""Radians by which orientations may differ and still count as one."""
_LISTED = 20
_NAMED = 5
_APART = 1e-4
"""mm: places nearer than this are one."""
Series = tuple[Frame, ...]


def series_of(frames: Sequence[Frame]) -> tuple[Series, ...]:
    """Return the series, by number, then as they come."""
    groups: dict[str, list[Frame]] = {}
    for frame in frames:
        groups.setdefault(frame.series, []).append(frame)
    numbered = sorted(groups.values(), key=lambda group: (group[0].series_number is None, _number(group)))
    return tuple(tuple(group) for group in numbered)


def choose_series(every: tuple[Series, ...], wanted: str, where: str) -> tuple[Series, tuple[Notice, ...]]:
    """Return the series asked for, or the one with most slices, which is told.

    Parameters
    ----------
    every : tuple of Series
        As `series_of` gives them.
    wanted : str
        ``#2`` for the second listed, a series number, or a Series Instance UID; empty: the largest.
    where : str
        Named in messages.

    Raises
    ------
    UsageError
        No series, or several, of that number.
    """
    if wanted:
        return _named(every, wanted, where), ()
    largest = max(every, key=len)
    if len(every) == 1:
        return largest, ()
    text = (
        f"{len(every)} series are here ({listing(every)}); the largest was taken: choose with "
        f"--set dicom.series={label(every, largest)}"
    )
    return largest, (Notice("several-series", text),)


def listing(every: tuple[Series, ...]) -> str:
    """Return the series in a few words each: label, modality, number of slices, picture size."""
    words = []
    for one in every[:_LISTED]:
        rows, columns = one[0].shape
        words.append(f"{label(every, one)}: {one[0].modality or 'unknown'} {len(one)} × {columns}×{rows}")
    return "; ".join(words) + (f"; and {len(every) - _LISTED} more" if len(every) > _LISTED else "")


def label(every: tuple[Series, ...], one: Series) -> str:
    """Return the series number where it tells the series apart, else ``#`` and its place in the list."""
    numbers = [group[0].series_number for group in every]
    number = one[0].series_number
    return str(number) if number is not None and numbers.count(number) == 1 else f"#{every.index(one) + 1}"


def _named(every: tuple[Series, ...], wanted: str, where: str) -> Series:
    found = [one for one in every if wanted == one[0].series or wanted == label(every, one)]
    if wanted.startswith("#") and wanted[1:].isdecimal() and 1 <= int(wanted[1:]) <= len(every):
        found = [every[int(wanted[1:]) - 1]]
    if not found:
        raise UsageError(
            "no such series", where=f"{where}: --set dicom.series", found=wanted, expected=listing(every)
        )
    return found[0]


def one_shape(frames: Series, *, leave_out: bool) -> tuple[Series, tuple[Notice, ...]]:
    """Return the frames that agree with most others in orientation, size, spacing and samples.

    Raises
    ------
    InputError
        Some do not agree (or are localizers), and it was not said to leave them out.
    """
    kept, notices = frames, []
    for what, keys_of, text in _TRAITS:
        keys = keys_of(kept)
        usual, _ = Counter(keys).most_common(1)[0]
        odd = [frame for frame, key in zip(kept, keys, strict=True) if key != usual]
        kept = tuple(frame for frame, key in zip(kept, keys, strict=True) if key == usual)
        if odd and not leave_out:
            raise _mixed(what, odd, kept[0], text, len(kept))
        if odd:
            notices.append(Notice("left-out", f"{_names(odd)}: left out, another {what} than most slices"))
    return kept, tuple(notices)


def one_volume(frames: Series, volume: int | None) -> tuple[Series, tuple[Notice, ...]]:
    """Return one of several volumes at the same places (echoes, time points).

    Parameters
    ----------
    frames : Series
        Of one orientation.
    volume : int or None
        From 1, in the order of acquisition, temporal position, instance and frame number; None: there
        must be but one.

    Raises
    ------
    InputError
        There are several and none was chosen, or the chosen one is not at every place.
    """
    places = _places(frames)
    counts = sorted({len(place) for place in places})
    if counts == [1]:
        return frames, ()
    if volume is None and len(counts) == 1 and len(places) > 1:
        raise InputError(
            f"the series holds {counts[0]} volumes at the same places (echoes, time points)",
            where=places[0][0].path.parent.as_posix(),
            found=f"{_names(places[0])} at the first of {len(places)} places",
            fix=f"choose one: --set dicom.volume=1 … {counts[0]}",
        )
    if volume is None:
        return frames, ()
    short = next((place for place in places if len(place) < volume), None)
    if short:
        raise InputError(
            f"there is no volume {volume} at every place",
            where=short[0].name,
            found=f"{len(short)} slices there",
            expected=f"--set dicom.volume from 1 to {counts[0]}",
        )
    text = f"volume {volume} of {counts[-1]} at the same places was taken"
    return tuple(place[volume - 1] for place in places), (Notice("one-volume", text),)


def _places(frames: Series) -> list[list[Frame]]:
    """Return the frames by their place along the normal, each place in order of acquisition."""
    normal = normal_of(frames[0].axes)
    along = np.array([frame.position for frame in frames]) @ normal
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    real = gaps[gaps > _APART]
    usual = float(np.median(real)) if len(real) else np.inf
    apart = np.flatnonzero(gaps > SAME_PLACE * usual) + 1
    return [
        sorted((frames[k] for k in group), key=lambda frame: (frame.order, frame.name))
        for group in np.split(order, apart)
    ]


def _orientations(frames: Series) -> list[Hashable]:
    """Return for every frame the number of the first one that is parallel to it."""
    axes = np.array([frame.axes for frame in frames]).reshape(len(frames), -1)
    keys = np.full(len(frames), -1)
    while (left := np.flatnonzero(keys < 0)).size:
        parallel = np.abs(axes[left] - axes[left[0]]).max(axis=1) <= PARALLEL
        keys[left[parallel]] = left[0]
        keys[left[0]] = left[0]  # whatever its numbers are
    return list(keys.tolist())


_TRAITS: tuple[tuple[str, Callable[[Series], list[Hashable]], Callable[[Frame], str]], ...] = (
    ("orientation", _orientations, lambda frame: ", ".join(f"{value:.3g}" for value in frame.axes.ravel())),
    (
        "size",
        lambda frames: [frame.shape for frame in frames],
        lambda frame: f"{frame.shape[1]} × {frame.shape[0]} pixels",
    ),
    (
        "pixel spacing",
        lambda frames: [tuple(round(side, 5) for side in frame.spacing) for frame in frames],
        lambda frame: "{:g} × {:g} mm".format(*frame.spacing),
    ),
    (
        "number of channels",
        lambda frames: [frame.samples for frame in frames],
        lambda frame: str(frame.samples),
    ),
)
"""What slices of a stack share: its name, a key for each frame, a frame's own in words."""


def _mixed(what: str, odd: list[Frame], usual: Frame, text: Callable[[Frame], str], count: int) -> InputError:
    localizers = all(frame.localizer for frame in odd)
    return InputError(
        "localizers are among the slices" if localizers else f"slices differ in {what}",
        where=odd[0].path.parent.as_posix(),
        found=f"{_names(odd)}: {text(odd[0])}",
        expected=f"{text(usual)} as the {count} others",
        fix="move them out of the folder, or give --set dicom.leave_out=true",
    )


def _names(frames: Sequence[Frame]) -> str:
    more = f" and {len(frames) - _NAMED} more" if len(frames) > _NAMED else ""
    return ", ".join(frame.name for frame in frames[:_NAMED]) + more


def _number(group: Sequence[Frame]) -> int:
    return group[0].series_number or 0
