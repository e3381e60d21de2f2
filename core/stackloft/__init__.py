"""stackloft measures irregular solids from slice photographs and scans.

``import stackloft`` itself loads nothing heavy: each name below is imported when it is first used.

Examples
--------
>>> import stackloft
>>> stackloft.End.parse("round:2.5mm").length
2.5
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stackloft.model.contour_stack import ContourStack, Loop, Section
    from stackloft.model.ends import End, EndKind
    from stackloft.model.errors import InputError, OutputError, PluginError, StackloftError, UsageError
    from stackloft.model.lofted_solid import LoftedSolid, Shell
    from stackloft.model.measurement import (
        EndReport,
        Figure,
        Integral,
        Measurement,
        MethodRow,
        Result,
        SectionRow,
    )
    from stackloft.model.notices import Notice
    from stackloft.model.segmentation import SectionField, Segmentation
    from stackloft.model.slice_stack import Hints, SectionKind, SliceStack
    from stackloft.model.tet_mesh import TetMesh
    from stackloft.model.tri_mesh import TriMesh
    from stackloft.pipeline.api import measure, read
    from stackloft.studies.convergence import convergence
    from stackloft.studies.convergence_table import Convergence

    __version__: str

_HOMES = {
    "model.contour_stack": ("ContourStack", "Loop", "Section"),
    "model.ends": ("End", "EndKind"),
    "model.errors": ("InputError", "OutputError", "PluginError", "StackloftError", "UsageError"),
    "model.lofted_solid": ("LoftedSolid", "Shell"),
    "model.measurement": (
        "EndReport",
        "Figure",
        "Integral",
        "Measurement",
        "MethodRow",
        "Result",
        "SectionRow",
    ),
    "model.notices": ("Notice",),
    "model.segmentation": ("SectionField", "Segmentation"),
    "model.slice_stack": ("Hints", "SectionKind", "SliceStack"),
    "model.tet_mesh": ("TetMesh",),
    "model.tri_mesh": ("TriMesh",),
    "pipeline.api": ("measure", "read"),
    "studies.convergence": ("convergence",),
    "studies.convergence_table": ("Convergence",),
}
_MODULE_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "ContourStack",
    "Convergence",
    "End",
    "EndKind",
    "EndReport",
    "Figure",
    "Hints",
    "InputError",
    "Integral",
    "LoftedSolid",
    "Loop",
    "Measurement",
    "MethodRow",
    "Notice",
    "OutputError",
    "PluginError",
    "Result",
    "Section",
    "SectionField",
    "SectionKind",
    "SectionRow",
    "Segmentation",
    "Shell",
    "SliceStack",
    "StackloftError",
    "TetMesh",
    "TriMesh",
    "UsageError",
    "__version__",
    "convergence",
    "measure",
    "read",
]


def __getattr__(name: str) -> Any:
    """Import `name` from where it lives (PEP 562)."""
    if name == "__version__":
        from importlib.metadata import version  # noqa: PLC0415 - alone takes 40 ms

        return version("stackloft")
    if name not in _MODULE_OF:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    value = getattr(import_module(f"stackloft.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
