"""The arguments and options of ``stackloft phantom``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

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
