"""The checks against a known volume let a correct reader through and catch seeded faults by name."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from stackloft.model.arrays import frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.testing.conformance.check import NOT_HELD, findings
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import reader_checks
from stackloft.testing.conformance.told_checks import CHECKS


def write_told(folder, volume):
    """Write pixels as they lie in memory, and what is known of them as JSON."""
    (folder / "pixels").write_bytes(volume.pictures.tobytes(order="A"))
    said = {
        "dtype": volume.pictures.dtype.str,
        "order": "C" if volume.pictures.flags.c_contiguous else "F",
        "shape": volume.pictures.shape,
        "positions": volume.positions.tolist(),
        "spacing": volume.spacing,
        "origin": volume.origin.tolist(),
        "axes": volume.axes.tolist(),
        "shear": volume.shear,
    }
    (folder / "about.json").write_text(json.dumps(said))
    return folder


@dataclass(frozen=True)
class Told:
    """A correct reader of such folders."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)

    def probe(self, path):
        return 0.9 if (path / "about.json").is_file() else 0.0

    def read(self, path):
        said = json.loads((path / "about.json").read_text())
        volume = self.pixels(path, said)
        z = np.array(said["positions"])
        self.check(z)
        return SliceStack(
            lambda k: volume[k].copy(),
            tuple(f"{k}" for k in range(len(z))),
            volume.shape[1:],
            frozen_floats(self.positions(z)),
            frozen_floats(np.tile(self.spacing(said), (len(z), 1))),
            SectionKind.SLAB,
            affine=frozen_floats(self.affine(said)),
        )

    def pixels(self, path, said):
        flat = np.fromfile(path / "pixels", said["dtype"])
        volume = flat.reshape(said["shape"], order=said["order"])
        return volume.astype(volume.dtype.newbyteorder("="))

    def check(self, z):
        if (np.diff(z) <= 0).any():
            raise InputError("two slices at one place")

    def positions(self, z):
        return z

    def spacing(self, said):
        return said["spacing"]

    def affine(self, said):
        u, v, w = np.array(said["axes"]).T
        matrix = np.eye(4)
        matrix[:3] = np.column_stack([u, v, w + said["shear"] * v, said["origin"]])
        return matrix


def told_findings(reader, write=write_told):
    checks = reader_checks(ReaderCase(reader, lambda folder, slices: folder, write_told=write))
    return {found.check: found for found in findings([x for x in checks if x.name in CHECKS])}


def test_a_correct_reader_passes():
    assert [found for found in told_findings(Told).values() if found.reason] == []


# --- seeded faults: each class differs from Told in one way -------------------------------------------


class OriginDropped(Told):
    def affine(self, said):
        return super().affine({**said, "origin": [0, 0, 0]})


class OriginInPixels(Told):
    def affine(self, said):
        return super().affine({**said, "origin": list(np.array(said["origin"]) / 0.45)})


class DirectionDropped(Told):
    def affine(self, said):
        return super().affine({**said, "axes": np.eye(3).tolist()})


class DirectionTransposed(Told):
    def affine(self, said):
        return super().affine({**said, "axes": np.array(said["axes"]).T.tolist()})


class NormalReversed(Told):
    def affine(self, said):
        axes = np.array(said["axes"])
        axes[:, 2] *= -1
        return super().affine({**said, "axes": axes.tolist()})


class ShearDropped(Told):
    def affine(self, said):
        return super().affine({**said, "shear": 0.0})


class ShearReversed(Told):
    def affine(self, said):
        return super().affine({**said, "shear": -said["shear"]})


class SpacingSwapped(Told):
    def spacing(self, said):
        return said["spacing"][::-1]


class SpacingOne(Told):
    def spacing(self, said):
        return (1.0, 1.0)


class SpacingOfRowsForBoth(Told):
    def spacing(self, said):
        return (said["spacing"][0],) * 2


class SpacingInWrongUnit(Told):
    def spacing(self, said):
        return tuple(1000 * x for x in said["spacing"])


class PitchOfTheRows(Told):
    def positions(self, z):
        return 0.7 * np.arange(len(z))


class HalfAPixelOff(Told):
    def affine(self, said):
        matrix = super().affine(said)
        matrix[:3, 3] += 0.5 * matrix[:3, 0] * said["spacing"][1]
        return matrix


