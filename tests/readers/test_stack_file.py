"""``stack.toml`` is believed when it is right and refused by key when it is wrong."""

import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st

from stackloft.contracts.stack_file import StackFile, parse_stack_file
from stackloft.model.errors import InputError, StackloftError

LENGTHS = st.floats(1e-3, 1e4)


@given(pixel=LENGTHS, thickness=LENGTHS, weight=LENGTHS, name=st.text(), skip=st.booleans())
def test_what_is_written_is_read(pixel, thickness, weight, name, skip):
    text = tomli_w.dumps(
        {
            "pixel_size": pixel,
            "thickness": f"{thickness!r}mm",
            "measured_weight": f"{weight!r} g",
            "specimen": name,
            "slice": {"3": {"skip": skip}},
        }
    )
    said = parse_stack_file(text)
    assert (said.pixel_size, said.thickness, said.measured_weight) == (pixel, thickness, weight)
    assert said.specimen == name
    assert said.slice[3].skip is skip


def complaint(parse, *given):
    try:
        parse(*given)
    except StackloftError as error:
        return str(error)
    return ""


@given(text=st.text())
def test_any_text_is_read_or_refused_in_one_line(text):
    assert len(complaint(parse_stack_file, text).splitlines()) <= 1


VALUES = st.one_of(st.booleans(), st.integers(), st.text("ab0.,-", max_size=5), st.lists(st.integers()))


@given(key=st.sampled_from(list(StackFile.model_fields)), value=VALUES)
def test_any_value_is_read_or_refused_by_its_key_in_one_line(key, value):
    message = complaint(parse_stack_file, tomli_w.dumps({key: value}))
    assert not message or (key in message and len(message.splitlines()) == 1)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("pixelsize = 1", "unknown key 'pixelsize'.*did you mean 'pixel_size'"),
        ("[slice.3]\nthresh = 3", "unknown key 'slice.3.thresh'.*did you mean 'threshold'"),
        ("qqq = 1", "known keys: kind, pixel_size"),
        ("pixel_size = 0", "pixel_size is wrong"),
        ("pixel_size = true", "pixel_size is wrong: not a length"),
        ('thickness = "5 ells"', "thickness is wrong: unknown unit"),
        ('ends = "flatt"', "ends is wrong: unknown end"),
        ("[slice.0]\nskip = true", "slice.0 is wrong"),
        ("[slice.one]\nskip = true", "slice.one is wrong"),
        ('[slice.1]\nskip = "yes"', "slice.1.skip is wrong"),
        ('[slice.1]\nmask = "../mask.png"', "slice.1.mask is wrong.*same folder"),
        ('measured_volume = "3 pints"', "measured_volume is wrong"),
        ("pixel_size = ", "is not valid TOML"),
        ('background = "grey"', "background is wrong"),
    ],
)
def test_wrong_files(text, words):
    with pytest.raises(InputError, match=words):
        parse_stack_file(text, "apple/stack.toml")


@pytest.mark.parametrize(
    ("text", "volume"),
    [
        ('"215 mL"', 215e3),
        ('"0.2 L"', 200e3),
        ('"3cm3"', 3e3),
        ('"3 cm^3"', 3e3),
        ('"7mm³"', 7.0),
        ("12.5", 12.5),
    ],
)
def test_volumes_with_units(text, volume):
    assert parse_stack_file(f"measured_volume = {text}").measured_volume == pytest.approx(volume)


def test_ends_and_positions_as_lists():
    said = parse_stack_file('ends = ["face", "round:2mm"]\npositions = [0, "0.5cm", 9.5]')
    assert [str(end) for end in said.ends] == ["face", "round:2mm"]
    assert said.positions == (0.0, 5.0, 9.5)
