"""Every argument and option of the commands: its name and its help."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class Units(StrEnum):
    """Units that figures are shown in; files and JSON keep millimetres."""

    CM = "cm"
    MM = "mm"
    M = "m"
    UM = "um"
    IN = "in"


Source = Annotated[
    Path,
    typer.Argument(metavar="SOURCE", help="A folder of slice photographs, or a file.", show_default=False),
]
Json = Annotated[bool, typer.Option("--json", help="JSON on stdout, and nothing else there.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress; two lines instead of the table.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder for the run's files."),
]
Write = Annotated[
    str | None,
    typer.Option(
        "--write",
        metavar="NAME,…",
        help="Also write the solid into --out: stl, ply, obj; with --method fem vtu, msh, inp, mphtxt.",
    ),
]
FigureSlice = Annotated[
    str | None,
    typer.Option(
        "--figure-slice",
        metavar="N|NAME",
        help="Slice that --out shows step by step, from 1.  [default: the largest section]",
    ),
]
ShownUnits = Annotated[Units, typer.Option("--units", help="Unit of the table.")]
TableUnits = Annotated[
    Units | None, typer.Option("--units", help="Unit of the table.  [default: stack.toml's, or cm]")
]
Reader = Annotated[
    str | None,
    typer.Option("--reader", metavar="NAME", help="Reader to use instead of the one that knows SOURCE."),
]
Segmenter = Annotated[
    str | None,
    typer.Option("--segmenter", metavar="NAME", help="How body and plate are told apart: histogram, colour."),
]
Method = Annotated[
    str | None,
    typer.Option(
        "--method",
        metavar="NAME,…|all",
        help="Method, the first is the main one. all: every one but those that take minutes.",
    ),
]
Points = Annotated[int | None, typer.Option("--points", help="Boundary points per section.")]
Ends = Annotated[
    str | None,
    typer.Option(
        "--ends",
        metavar="FIRST[,LAST]",
        help="auto, face, flat:LEN, round, round:LEN or point:LEN; LEN from the last section to the end.",
    ),
]
Height = Annotated[
    str | None,
    typer.Option("--height", metavar="LEN", help="The body's whole length along the axis."),
]
Object = Annotated[
    str | None,
    typer.Option(
        "--object",
        metavar="largest|all|N|seed:X,Y,Z",
        help="Which body of a scan: by size or label, or the one at a point in patient mm.",
    ),
]
Axis = Annotated[
    str | None,
    typer.Option(
        "--axis",
        metavar="auto|0|1|2",
        help="Scans: the array's axis that sections go across; auto: filled sections, least variation.",
    ),
]
ScaleUncertaintyFlag = Annotated[
    str | None,
    typer.Option(
        "--scale-uncertainty",
        metavar="PERCENT",
        help="How well the pixel or voxel size is known, as in 0.2%.",
    ),
]
KeepIdentifiers = Annotated[
    bool,
    typer.Option(
        "--keep-identifiers", help="DICOM: keep patient's name, number and descriptions in what is written."
    ),
]
PixelSize = Annotated[
    str | None,
    typer.Option("--pixel-size", metavar="LEN", help="Side of one pixel, as in 0.21mm."),
]
ReferenceFlag = Annotated[
    str | None,
    typer.Option(
        "--reference",
        metavar="KIND:LEN",
        help="An object of known size in a corner: disc:24.25mm, square:20mm or ruler:50mm.",
    ),
]
Thickness = Annotated[
    str | None,
    typer.Option("--thickness", metavar="LEN", help="From one cut to the next."),
]
Positions = Annotated[
    str | None,
    typer.Option("--positions", metavar="LEN,LEN,…", help="Position of every slice instead."),
]
MeshOut = Annotated[
    Path,
    typer.Option(
        "-o", "--out", metavar="FILE", help="STL, PLY, OBJ (surface); VTU, MSH, INP, mphtxt (tetrahedra)."
    ),
]
Mesher = Annotated[
    str | None,
    typer.Option("--mesher", metavar="NAME", help="sweep or tetwild.  [default: sweep where it can]"),
]
Order = Annotated[int | None, typer.Option("--order", help="Order of the elements.  [default: 2]")]
MaxElementSize = Annotated[
    str | None, typer.Option("--max-element-size", metavar="LEN", help="Longest element edge.")
]
Align = Annotated[
    str | None,
    typer.Option(
        "--align",
        metavar="none|translation|rigid",
        help="Lay slices that were photographed one by one on each other: by marks, or by their neighbours.",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="FAMILY.OPTION=VALUE",
        help="Any option of a plug-in (see `stackloft plugins show`); may be repeated.",
    ),
]
Shell = Annotated[str, typer.Argument(metavar="SHELL", help="bash, zsh or fish.", show_default=False)]
PluginName = Annotated[str, typer.Argument(metavar="NAME", help="A name or family.name.", show_default=False)]
RecipeFile = Annotated[
    Path | None,
    typer.Option("--recipe", metavar="FILE", help="A recipe.toml of an earlier run, run again."),
]


def names_of(text: str | None) -> tuple[str, ...]:
    """Return the names in a comma-separated list, each once and in order.

    Examples
    --------
    >>> names_of("stl, ply,stl")
    ('stl', 'ply')
    """
    names = (name.strip() for name in (text or "").split(","))
    return tuple(dict.fromkeys(name for name in names if name))