class AxesSwapped(Told):
    def pixels(self, path, said):
        volume = super().pixels(path, said)
        return np.ascontiguousarray(volume.transpose(0, 2, 1))


class RowsUpsideDown(Told):
    def pixels(self, path, said):
        return super().pixels(path, said)[:, ::-1]


class SlicesReversed(Told):
    def pixels(self, path, said):
        return super().pixels(path, said)[::-1]


class SignLost(Told):
    def pixels(self, path, said):
        volume = super().pixels(path, said)
        return volume.view(np.uint16) if volume.dtype == np.int16 else volume


class HighestValuesLost(Told):
    def pixels(self, path, said):
        volume = super().pixels(path, said)
        return volume.view(np.int16) if volume.dtype == np.uint16 else volume


class FractionsLost(Told):
    def pixels(self, path, said):
        volume = super().pixels(path, said)
        return volume.astype(np.int16) if volume.dtype.kind == "f" else volume


class StretchedToBytes(Told):
    def pixels(self, path, said):
        volume = super().pixels(path, said).astype(float)
        return (255 * (volume - volume.min()) / np.ptp(volume)).astype(np.uint8)


class BytesAsTheyLie(Told):
    def pixels(self, path, said):
        return super().pixels(path, {**said, "dtype": said["dtype"].replace(">", "<")})


class ForeignByteOrder(Told):
    def pixels(self, path, said):
        return np.fromfile(path / "pixels", said["dtype"]).reshape(said["shape"], order=said["order"])


class OrderIgnored(Told):
    def pixels(self, path, said):
        return super().pixels(path, {**said, "order": "C"})


class GapEvenedOut(Told):
    def positions(self, z):
        return np.linspace(z[0], z[-1], len(z))


class GapIgnored(Told):
    def positions(self, z):
        return z[0] + (z[1] - z[0]) * np.arange(len(z))


class DuplicateKept(Told):
    def check(self, z):
        pass

    def positions(self, z):
        return z if (np.diff(z) > 0).all() else z[-1] / (len(z) - 1) * np.arange(len(z))


FAULTS = {
    OriginDropped: "told-origin",
    OriginInPixels: "told-origin",
    DirectionDropped: "told-direction",
    DirectionTransposed: "told-direction",
    NormalReversed: "told-direction",
    ShearDropped: "told-tilt",
    ShearReversed: "told-tilt",
    SpacingSwapped: "told-spacing",
    SpacingOne: "told-spacing",
    SpacingOfRowsForBoth: "told-spacing",
    SpacingInWrongUnit: "told-spacing",
    PitchOfTheRows: "told-spacing",
    HalfAPixelOff: "told-spacing",
    AxesSwapped: "told-spacing",
    RowsUpsideDown: "told-spacing",
    SlicesReversed: "told-spacing",
    SignLost: "told-dtype",
    HighestValuesLost: "told-dtype",
    FractionsLost: "told-dtype",
    StretchedToBytes: "told-dtype",
    BytesAsTheyLie: "told-endianness",
    ForeignByteOrder: "told-endianness",
    OrderIgnored: "told-strides",
    GapEvenedOut: "told-gap",
    GapIgnored: "told-gap",
    DuplicateKept: "told-duplicate",
}


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_seeded_faults_are_caught(fault):
    found = told_findings(fault)[FAULTS[fault]]
    assert not found.passed
    assert found.reason


def test_what_a_format_cannot_hold_is_told_and_no_failure():
    def upright_only(folder, volume):
        if volume.placed:
            raise NotImplementedError("a place in space")
        return write_told(folder, volume)

    found = told_findings(Told, upright_only)
    assert found["told-origin"].passed
    assert found["told-origin"].reason == f"{NOT_HELD}a place in space"
    assert found["told-spacing"].reason == ""
    assert {x.check for x in found.values() if x.reason} == {"told-origin", "told-direction", "told-tilt"}


def test_a_reader_that_is_not_finished_does_not_hold():
    class Unfinished(Told):
        def read(self, path):
            raise NotImplementedError

    assert not [found for found in told_findings(Unfinished).values() if found.passed]
