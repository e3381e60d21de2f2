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
    typer.Option("--method", metavar="NAME,…|all", help="Method, the first is the main one."),
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


PHANTOMS = (
    *("apple", "banana", "blind-hole", "box", "coil", "cone", "cylinder", "double-cone", "dumbbell"),
    *("ellipsoid", "frustum", "hollow-sphere", "horseshoe", "meat", "potato", "prism", "ring-branch"),
    *("superellipsoid", "torus", "tube", "twisted-bar", "two-bodies", "two-cavities", "two-lobed"),
    *("walnut", "y-branch"),
)
"""Names for the help text, which imports no phantom; a test compares them with the phantoms' own."""

PhantomName = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help=f"One of {', '.join(PHANTOMS)}.",
        show_default=False,
    ),
]
Form = Annotated[
    str,
    typer.Option(
        "--as",
        metavar="FORM",
        help="photos, contours, rtstruct; or a scan: dicom, dicom-seg, nrrd, nifti, tiff, bruker.",
    ),
]
PhantomOut = Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Folder to fill.")]
Parameters = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="The body's own size, as in a=30mm; may be repeated."),
]
Sections = Annotated[int | None, typer.Option("--sections", help="How many.  [default: 11]")]
Placing = Annotated[
    str | None,
    typer.Option(
        "--placing", metavar="mid|faces|LEN,…", help="Mid-thickness, cut faces, or positions.  [default: mid]"
    ),
]
Rotation = Annotated[
    str | None,
    typer.Option("--rotation", metavar="SEED|X,Y,Z", help="Pose: a seed, or degrees about the axes."),
]
Offset = Annotated[str | None, typer.Option("--offset", metavar="LEN,LEN,LEN", help="Pose: shift.")]
Realistic = Annotated[
    bool, typer.Option("--realistic", help="Flesh, skin, uneven light, blur, noise; photographs only.")
]
Seed = Annotated[int | None, typer.Option("--seed", help="Of the realism's random numbers.")]
Plate = Annotated[str | None, typer.Option("--plate", metavar="white|black", help="What the slice lies on.")]
Suffix = Annotated[str | None, typer.Option("--suffix", help="png, jpg, tif, bmp or webp.  [default: png]")]
PhantomCamera = Annotated[
    str | None,
    typer.Option(
        "--camera", metavar="LEN[:fixed|receding]", help="A pinhole camera that far above the first face."
    ),
]
PhantomReference = Annotated[
    str | None,
    typer.Option("--reference", metavar="KIND:LEN", help="A disc, square or ruler of that size beside it."),
]
ReferenceHeight = Annotated[
    str | None,
    typer.Option("--reference-height", metavar="LEN", help="How far it lies above the cut face."),
]
ReferenceStays = Annotated[
    bool, typer.Option("--reference-stays", help="It stays where it is while the faces recede.")
]
ReferenceOnce = Annotated[bool, typer.Option("--reference-once", help="It is in the first picture alone.")]
Tell = Annotated[
    str | None, typer.Option("--tell", metavar="KEY,…", help="What stack.toml says, as in thickness,height.")
]
Levels = Annotated[
    str | None, typer.Option("--levels", metavar="AIR,BODY", help="Scans: HU.  [default: -1000,40]")
]
Noise = Annotated[
    float | None, typer.Option("--noise", help="Scans: Rician noise, standard deviation in HU.")
]
BiasField = Annotated[
    float | None, typer.Option("--bias", help="Scans: how much dimmer the farthest corner is, as in 0.4.")
]
Fill = Annotated[
    float | None,
    typer.Option("--fill", help="Scans: slab thickness over pitch; below 1 there are gaps.  [default: 1]"),
]
SlabPoints = Annotated[
    int | None,
    typer.Option(
        "--slab-points", help="Scans: planes averaged across a slab (partial volume).  [default: 6]"
    ),
]
Tilt = Annotated[
    float | None, typer.Option("--tilt", help="Scans: gantry tilt in degrees; dicom, dicom-seg, bruker.")
]
Cosines = Annotated[
    int | None,
    typer.Option("--cosines", metavar="SEED", help="Scans: slices turned anyhow in patient space."),
]
Origin = Annotated[
    str | None,
    typer.Option("--origin", metavar="LEN,LEN,LEN", help="Scans: where they lie in patient space."),
]
Aspect = Annotated[
    float | None,
    typer.Option("--aspect", help="Scans: pitch over pixel size, as in 10; sets the pixel size."),
]
Stretch = Annotated[
    float | None, typer.Option("--stretch", help="Scans: row over column spacing.  [default: 1]")
]
Empty = Annotated[int | None, typer.Option("--empty", help="Scans: slices beyond either end.  [default: 1]")]
Margin = Annotated[str | None, typer.Option("--margin", metavar="LEN", help="Scans: air around the body.")]
LabelNumber = Annotated[int | None, typer.Option("--label", help="Scans: a label map with this number.")]
Syntax = Annotated[
    str | None,
    typer.Option(
        "--syntax",
        metavar="NAME",
        help="dicom: explicit, implicit, big-endian, deflated, rle, jpeg-ls or jpeg-2000.",
    ),
]
Multiframe = Annotated[bool, typer.Option("--multiframe", help="dicom: one enhanced file for all slices.")]
