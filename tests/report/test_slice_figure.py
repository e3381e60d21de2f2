"""Figure 3: the slice that is chosen, each step of it, and the curve where the body's edge is."""

import io

import cv2
import numpy as np
import pytest
from PIL import Image

from stackloft.model.errors import UsageError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.report import slice_figure
from stackloft.report.figure_sink import SIDE, FigureSink
from stackloft.report.loft_lines import LoftLine
from stackloft.report.slice_figure import write_slice_figure

RADII = (10.0, 18.0, 14.0)
CENTRE = (31.0, 27.0)


def figure(wanted=None, *, dark=True, colour=True):
    """Return what the sink keeps of three discs (mm) on a light or dark plate."""
    rows, columns = np.mgrid[:120, :140] * 0.5

    def decode(k):
        body = np.hypot(columns - CENTRE[0], rows - CENTRE[1]) < RADII[k]
        grey = np.where(body == dark, 60, 220).astype(np.uint8)
        return np.stack([grey, grey // 2, grey // 3], axis=2) if colour else grey

    names = ("a.png", "b.png", "c.png")
    stack = SliceStack(decode, names, (120, 140), 5.0 * np.arange(3), np.full((3, 2), 0.5), SectionKind.FACE)

    def field_of(k, picture):
        grey = picture[4:116, 6:134].astype(float)
        grey = grey[..., 0] if colour else grey
        return SectionField(-grey if dark else grey, -140.0 if dark else 140.0, (4, 6), 140.0)

    sink = FigureSink(wanted)
    sink.begin(Segmentation(stack, field_of))
    for k in range(3):
        picture = decode(k)
        sink.add(k, picture, field_of(k, picture))
    return sink.end()


def sheet(kept, lines=()):
    stream = io.BytesIO()
    write_slice_figure(kept, lines, stream)
    return np.asarray(Image.open(stream).convert("RGB")).astype(int)


@pytest.mark.parametrize(("wanted", "number"), [(None, 2), ("3", 3), ("a.png", 1)])
def test_the_largest_section_or_the_one_asked_for(wanted, number):
    kept = figure(wanted)
    assert (kept.number, kept.name, kept.z) == (number, "abc"[number - 1] + ".png", 5.0 * (number - 1))
    area = (kept.binary[..., 0] > 127).sum() / (kept.per_mm[0] * kept.per_mm[1])
    assert area == pytest.approx(np.pi * RADII[number - 1] ** 2, rel=0.01)


@pytest.mark.parametrize("wanted", ["0", "4", "d.png", "-1"])
def test_a_slice_that_is_not_there_is_wrong_usage(wanted):
    with pytest.raises(
        UsageError, match=r"--figure-slice: no such slice; .* from 1 to 3, or a name such as a.png"
    ):
        figure(wanted)


@pytest.mark.parametrize("dark", [True, False])
def test_every_step_shows_the_picture_s_own_grey(dark):
    kept = figure(dark=dark)
    assert max(kept.picture.shape) == SIDE
    assert kept.picture.shape == kept.grey.shape == kept.binary.shape
    assert kept.colour
    assert (kept.levels, kept.threshold) == ((60.0, 220.0), 140.0)
    inside = kept.binary[..., 0] > 250
    assert np.median(kept.grey[inside]) == (0 if dark else 255)
    assert kept.histogram.sum() == 112 * 128
    assert not figure(colour=False).colour


def test_the_curve_is_drawn_where_the_edge_is():
    kept = figure()
    angle = np.linspace(0, 2 * np.pi, 33, endpoint=False)
    fine = np.linspace(0, 2 * np.pi, 800, endpoint=False)

    def ring(at):
        return np.column_stack([CENTRE[0] + 18 * np.cos(at), CENTRE[1] + 18 * np.sin(at), 0 * at])

    line = LoftLine(ring(fine), ring(angle)[:0])
    drawn = slice_figure._drawn(np.full_like(kept.picture, 255), kept, [line])
    marked = np.argwhere((drawn < 200).any(axis=2))
    inside = (kept.binary[..., 0] > 127).astype(int)
    edge = np.argwhere((np.abs(np.diff(inside, axis=0))[:, :-1] + np.abs(np.diff(inside, axis=1))[:-1]) > 0)
    away = np.linalg.norm(marked[:, None] - 0.5 - edge[None], axis=2)
    assert away.min(axis=1).max() < 5.0  # half a pixel of the photograph, 2.3 of the panel's, and the pen
    assert away.min(axis=0).max() < 5.0
    dotted = slice_figure._drawn(np.full_like(kept.picture, 255), kept, [LoftLine(ring(fine), ring(angle))])
    blue = (dotted[..., 2].astype(int) - dotted[..., 0] > 100).astype(np.uint8)
    assert cv2.connectedComponents(blue)[0] - 1 == 33
    assert (sheet(kept) != sheet(kept, [line])).any()


def test_without_points_it_is_a_contour():
    kept = figure()
    line = np.column_stack([*(np.array([[20, 40, 30], [20, 22, 40]])), np.zeros(3)])
    assert sheet(kept, [LoftLine(line, line[:0])]).shape == sheet(kept).shape
