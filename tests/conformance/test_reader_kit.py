"""The reader checks let a correct reader through and catch seeded faults, each by its name."""

import os
import random
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from stackloft.contracts.options import option
from stackloft.model.arrays import frozen_floats, read_only
from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import CHECKS, reader_checks

MAGIC = b"RAWSLICE"
SHAPE = (48, 64)


def write(folder, slices):
    """Write ``slice_<k>.raw``: magic, position, pixels."""
    for k in range(slices):
        pixels = np.random.default_rng(k).integers(0, 255, SHAPE, dtype=np.uint8)
        content = MAGIC + np.float64(2.5 * k).tobytes() + pixels.tobytes()
        (folder / f"slice_{k + 1}.raw").write_bytes(content)
    return folder


@dataclass(frozen=True)
class Raw:
    """A correct reader of a folder of raw slices."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)
    pixel_size: float | None = option(None, "side of a pixel", unit="mm", gt=0)

    def probe(self, path):
        files = self.files(path) if path.is_dir() else []
        return 0.9 if files and head(files[0])[:8] == MAGIC else 0.0

    def files(self, path):
        return sorted(item for item in path.iterdir() if item.suffix == ".raw")

    def spacing(self):
        if self.pixel_size is None:
            raise InputError("unknown pixel size", fix="give --pixel-size")
        return self.pixel_size

    def read(self, path):
        files = self.files(path) if path.is_dir() else []
        if len(files) < 2:
            raise InputError("at least two slices are needed", where=str(path), found=f"{len(files)} slices")
        for file in files:
            if head(file)[:8] != MAGIC or file.stat().st_size != 16 + SHAPE[0] * SHAPE[1]:
                raise InputError("no raw slice", where=file.name)
        return self.stack(sorted(files, key=position))

    def stack(self, files):
        return SliceStack(
            decode=lambda k: decoded(files[k]),
            names=tuple(file.name for file in files),
            shape=SHAPE,
            positions=frozen_floats([position(file) for file in files]),
            pixel_spacing=frozen_floats(np.full((len(files), 2), self.spacing())),
            kind=SectionKind.SLAB,
            affine=frozen_floats(np.eye(4)),
        )


def head(file):
    with file.open("rb") as stream:
        return stream.read(16)


def position(file):
    return float(np.frombuffer(head(file)[8:16])[0])


def decoded(file):
    content = file.read_bytes()
    if len(content) != 16 + SHAPE[0] * SHAPE[1]:
        raise InputError("cut off", where=file.name)
    return np.frombuffer(content[16:], np.uint8).reshape(SHAPE)


def case_of(reader):
    return ReaderCase(reader, write, {"pixel_size": 0.3}, spacing_options=("pixel_size",))


@pytest.mark.parametrize("check", reader_checks(case_of(Raw)), ids=str)
def test_a_correct_reader_passes(check):
    check()


# --- seeded faults: each class differs from Raw in one way -------------------------------------------


class OrderOfListing(Raw):
    def files(self, path):
        return [item for item in path.iterdir() if item.suffix == ".raw"]

    def read(self, path):
        return self.stack(self.files(path))

    def stack(self, files):
        z = frozen_floats(2.5 * np.arange(len(files)))
        return replace(
            super().stack(sorted(files, key=position)), decode=lambda k: decoded(files[k]), positions=z
        )


class OrderOfDates(Raw):
    def stack(self, files):
        dated = sorted(files, key=lambda file: file.stat().st_mtime_ns)
        return replace(super().stack(files), decode=lambda k: decoded(dated[k]))


class InventsSpacing(Raw):
    def spacing(self):
        return self.pixel_size or 1.0


class RefusesWithoutAFix(Raw):
    def spacing(self):
        if self.pixel_size is None:
            raise InputError("unknown pixel size")
        return self.pixel_size


class DecodesEarly(Raw):
    def stack(self, files):
        pictures = [decoded(file) for file in files]
        return replace(super().stack(files), decode=lambda k: pictures[k])


class NeedsTheOthers(Raw):
    def stack(self, files):
        return replace(super().stack(files), decode=lambda k: [decoded(file) for file in files][k])


class OneSliceWillDo(Raw):
    def read(self, path):
        return self.stack(sorted(self.files(path), key=position))


class CrashesOnTruncated(Raw):
    def read(self, path):
        files = self.files(path)
        if len(files) < 2:
            raise InputError("at least two slices", where=path.name)
        return self.stack(files)

    def stack(self, files):
        def decode(k):
            return np.frombuffer(files[k].read_bytes()[16:], np.uint8).reshape(SHAPE)

        return replace(super().stack(files), decode=decode)


class FillsUpTruncated(CrashesOnTruncated):
    def stack(self, files):
        def decode(k):
            return np.resize(np.frombuffer(files[k].read_bytes()[16:], np.uint8), SHAPE)

        return replace(Raw.stack(self, files), decode=decode)


class NamesNoFile(Raw):
    def read(self, path):
        try:
            return super().read(path)
        except InputError:
            raise InputError("something is wrong", where=str(path)) from None


class WritableArrays(Raw):
    def stack(self, files):
        stack = super().stack(files)
        return replace(stack, positions=np.array(stack.positions))


class SharedSlices(Raw):
    def stack(self, files):
        cache = {}

        def decode(k):
            return cache.setdefault(k, decoded(files[k]).copy())

        return replace(super().stack(files), decode=decode)


class RandomProduct(Raw):
    def spacing(self):
        return super().spacing() * (1 + random.SystemRandom().random())


class WrongShape(Raw):
    def stack(self, files):
        return replace(super().stack(files), shape=SHAPE[::-1])


class DropsASlice(Raw):
    def stack(self, files):
        return super().stack(files[1:])


class WrongType(Raw):
    def read(self, path):
        return super().read(path).positions


class ProbeRaises(Raw):
    def probe(self, path):
        return 0.9 if head(self.files(path)[0])[:8] == MAGIC else 0.0


class ProbeSaysYes(Raw):
    def probe(self, path):
        return True


class ProbeOverOne(Raw):
    def probe(self, path):
        return 90 * super().probe(path)


class ProbeBySuffix(Raw):
    def probe(self, path):
        return 0.9 if path.is_dir() and self.files(path) else 0.0


class ProbeClaimsEverything(Raw):
    def probe(self, path):
        return 0.5


class ProbeForgetsItsOwn(Raw):
    def probe(self, path):
        return 0.0


class ProbeIsSlow(Raw):
    def probe(self, path):
        time.sleep(0.3)
        return super().probe(path)


class ProbeOpensEverything(Raw):
    def probe(self, path):
        for file in self.files(path) if path.is_dir() else []:
            head(file)
        return super().probe(path)


class ProbeWritesACache(Raw):
    def probe(self, path):
        if path.is_dir():
            (path / ".cache").write_text("seen")
        return super().probe(path)


class ProbeChangesTheEnvironment(Raw):
    def probe(self, path):
        os.environ["RAW_READER"] = str(path)
        return super().probe(path)


class ReadSeedsNumpy(Raw):
    def read(self, path):
        np.random.seed(1)  # noqa: NPY002 - that is the fault
        return super().read(path)


class ReadWritesNextToTheSource(Raw):
    def read(self, path):
        product = super().read(path)
        (path / "index.txt").write_text("done")
        return product


class ReadPhonesHome(Raw):
    def read(self, path):
        import socket  # noqa: PLC0415

        with socket.socket() as line:
            line.settimeout(0.01)
            line.connect_ex(("127.0.0.1", 9))
        return super().read(path)


class DependsOnTheFolder(Raw):
    def stack(self, files):
        stack = super().stack(files)
        return replace(stack, names=tuple(str(file) for file in files))


@dataclass(frozen=True)
class NoHelp(Raw):
    gain: float = 1.0


@dataclass(frozen=True)
class MutableDefault(Raw):
    skip: list = option(None, "slices to skip")  # noqa: RUF009

    def __post_init__(self):
        object.__setattr__(self, "skip", [])

    def __eq__(self, other):
        return self is other

    __hash__ = None


class OldContract(Raw):
    api = "0"


FAULTS = {
    OrderOfListing: "read-file-order",
    OrderOfDates: "read-file-order",
    InventsSpacing: "refuses-unknown-spacing",
    RefusesWithoutAFix: "refuses-unknown-spacing",
    DecodesEarly: "read-lazy-slices",
    NeedsTheOthers: "read-lazy-slices",
    OneSliceWillDo: "refuses-one-slice",
    CrashesOnTruncated: "refuses-truncated",
    FillsUpTruncated: "refuses-truncated",
    NamesNoFile: "refuses-truncated",
    WritableArrays: "read-frozen",
    SharedSlices: "read-frozen",
    RandomProduct: "read-repeatable",
    WrongShape: "read-produces",
    DropsASlice: "read-produces",
    WrongType: "read-produces",
    ProbeRaises: "probe-missing-path",
    ProbeSaysYes: "probe-knows-its-own",
    ProbeOverOne: "probe-knows-its-own",
    ProbeBySuffix: "probe-by-content",
    ProbeClaimsEverything: "probe-rubbish",
    ProbeForgetsItsOwn: "probe-knows-its-own",
    ProbeIsSlow: "probe-cheap",
    ProbeOpensEverything: "probe-cheap",
    ProbeWritesACache: "probe-no-side-effects",
    ProbeChangesTheEnvironment: "probe-no-side-effects",
    ReadSeedsNumpy: "read-no-side-effects",
    ReadWritesNextToTheSource: "read-no-side-effects",
    ReadPhonesHome: "read-no-side-effects",
    DependsOnTheFolder: "read-from-elsewhere",
    NoHelp: "options-validated",
    MutableDefault: "options-validated",
    OldContract: "plugin-shape",
}


@pytest.fixture(autouse=True)
def _restore():
    state = np.random.get_state()  # noqa: NPY002
    yield
    np.random.set_state(state)  # noqa: NPY002
    os.environ.pop("RAW_READER", None)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_seeded_faults_are_caught(fault):
    failed = {
        finding.check: finding.reason
        for finding in findings(reader_checks(case_of(fault)))
        if not finding.passed
    }
    assert FAULTS[fault] in failed
    assert failed[FAULTS[fault]]


def test_decoding_early_from_a_single_file_is_caught(tmp_path):
    def write_one(folder, slices):
        path = folder / "volume.npz"
        arrays = {f"s{k}": np.full((200, 200), float(k)) for k in range(slices)}
        np.savez_compressed(path, **arrays)
        return path

    class Eager(Raw):
        def read(self, path):
            with np.load(path) as file:
                pictures = [file[f"s{k}"] for k in range(len(file.files))]
            return SliceStack(
                lambda k: pictures[k].copy(),
                tuple(f"s{k}" for k in range(len(pictures))),
                (200, 200),
                frozen_floats(np.arange(len(pictures))),
                frozen_floats(np.full((len(pictures), 2), 0.3)),
                SectionKind.SLAB,
                affine=read_only(np.eye(4)),
            )

    checks = {str(check): check for check in reader_checks(ReaderCase(Eager, write_one))}
    assert "decoded early" in checks["read-small-memory"].finding().reason


def test_expected_failures_need_a_reason_and_must_fail():
    case = case_of(ProbeBySuffix)
    reason = {"probe-by-content": "the format has no magic number"}
    by_name = {str(check): check for check in reader_checks(case, reason)}
    assert by_name["probe-by-content"].finding().passed
    with pytest.raises(UsageError, match="needs a reason"):
        reader_checks(case, {"probe-by-content": " "})
    with pytest.raises(UsageError, match="no check is called 'probe-content'; fix: did you mean"):
        reader_checks(case, {"probe-content": "x"})
    healthy = {str(check): check for check in reader_checks(case_of(Raw), reason)}
    assert "passes, although expected to fail" in healthy["probe-by-content"].finding().reason


def test_every_check_says_what_it_proves():
    assert all(run.__doc__ for run in CHECKS.values())
