"""Flesh as grey as its plate is found by colour, its area right to a part of a pixel."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import stackloft
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft_plugins.segmenters.colour import colour_field

PLATE, FLESH = np.array([128.0, 128, 128]), np.array([190.0, 105, 100])


def scene(radius, noise=0.0, seed=0):
    rows, columns = np.mgrid[:200, :240]
    covered = np.clip(0.5 - (np.hypot(rows - 99.3, columns - 118.6) - radius), 0, 1)[..., None]
    picture = PLATE + (FLESH - PLATE) * covered
    return (picture + np.random.default_rng(seed).normal(0, noise, picture.shape)).clip(0, 255).round()


@pytest.mark.parametrize("noise", [0.0, 2.5])
def test_a_body_as_grey_as_the_plate_is_measured(noise):
    z = np.arange(9) * 2.0 - 8
    radii = np.sqrt(70**2 - (z / 0.15) ** 2)
    pictures = [scene(radius, noise, k).astype(np.uint8) for k, radius in enumerate(radii)]
    names = tuple(f"cut_{k}" for k in range(9))
    spacing = np.full((9, 2), 0.15)
    stack = SliceStack(lambda k: pictures[k], names, (200, 240), z, spacing, SectionKind.FACE)
    result = stackloft.measure(stack, segmenter="colour")
    areas = np.array([section.area for section in result.objects[0].sections])
    assert areas == pytest.approx(np.pi * (0.15 * radii) ** 2, rel=0.003)


def shaded(flesh, plate, strength):
    """A body of radius 60 on a bright plate, whose right half and a strip beside the body lie in shadow."""
    rows, columns = np.mgrid[:200, :240]
    far = np.hypot(rows - 99.3, columns - 118.6)
    light = 1 - strength / (1 + np.exp(-(columns - 150.0) / 3)) - 0.15 * np.exp(-(((far - 66) / 3) ** 2))
    covered = np.clip(0.5 - (far - 60), 0, 1)[..., None]
    ground = np.array(plate) * light[..., None]
    picture = ground + (np.array(flesh) - ground) * covered
    return (picture + np.random.default_rng(1).normal(0, 1.5, picture.shape)).clip(0, 255).round()


def found_area(picture):
    field = colour_field(picture.astype(np.uint8), None, "a.png")
    level = field.level if field.local_levels is None else field.local_levels
    return float((field.values > level).sum())


@pytest.mark.parametrize("strength", [0.0, 0.25, 0.5])
def test_shadows_on_a_bright_plate_are_no_flesh(strength):
    pale = shaded((231, 218, 176), (238, 237, 233), strength)
    assert found_area(pale) == pytest.approx(np.pi * 60**2, rel=0.01)


@pytest.mark.parametrize(
    ("flesh", "plate"), [((120, 119, 117), (238, 237, 233)), ((90, 90, 90), (20, 20, 22))]
)
def test_flesh_without_a_colour_of_its_own_is_told_by_its_brightness(flesh, plate):
    assert found_area(shaded(flesh, plate, 0.0)) == pytest.approx(np.pi * 60**2, rel=0.01)


def test_grey_and_empty_pictures_are_refused():
    with pytest.raises(InputError, match="histogram"):
        colour_field(np.zeros((30, 30), np.uint8), None, "a.png")
    with pytest.raises(InputError, match=r"a\.png: "):
        colour_field(scene(0.0, 2.0).astype(np.uint8), 40.0, "a.png")


def test_the_command_line_takes_it_by_name(tmp_path):
    for number in range(4):
        Image.fromarray(scene(60.0, 1.0, number).astype(np.uint8)).save(tmp_path / f"{number}.png")
    command = [Path(sys.executable).with_name("stackloft"), "measure", tmp_path, "--pixel-size", "0.2"]
    flags = ["--thickness", "5", "--ends", "face", "--segmenter", "colour", "--json", "--quiet"]
    run = subprocess.run([*command, *flags], check=False, capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    volume = json.loads(run.stdout)["objects"][0]["volume"]["value"]
    assert volume == pytest.approx(15 * np.pi * 12**2, rel=0.003)
