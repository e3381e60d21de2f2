"""Tables of specimens: what is understood, and what is refused with row and column."""

import pytest

from stackloft.model.errors import InputError
from stackloft.studies.specimen_table import parse_table, read_table

HEADER = "sample,group,weight_g,volume_measured_cm3,volume_estimated_cm3,area_estimated_cm2"
ROWS = "a,g,200,190,188,150\nb,g,210,200,199,160\n"


def test_a_plain_table():
    first, second = parse_table(f"# from the paper\n{HEADER}\n\n{ROWS}")
    assert (first.sample, first.group, first.weight, second.area_estimated) == ("a", "g", 200.0, 160.0)
    assert first.relative_error == pytest.approx(100 * (188 / 190 - 1))
    assert first.density == pytest.approx(200 / 190)


@pytest.mark.parametrize(
    "text",
    [
        (
            "sample;group;weight (kg);measured volume [ml];volume (mm³);Surface area [mm^2]\n"
            "a;g;0,2;190;188000;15000\nb;g;0,21;200;199000;16000\n"
        ),
        "ID\tvariety\tMass_g\tV_measured_cc\tV_L\tS_cm2\na\tg\t200\t190\t0,188\t150\nb\tg\t210\t200\t.199\t160\n",
        HEADER + ",remark,\n" + 'a,g,200,190,188,150,"fresh, cold",\nb,g,2.1e2,200,199,160,\n;;;\n',
    ],
)
def test_other_words_units_and_separators_are_the_same_table(text):
    for got, expected in zip(parse_table(text), parse_table(f"{HEADER}\n{ROWS}"), strict=True):
        assert (got.sample, got.group) == (expected.sample, expected.group)
        for name in ("weight", "volume_measured", "volume_estimated", "area_estimated"):
            assert getattr(got, name) == pytest.approx(getattr(expected, name))


def test_without_a_group_column_all_are_one_group_and_rows_without_names_are_numbered():
    text = f"{HEADER}\n{ROWS}".replace("sample,group,", "").replace("a,g,", "").replace("b,g,", "")
    assert [(x.group, x.sample) for x in parse_table(text)] == [("all", "2"), ("all", "3")]


def test_a_byte_order_mark_and_windows_lines(tmp_path):
    path = tmp_path / "t.csv"
    path.write_bytes(b"\xef\xbb\xbf" + f"{HEADER}\n{ROWS}".replace("\n", "\r\n").encode())
    assert len(read_table(path)) == 2


def changed(row, column, cell):
    lines = [line.split(",") for line in f"{HEADER}\n{ROWS}".splitlines()]
    lines[row - 1][column] = cell
    return "\n".join(",".join(line) for line in lines)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["empty"]),
        ("\n# only this\n", ["empty"]),
        (HEADER, ["no rows"]),
        (changed(1, 2, "remark"), ["row 1", "weight_g is missing", "mass"]),
        (changed(1, 2, "weight"), ["row 1", "'weight'", "unit", "weight_g"]),
        (changed(1, 2, "weight_cm3"), ["row 1", "'weight_cm3'", "unit cm3"]),
        (changed(1, 0, "mass_g"), ["row 1", "two columns", "weight", "'mass_g'"]),
        (changed(3, 2, "abc"), ["row 3", "'weight_g'", "not a number", "'abc'"]),
        (changed(2, 3, "0"), ["row 2", "'volume_measured_cm3'", "positive"]),
        (changed(2, 5, "-3"), ["row 2", "'area_estimated_cm2'", "positive"]),
        (changed(2, 5, "nan"), ["row 2", "'area_estimated_cm2'", "not a number"]),
        (changed(2, 5, "1e999"), ["row 2", "'area_estimated_cm2'", "positive"]),
        (changed(2, 4, ""), ["row 2", "'volume_estimated_cm3'", "empty"]),
        (changed(3, 1, ""), ["row 3", "'group'", "empty"]),
        (changed(3, 1, "h"), ["row 2", "'group'", "'g'", "one row"]),
        (changed(3, 0, "a"), ["row 3", "'sample'", "'a'", "row 2"]),
        (changed(3, 2, "210,5"), ["row 3", "more cells", "decimal commas"]),
        (changed(3, 2, '"210,5"'), ["row 3", "'weight_g'", "not a number", "point"]),
        (f"{HEADER}\n{ROWS}".replace(",", ";").replace("200;190", "1.200,5;190"), ["row 2", "'weight_g'"]),
        (changed(3, 0, '"open'), ["row 3", "quotes"]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_row_and_column(text, words):
    with pytest.raises(InputError) as caught:
        parse_table(text, "t.csv")
    message = str(caught.value)
    assert message.startswith("t.csv")
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("content", "words"),
    [(None, "no such file"), (b"a,\xff\xfe", "UTF-8"), (b"a\0b", "no text")],
)
def test_a_file_that_is_no_table(tmp_path, content, words):
    path = tmp_path / "t.csv"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_table(path)
