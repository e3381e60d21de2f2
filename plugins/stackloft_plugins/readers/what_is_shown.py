r"""What a picture shows: a face or a silhouette, the body's outer cap, one face of each slice or both.

::

      ___           cap: the first slice from above shows skin, not a cut; its outline is no section there
     /___\  face    face: the section at the upper plane
    /_____\
     side wall      silhouette: a slice that widens downwards shows its side wall, and its outline is that of
                    all its planes together

    both faces:  slice j has its upper face at j·(t + kerf), its lower one t below; with no kerf the lower
                 face and the next upper one are one cut, and the upper one is used
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.reference import Reference, ReferenceKind
from stackloft.model.slice_stack import Hints, SectionKind

SECTIONS = ("face", "silhouette")
FIRST = ("face", "cap")
FACES = ("one", "both")
TURNED = ("left-right", "up-down", "no")


@dataclass(frozen=True, slots=True)
class Shown:
    """What the pictures of a stack show."""

    section: SectionKind = SectionKind.FACE
    cap: bool = False
    """The folder's first picture shows the body's outer end."""
    both: bool = False
    """Pictures come in pairs: a slice's upper face, then its lower one."""
    turned: str = "left-right"
    """How a slice was turned over for its lower face."""


def what_is_shown(
    section: str | None, first_shows: str | None, faces: str | None, turned: str | None, said: StackFile
) -> Shown:
    """Return what flags, which win, and the file say.

    Raises
    ------
    InputError
        The file calls the same pictures faces and silhouettes, or says how slices were turned over that
        were not.

    Examples
    --------
    >>> what_is_shown(None, "cap", None, None, StackFile(faces="both")).cap
    True
    """
    if said.kind is not None and said.section is not None and said.kind.value != said.section:
        raise InputError(
            "contradict each other; keep one", where=NAME,
            found=f'kind = "{said.kind.value}" and section = "{said.section}"',
        )  # fmt: skip
    kind = SectionKind(section or said.section or said.kind or SectionKind.FACE)
    both = (faces or said.faces) == "both"
    over = turned or said.turned
    if over is not None and not both:
        raise InputError(
            "tells how slices were turned over, but one face of each was photographed",
            where="turned", found=repr(over), fix='say faces = "both", or leave turned out',
        )  # fmt: skip
    if both and kind is SectionKind.SILHOUETTE:
        raise InputError(
            "both faces of a slice are not seen as silhouettes", where="faces", found='"both"',
            expected='section = "face"',
        )  # fmt: skip
    return Shown(kind, (first_shows or said.first) == "cap", both, over or "left-right")


def check_silhouettes(shown: Shown, plane: str | None) -> None:
    """Raise InputError for silhouettes of a block that slices are taken off.

    From above such a block shows its widest plane over and over.
    """
    if shown.section is SectionKind.SILHOUETTE and plane == "receding":
        raise InputError(
            "the outline of a block seen from above is that of its widest plane below",
            where="section",
            found='"silhouette" with plane = "receding"',
            fix="photograph the slices one by one, or the cut faces alone against the block's skin: "
            'section = "face", with --segmenter colour or masks',
        )


def ends_with_cap(ends: tuple[End, End] | None, shown: Shown, beyond: float) -> tuple[End, End] | None:
    """Return the ends when the first picture shows the cap: the body ends `beyond` mm before its section.

    Ends that are told stay as they are.
    """
    if not shown.cap or ends is not None:
        return ends
    return End(EndKind.ROUND, beyond), End(EndKind.AUTO)


def without_cap(
    numbers: tuple[int, ...], shown: Shown, names: Sequence[str]
) -> tuple[tuple[int, ...], tuple[Notice, ...]]:
    """Return the pictures that show sections: not the cap's face, whose outline is the next cut's.

    A cap seen as a silhouette is kept, for silhouettes are put where their outline is a section.
    """
    if not shown.cap or shown.section is SectionKind.SILHOUETTE or not numbers or numbers[0] != 0:
        return numbers, ()
    message = (
        f"{names[0]}: shows the body's outer end, whose outline is no section at its own plane; it is "
        "left out, and the body ends where it lies"
    )
    return numbers[1:], (Notice("cap-left-out", message),)


def fiducials_said(text: str) -> Reference:
    """Return the mark that ``--set reader.fiducials`` names.

    Examples
    --------
    >>> str(fiducials_said("disc:8mm"))
    'disc:8mm'
    """
    mark = Reference.parse(text)
    if mark.kind is not ReferenceKind.DISC:
        raise UsageError(
            "fiducial marks are discs", where="reader.fiducials", found=text, expected="disc:8mm"
        )
    return mark


def hints_of(said: StackFile, folder: Path, kept: tuple[int, ...], over: tuple[str | None, ...]) -> Hints:
    """Return the hints; a mask is turned back as its picture is."""
    hints = said.hints(folder, {number + 1: slot for slot, number in enumerate(kept, start=1)})
    slices = {
        slot: {**own, "turned": over[slot - 1]} if "mask" in own and over[slot - 1] else own
        for slot, own in hints.slices.items()
    }
    return replace(hints, slices=slices)
