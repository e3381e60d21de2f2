"""The signature of ``stackloft phantom``; what it does is imported when it runs."""

# ruff: noqa: PLC0415 - imports inside the commands keep `stackloft --help` quick

from __future__ import annotations

import typer

from stackloft.cli import arguments as a
from stackloft.cli import phantom_arguments as p
from stackloft.cli.guard import answering

phantom_commands = typer.Typer()


@phantom_commands.command()
@answering
def phantom(  # noqa: PLR0913, PLR0917 - one parameter per flag is how Typer declares them
    name: p.PhantomName,
    form: p.Form,
    out: p.PhantomOut,
    parameters: p.Parameters = None,
    sections: p.Sections = None,
    placing: p.Placing = None,
    pixel_size: a.PixelSize = None,
    rotation: p.Rotation = None,
    offset: p.Offset = None,
    realistic: p.Realistic = False,
    seed: p.Seed = None,
    plate: p.Plate = None,
    suffix: p.Suffix = None,
    camera: p.PhantomCamera = None,
    reference: p.PhantomReference = None,
    reference_height: p.ReferenceHeight = None,
    reference_stays: p.ReferenceStays = False,
    reference_once: p.ReferenceOnce = False,
    tell: p.Tell = None,
    levels: p.Levels = None,
    noise: p.Noise = None,
    bias: p.BiasField = None,
    fill: p.Fill = None,
    slab_points: p.SlabPoints = None,
    tilt: p.Tilt = None,
    cosines: p.Cosines = None,
    origin: p.Origin = None,
    aspect: p.Aspect = None,
    stretch: p.Stretch = None,
    empty: p.Empty = None,
    margin: p.Margin = None,
    label: p.LabelNumber = None,
    syntax: p.Syntax = None,
    multiframe: p.Multiframe = False,
) -> None:
    """Write a stack whose volume and area are known, to try things on."""
    from stackloft.cli.phantom import run

    options = {
        "sections": sections,
        "placing": placing,
        "pixel_size": pixel_size,
        "rotation": rotation,
        "offset": offset,
        "realistic": realistic or None,
        "seed": seed,
        "plate": plate,
        "suffix": suffix,
        "camera": camera,
        "reference": reference,
        "reference_height": reference_height,
        "reference_stays": reference_stays or None,
        "reference_once": reference_once or None,
        "tell": tell,
        "levels": levels,
        "noise": noise,
        "bias": bias,
        "fill": fill,
        "slab_points": slab_points,
        "tilt": tilt,
        "cosines": cosines,
        "origin": origin,
        "aspect": aspect,
        "stretch": stretch,
        "empty": empty,
        "margin": margin,
        "label": label,
        "syntax": syntax,
        "multiframe": multiframe or None,
    }
    run(name, form, out, options, parameters or ())
