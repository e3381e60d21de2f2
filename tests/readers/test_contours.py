"""Contour tables give back the loops that were written, and name file and line otherwise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft.model.errors import InputError, StackloftError
from stackloft_plugins.readers.contour_rows import looks_like_contours, parse_contours
from stackloft_plugins.readers.contours import ContoursReader

HEADER = "section,z,loop,x,y"
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]


def table(*loops, header=HEADER):
    lines = [header]
    for section, z, label, points in loops:
        lines += [f"{section},{z},{label},{x!r},{y!r}" for x, y in points]
    return "\n".join(lines)


def read(tmp_path, text, name="body.csv"):
    (tmp_path / name).write_text(text)
    return ContoursReader().read(tmp_path / name)


def test_a_box(tmp_path):
    stack = read(tmp_path, table((2, 10.0, 1, SQUARE), (1, 5.0, 1, SQUARE[::-1])))
    assert stack.exact
    assert stack.resolution == 0
    assert stack.positions.tolist() == [5.0, 10.0]
    for section in stack.sections:
        (loop,) = section.loops
        assert loop.signed_area == 12.0
        assert loop.corners.tolist() == [0, 1, 2, 3]


def test_a_repeated_end_point_is_dropped_and_comments_are_passed_over(tmp_path):
    text = "# by hand\n\n" + table((1, 0, 1, [*SQUARE, SQUARE[0]]), (2, 1, 1, [SQUARE[0], *SQUARE]))
    assert [len(section.loops[0].points) for section in read(tmp_path, text).sections] == [4, 4]


def test_the_corner_column_is_believed(tmp_path):
    rows = [f"{s},{s},1,{x},{y},{int(x == 4)}" for s in (1, 2) for x, y in SQUARE]
    stack = read(tmp_path, "\n".join([HEADER + ",corner", *rows]))
    assert stack.sections[0].loops[0].corners.tolist() == [1, 2]


def test_corner_marks_follow_their_vertex_when_a_loop_is_turned_round(tmp_path):
    rows = [f"{s},{s},1,{x},{y},{int((x, y) == (4.0, 3.0))}" for s in (1, 2) for x, y in SQUARE[::-1]]
    loop = read(tmp_path, "\n".join([HEADER + ",corner", *rows])).sections[0].loops[0]
    assert loop.signed_area > 0
    assert loop.points[loop.corners].tolist() == [[4.0, 3.0]]


def test_a_loop_within_a_loop_is_a_hole(tmp_path):
    inner = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)]
    stack = read(tmp_path, table(*[(s, s, k, p) for s in (1, 2) for k, p in ((1, inner), (2, SQUARE))]))
    outer, hole = stack.sections[0].loops
    assert (outer.hole, hole.hole) == (False, True)
    assert (outer.signed_area, hole.signed_area) == (12.0, -0.5)


def test_stack_toml_beside_the_table(tmp_path):
    (tmp_path / "stack.toml").write_text('ends = "face"\nheight = "2cm"\nspecimen = "box"')
    text = table((1, 0, 1, SQUARE), (2, 20, 1, SQUARE))
    hints = read(tmp_path, text).hints
    assert (str(hints.ends[1]), hints.height, hints.specimen) == ("face", 20.0, "box")
    assert len(ContoursReader().read(tmp_path)) == 2


def test_probe(tmp_path):
    (tmp_path / "a.csv").write_text(table((1, 0, 1, SQUARE)))
    (tmp_path / "b.csv").write_text("x,y\n1,2")
    reader = ContoursReader()
    assert reader.probe(tmp_path / "a.csv") == 0.9
    assert reader.probe(tmp_path / "b.csv") == 0.0
    assert reader.probe(tmp_path) == 0.7
    assert reader.probe(tmp_path / "gone") == 0.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "empty"),
        ("section,z,loop,x\n", "column 'y' is missing"),
        (HEADER + ",colour\n", "unknown column 'colour'"),
        (HEADER + "\n1,0,1,a,0", "line 2: x is no number"),
        (HEADER + "\n1,0,1,nan,0", "line 2: x is no number"),
        (HEADER + "\n1,0,1,1e999,0", "line 2: x is no number"),
        (HEADER + "\n1,0,1,0", "line 2: wrong number of values"),
        (HEADER + "\n1,0,1,0,0\n1,0.5,1,1,0", "line 3: section 1 lies at two positions"),
        (HEADER + ",corner\n1,0,1,0,0,maybe", "line 2: corner is neither"),
        (table((1, 0, 1, SQUARE)), "one section makes no body"),
        (table((1, 0, 1, SQUARE), (2, 0, 1, SQUARE)), "positions must increase"),
        (table((1, 0, 1, SQUARE[:2]), (2, 1, 1, SQUARE)), "line 2: a loop needs at least 3 points"),
        (table((1, 0, 1, [(0, 0), (1, 1), (2, 2)]), (2, 1, 1, SQUARE)), "encloses no area"),
        (
            table((1, 0, 1, SQUARE), (1, 0, 2, [(2, 1), (9, 1), (9, 2)]), (2, 1, 1, SQUARE)),
            "section 1: loops cross each other",
        ),
    ],
)
def test_wrong_tables_name_file_and_line(tmp_path, text, words):
    with pytest.raises(InputError, match=words) as caught:
        read(tmp_path, text)
    assert "body.csv" in str(caught.value)


def test_a_loop_said_to_be_a_hole_must_be_one(tmp_path):
    rows = [f"{s},{s},1,{x},{y},1" for s in (1, 2) for x, y in SQUARE]
    with pytest.raises(InputError, match="contradicts the nesting"):
        read(tmp_path, "\n".join([HEADER + ",hole", *rows]))


NUMBERS = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(points=st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=20), z=NUMBERS)
def test_numbers_are_read_to_the_bit(points, z):
    parsed = parse_contours(table((1, repr(z), 1, points)).splitlines(), "a.csv")
    assert parsed.sections["1"].loops["1"].points == points
    assert parsed.sections["1"].z == z


def complaint(parse, *given):
    try:
        parse(*given)
    except StackloftError as error:
        return str(error)
    return ""


@given(text=st.text())
@settings(max_examples=200)
def test_any_text_is_read_or_refused_in_one_line(text):
    looks_like_contours(text)
    message = complaint(parse_contours, f"{HEADER}\n{text}".splitlines(), "a.csv")
    assert len(message.splitlines()) <= 1


@given(start=st.integers(0, 11), backwards=st.booleans())
def test_neither_start_nor_direction_matters(tmp_path_factory, start, backwards):
    angle = 2 * np.pi * np.arange(12) / 12
    circle = np.column_stack([3 * np.cos(angle), 2 * np.sin(angle)])
    points = np.roll(circle, start, axis=0)[:: -1 if backwards else 1].tolist()
    stack = read(tmp_path_factory.mktemp("c"), table((1, 0, 1, points), (2, 1, 1, circle.tolist())))
    assert stack.sections[0].loops[0].signed_area == pytest.approx(
        stack.sections[1].loops[0].signed_area, rel=1e-14
    )
