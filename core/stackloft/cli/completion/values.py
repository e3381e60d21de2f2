"""What a flag or argument of a command may be given."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from stackloft.cli.arguments import Units
from stackloft.cli.completion import plugin_words
from stackloft.cli.completion.candidate import FILES, Candidate, listed, plain
from stackloft.cli.phantom_arguments import PHANTOMS

Candidates = tuple[Candidate, ...] | None
"""None: files and folders (`FILES`)."""

_ENDS = ("auto", "face", "flat:", "round", "round:", "point:")
_REFERENCES = ("disc:", "square:", "ruler:")
_FORMS = ("photos", "contours", "rtstruct", "dicom", "dicom-seg", "nrrd", "nifti", "tiff", "bruker")
_SUFFIXES = ("png", "jpg", "tif", "bmp", "webp")
_FAMILIES = ("reader", "segmenter", "reconstructor", "mesher", "integrator", "writer", "recipe")

FLAGS: Mapping[str, Callable[[str], Candidates]] = {
    "--method": lambda text: listed((*plugin_words.names("recipe"), Candidate("all", "every method")), text),
    "--reader": lambda _: plugin_words.names("reader"),
    "--segmenter": lambda _: plugin_words.names("segmenter"),
    "--mesher": lambda _: plugin_words.names("mesher"),
    "--write": lambda text: listed(plugin_words.names("writer"), text),
    "--set": plugin_words.settings,
    "--units": lambda _: plain(unit.value for unit in Units),
    "--ends": lambda text: listed(plain(_ENDS), text),
    "--reference": lambda _: plain(_REFERENCES),
    "--as": lambda _: plain(_FORMS),
    "--suffix": lambda _: plain(_SUFFIXES),
}
"""By flag, in every command that has it."""

ARGUMENTS: Mapping[str, Callable[[str], Candidates]] = {
    "phantom name": lambda _: plain(PHANTOMS),
    "plugins show name": lambda _: plugin_words.every_name(),
    "plugins check name": lambda _: plugin_words.every_name(),
    "plugins doctor names": lambda _: plugin_words.every_name(),
    "plugins new family": lambda _: plain(_FAMILIES),
    "plugins new name": lambda _: (),
    "completion shell": lambda _: plain(("bash", "zsh", "fish")),
}
"""By command and argument."""

_OWN_SET = frozenset({"phantom"})
"""Commands whose ``--set`` is no plug-in's option."""


def values_of(command: str, parameter: Any, current: str) -> Candidates:
    """Return what may be given to a parameter of `command`; what its metavar lists, where nothing is known.

    Parameters
    ----------
    command : str
        Its name, as in ``plugins show``.
    parameter : object
        The command line library's own description of it: its names and its metavar.
    current : str
        What is typed of the value.
    """
    key = f"{command} {parameter.name}"
    if parameter.param_type_name == "argument":
        return ARGUMENTS[key](current) if key in ARGUMENTS else FILES
    for flag in parameter.opts:
        if flag in FLAGS and not (flag == "--set" and command in _OWN_SET):
            return FLAGS[flag](current)
    return _in_metavar(parameter.metavar or "", current)


def _in_metavar(metavar: str, current: str) -> Candidates:
    """Return the words in small letters of, for example, ``none|translation|rigid``; files where it says so.

    Examples
    --------
    >>> [found.word for found in _in_metavar("largest|all|N", "")]
    ['largest', 'all']
    """
    if metavar in {"DIR", "FILE"} or metavar.startswith("TABLE"):
        return FILES
    words = [word for word in metavar.split("|") if re.fullmatch(r"[a-z][a-z-]*", word)]
    return listed(plain(words), current) if "," in metavar else plain(words)
