"""Untidy stacks with one slice blurred and one outlined wrongly measure right when repaired by hand."""

import json
from dataclasses import replace
from itertools import product

import cv2
import numpy as np
import pytest
from PIL import Image

import stackloft
from stackloft.model.errors import InputError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.kitchen import Kitchen
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism

BOUNDS = (0.7, 1.2)  # percent, V and S
BLURRED, WRONG = 4, 8
BODIES = {
    "meat": ("faces", {}),
    "apple": ("mid", {}),
    "potato": ("mid", {"seed": 1}),
    "banana": ("mid", {}),
    "two-lobed": ("mid", {}),
    "superellipsoid": ("mid", {}),
}
PLATES = ("white", "black")
SEEDS = (1,)
SECTIONS = (10, 13)
TELL = ("kind", "pixel_size", "thickness", "specimen", "height", "ends")
REPAIRS = {
    "skip, mask": ("skip", "mask"),
    "mask, mask": ("mask", "mask"),
    "threshold, mask": ("threshold", "mask"),  # on black: on white a shadow is as dark as the blurred rim
    "skip, threshold": ("skip", "threshold"),  # meat on white: darker than the plate in the deep shadow
}
"""What is done about the slice out of focus and about the one outlined wrongly."""
BY_COLOUR = {("apple", "white")}
"""Flesh nearly as light as its plate, told from it by colour."""


def kitchen_stack(folder, name, plate, seed, sections=13, pixel_size=0.3):
    """Write an untidy stack; return its camera, the exact outlines and the answer."""
    placing, parameters = BODIES[name]
    phantom = phantoms.make(name, **parameters)
    mishap = {"shaded": WRONG} if plate == "white" else {"lamps": (WRONG, sections - 1)}
    look = replace(Realism.of(name, seed=seed), kitchen=Kitchen(blurred=BLURRED, **mishap), light=0.25)
    camera = Photographs(
        sections=sections, placing=placing, pixel_size=pixel_size, realism=look, plate=plate,
        suffix="jpg", tell=TELL,
    )  # fmt: skip
    camera.write(phantom, folder)
    positions = phantom.positions(sections, placing)
    cuts = [phantom.section(float(z), 2000) for z in positions]
    known = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    frames = camera.frames(cuts, positions)
    seen = [coverage(frame.polygons(cut), frame.shape) for frame, cut in zip(frames, cuts, strict=True)]
    return seen, np.array([known["volume"]["value"], known["area"]["value"]])


def drawn_by_hand(covered, seed):
    """A mask as drawn with a mouse: the outline wanders by half a pixel, and has no grey rim."""
    rng = np.random.default_rng(seed)
    wander = cv2.GaussianBlur(rng.normal(size=covered.shape), (0, 0), 8)
    soft = cv2.GaussianBlur(covered, (0, 0), 2)
    return np.where(soft + 0.1 * wander / wander.std() > 0.5, 255, 0).astype(np.uint8)


def picked(picture, covered):
    """The grey half-way between what a person picks on the flesh and on the darkest plate beside it."""
    grey = np.asarray(Image.open(picture).convert("L"), dtype=float)
    deep = cv2.erode((covered > 0.5).astype(np.uint8), np.ones((31, 31), np.uint8))
    near, far = (
        cv2.dilate((covered > 0.5).astype(np.uint8), np.ones((k, k), np.uint8)) > 0 for k in (27, 45)
    )
    return 0.5 * (np.median(grey[deep > 0]) + np.percentile(grey[far & ~near], 20))


def suits(how, name, plate):
    return {"threshold, mask": plate == "black", "skip, threshold": (name, plate) == ("meat", "white")}.get(
        how, True
    )


def repair(folder, seen, how, seed):
    for old in folder.glob("mask_*.png"):
        old.unlink()
    lines = []
    for number, repaired in zip((BLURRED, WRONG), REPAIRS[how], strict=True):
        lines.append(f"[slice.{number}]")
        covered = seen[number - 1]
        if repaired == "mask":
            Image.fromarray(drawn_by_hand(covered, seed)).save(folder / f"mask_{number}.png")
            lines.append(f'mask = "mask_{number}.png"')
        elif repaired == "threshold":
            lines.append(f"threshold = {picked(folder / f'slice_{number:02d}.jpg', covered):.1f}")
        else:
            lines.append("skip = true")
    text = (folder / "stack.toml").read_text(encoding="utf-8").split("[slice")[0]
    (folder / "stack.toml").write_text(text + "\n".join(lines) + "\n", encoding="utf-8")


