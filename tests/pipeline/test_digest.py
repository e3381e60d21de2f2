"""The source's fingerprint depends on names and contents, and on nothing else."""

import os

import numpy as np
import pytest

from stackloft.model.arrays import frozen_floats
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.pipeline.digest import digest_of, digest_of_value


@pytest.fixture
def source(tmp_path):
    folder = tmp_path / "source"
    (folder / "deep").mkdir(parents=True)
    for name in ("b.png", "a.png", "deep/c.png"):
        (folder / name).write_text(name)
    return folder


def test_place_and_dates_do_not_matter(source, tmp_path):
    before = digest_of(source)
    os.utime(source / "a.png", (1, 1))
    moved = source.rename(tmp_path / "elsewhere")
    assert digest_of(moved) == before


@pytest.mark.parametrize("change", ["content", "name", "name alone", "new file", "swap"])
def test_contents_and_names_matter(source, change):
    before = digest_of(source)
    if change == "content":
        (source / "a.png").write_text("other")
    elif change == "name":
        (source / "a.png").rename(source / "d.png")
    elif change == "name alone":
        (source / "b.png").rename(source / "bb.png")
    elif change == "new file":
        (source / "e.png").write_text("")
    else:
        (source / "a.png").write_text("b.png")
        (source / "b.png").write_text("a.png")
    assert digest_of(source) != before


def test_hidden_files_and_earlier_runs_do_not_matter(source):
    before = digest_of(source)
    (source / ".DS_Store").write_text("x")
    (source / ".git").mkdir()
    (source / ".git" / "index").write_text("x")
    (source / "out").mkdir()
    (source / "out" / "measurement.json").write_text("{}")
    (source / "out" / "solid.stl").write_text("x")
    assert digest_of(source) == before


def test_the_order_in_which_folders_are_listed_does_not_matter(source, monkeypatch):
    before, walk = digest_of(source), os.walk

    def backwards(top):
        for folder, folders, names in walk(top):
            folders.sort(reverse=True)
            yield folder, folders, sorted(names, reverse=True)

    monkeypatch.setattr(os, "walk", backwards)
    assert digest_of(source) == before


def test_one_file_and_a_pattern(source):
    assert digest_of(source / "a.png") == digest_of(source / "a.*")
    assert digest_of(source / "*.png") != digest_of(source)


def test_a_file_that_cannot_be_read_is_named(source, monkeypatch):
    from pathlib import Path  # noqa: PLC0415

    real = Path.open

    def refuse(self, *arguments, **more):
        if self.name == "b.png":
            raise PermissionError(13, "Permission denied")
        return real(self, *arguments, **more)

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(InputError, match=r"b\.png: cannot be read; found: Permission denied"):
        digest_of(source)


def stack(z=1.0, points=((0, 0), (1, 0), (0, 1))):
    return ContourStack((Section(z, (Loop(frozen_floats(points)),), "a"),))


def test_products_in_memory():
    assert digest_of_value(stack()) == digest_of_value(stack())
    others = [stack(z=2.0), stack(points=((0, 0), (1, 0), (0, 1.0000001))), ContourStack(())]
    assert len({digest_of_value(x) for x in (stack(), *others)}) == 4
    assert digest_of_value(np.zeros(2)) != digest_of_value(np.zeros((2, 1)))
