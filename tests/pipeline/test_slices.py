"""The route of slices: one decoding pass feeds every sink, and crashes are blamed on their plug-in."""

import re
import weakref

import numpy as np
import pytest
from PIL import Image

import stackloft
from stackloft.model.errors import InputError, PluginError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.pipeline.recipe_file import load_recipe, write_recipe
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure

PIXEL, PITCH, RADII = 0.5, 4.0, (9.0, 14.0, 16.0, 15.0, 11.0)


def disk(radius):
    """Return an anti-aliased grey disk, dark on light."""
    rows, columns = np.mgrid[:90, :100] * PIXEL
    distance = np.hypot(columns - 25, rows - 22)
    return (235 - 150 * np.clip((radius - distance) / PIXEL + 0.5, 0, 1)).round().astype(np.uint8)


@pytest.fixture
def folder(tmp_path):
    source = tmp_path / "body"
    source.mkdir()
    for k, radius in enumerate(RADII, start=1):
        Image.fromarray(disk(radius)).save(source / f"slice_{k}.png")
    return source


FLAGS = {"pixel_size": PIXEL, "thickness": PITCH}


def counting_stack(decoded, fail=None):
    def decode(k):
        decoded.append(k)
        if k == fail:
            raise OSError("bad sector")
        return disk(RADII[k])

    m = len(RADII)
    return SliceStack(
        decode,
        tuple(f"s{k}" for k in range(m)),
        (90, 100),
        PITCH * np.arange(m),
        np.full((m, 2), PIXEL),
        SectionKind.FACE,
    )


class Recorder:
    """A sink that notes what it was given."""

    def __init__(self):
        self.calls = []

    def begin(self, segmentation):
        self.calls.append(len(segmentation))

    def add(self, index, picture, section_field):
        assert isinstance(section_field, SectionField)
        self.calls.append((index, picture.shape))

    def end(self):
        return self.calls


def test_a_folder_of_photographs(folder):
    outcome = measure(MeasureRequest(folder, method="loft,cavalieri", shared={**FLAGS, "ends": "face"}))
    body = outcome.result.objects[0]
    areas = np.pi * np.square(RADII)
    assert [row.area for row in body.sections] == pytest.approx(areas, rel=2e-3)
    assert body.methods["cavalieri"].volume.value == pytest.approx(areas.sum() * PITCH, rel=2e-3)
    assert outcome.segmentation is not None
    assert outcome.stack is not None
    assert outcome.result.recipe["segmenter"] == "histogram"
    assert "sections" in outcome.result.provenance["seconds"]


def test_every_slice_is_decoded_once_for_all_methods_and_sinks():
    decoded, sinks = [], (Recorder(), Recorder())
    request = MeasureRequest("memory", method="all", shared={})
    outcome = measure(request, product=counting_stack(decoded), sinks=sinks)
    expected = [len(RADII), *((k, (90, 100)) for k in range(len(RADII)))]
    assert outcome.sink_products == (expected, expected)
    assert sorted(decoded) == list(range(len(RADII)))


def test_few_pictures_are_in_memory_at_a_time():
    m, seen, alive = 40, [], []

    class Picture(np.ndarray):
        """An array that can be watched."""

    def decode(k):
        picture = disk(15.0).view(Picture)
        seen.append(weakref.ref(picture))
        alive.append(sum(reference() is not None for reference in seen))
        return picture

    spacing = np.full((m, 2), PIXEL)
    names = tuple(f"s{k}" for k in range(m))
    stack = SliceStack(decode, names, (90, 100), PITCH * np.arange(m), spacing, SectionKind.FACE)
    measure(MeasureRequest("m", method="cavalieri"), product=stack)
    assert len(alive) == m
    assert max(alive) <= 5


def test_slices_in_memory_have_a_fingerprint_of_their_own(folder):
    digests = set()
    for _ in range(2):
        result = measure(MeasureRequest("m"), product=counting_stack([])).result
        digests.add(result.source["digest"])
    assert len(digests) == 1
    assert re.fullmatch("[0-9a-f]{64}", digests.pop())


def test_recipe_runs_again_to_the_bit(folder, tmp_path):
    shared = {**FLAGS, "ends": "face,round:2.5mm", "points": 21}
    settings = {"segmenter": {"method": "isodata"}, "cavalieri": {"rule": "trapezoid"}}
    first = measure(MeasureRequest(folder, method="all", shared=shared, settings=settings)).result
    with (tmp_path / "recipe.toml").open("wb") as stream:
        write_recipe(first.recipe, stream)
    again = measure(load_recipe(tmp_path / "recipe.toml", folder)).result
    assert again.objects[0].volume == first.objects[0].volume
    assert again.objects[0].area == first.objects[0].area
    assert again.objects[0].sections == first.objects[0].sections
    assert again.recipe == first.recipe
    assert again.source == first.source


def test_python_agrees_with_the_pipeline(folder):
    by_path = stackloft.measure(folder, **FLAGS, ends="face")
    stack = stackloft.read(folder, **FLAGS)
    by_product = stackloft.measure(stack, ends="face")
    by_request = measure(MeasureRequest(folder, shared={**FLAGS, "ends": "face"})).result
    volumes = {x.objects[0].volume.value for x in (by_path, by_product, by_request)}
    assert len(volumes) == 1
    assert by_product.source["reader"] == "python"


def test_reading_refuses_an_option_that_the_reader_does_not_have(folder):
    with pytest.raises(stackloft.UsageError, match=r"--pixelsize: .* did you mean pixel_size"):
        stackloft.read(folder, pixelsize=1)


def test_a_crash_while_decoding_names_nobody_when_the_stack_came_from_memory():
    with pytest.raises(OSError, match="bad sector"):
        measure(MeasureRequest("m"), product=counting_stack([], fail=3))


def test_a_crash_in_a_field_is_blamed_on_the_segmenter(monkeypatch, folder):
    from stackloft.registry import find  # noqa: PLC0415

    plugin = find("segmenter", "histogram").plugin

    def segment(self, stack):
        def field_of(index, picture):
            if index == 3:
                raise ZeroDivisionError("empty histogram")
            return SectionField(235.0 - picture, 75.0)

        return Segmentation(stack, field_of)

    monkeypatch.setattr(plugin, "segment", segment)
    with pytest.raises(PluginError, match=r"segmenter.histogram of stackloft .* ZeroDivisionError: empty"):
        measure(MeasureRequest(folder, shared=FLAGS))


def test_a_damaged_picture_is_named(folder):
    path = folder / "slice_4.png"
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(InputError, match=r"slice_4\.png"):
        measure(MeasureRequest(folder, shared=FLAGS))


def test_progress_counts_slices(folder):
    heard = []

    class Listener:
        def begin(self, stage, total):
            heard.append((stage, total))

        def advance(self, steps=1):
            heard.append(steps)

        def end(self):
            heard.append("end")

    measure(MeasureRequest(folder, shared=FLAGS), progress=Listener())
    start = heard.index(("sections", len(RADII)))
    assert heard[start + 1 : start + 2 + len(RADII)] == [1] * len(RADII) + ["end"]