def measured(folder, exact, segmenter):
    result = stackloft.measure(folder, segmenter=segmenter)
    one = result.objects[0]
    return 100 * (np.array([one.volume.value, one.area.value]) / exact - 1), result.warnings


def blamed(folder, exact, segmenter):
    """What is said of the wrongly outlined slice before it is repaired."""
    name = f"slice_{WRONG:02d}.jpg"
    try:
        _, warnings = measured(folder, exact, segmenter)
    except InputError as error:
        return f"refused: {str(error).split(': ')[1]}" if name in str(error) else ""
    about = [one.code for one in warnings if name in one.message and one.code != "hole-filled"]
    return ", ".join(dict.fromkeys(about))


def said(folder):
    """What is said of a stack, be it measured or refused."""
    try:
        return " ".join(one.message for one in stackloft.measure(folder).warnings)
    except InputError as error:
        return str(error)


def check(folder, name, plate, seed, repairs=REPAIRS, **options):
    seen, exact = kitchen_stack(folder, name, plate, seed, **options)
    segmenter = "colour" if (name, plate) in BY_COLOUR else None
    before = blamed(folder, exact, segmenter)
    rows = []
    for how in [one for one in repairs if suits(one, name, plate)]:
        repair(folder, seen, how, seed)
        error, warnings = measured(folder, exact, segmenter)
        codes = {one.code for one in warnings}
        assert not codes & {"border-contact", "misaligned", "motion", "wrong-order", "slice-missing"}
        assert plate == "white" or codes & {"edge-object", "second-object"}
        rows.append((how, *error))
    return before, rows


@pytest.mark.parametrize(("plate", "how"), [("white", "skip, mask"), ("black", "threshold, mask")])
def test_a_repaired_stack_measures_right(tmp_path, plate, how):
    before, rows = check(tmp_path, "banana", plate, 1, [how], sections=SECTIONS[0])
    assert before
    assert (np.abs([row[1:] for row in rows]) <= np.array(BOUNDS)).all()


def test_a_pale_apple_on_white_is_measured_by_colour(tmp_path):
    before, rows = check(tmp_path, "apple", "white", 1, ["skip, mask"])
    assert before
    assert (np.abs([row[1:] for row in rows]) <= np.array(BOUNDS)).all()


@pytest.mark.parametrize("kitchen", [None, Kitchen()])
def test_a_pale_apple_on_white_is_never_measured_by_grey_without_a_word(tmp_path, kitchen):
    look = replace(Realism.of("apple", seed=2), kitchen=kitchen)
    camera = Photographs(sections=9, pixel_size=0.4, realism=look, plate="white", suffix="jpg", tell=TELL)
    camera.write(phantoms.make("apple"), tmp_path)
    assert "--segmenter colour" in said(tmp_path)


@pytest.mark.prove
def test_every_untidy_stack_repaired(tmp_path, proof):
    rows, worst, silent = [], np.zeros(2), []
    for name in BODIES:
        for plate in PLATES:
            for seed, sections in product(SEEDS, SECTIONS):
                folder = tmp_path / f"{name}-{plate}-{seed}-{sections}"
                before, found = check(folder, name, plate, seed, sections=sections)
                silent += [] if before else [(name, plate, seed, sections)]
                for how, volume, area in found:
                    worst = np.maximum(worst, np.abs([volume, area]))
                    case = (name, plate, sections, seed, before, how)
                    rows.append((*case, f"{volume:+.2f}", f"{area:+.2f}"))
    rows.append(("**worst**", "", "", "", "", "", f"{worst[0]:.2f}", f"{worst[1]:.2f}"))
    claim = (
        "Kitchen photographs (light 25 % uneven, shadow, juice, reflections, crumbs), one slice blurred by "
        "2 mm, one outlined wrongly (a deep shadow over half the plate; on black a lamp mirrored beside the "
        "body), repaired in stack.toml: V within 0.7 %, S within 1.2 %; the pale apple on white by "
        "--segmenter colour"
    )
    header = ("body", "plate", "slices", "seed", "said before of the wrong slice", "blurred, wrong slice")
    proof("repaired-stacks", claim, (*header, "V error %", "S error %"), rows)
    assert not silent
    assert (worst <= BOUNDS).all()
