"""Grey slabs of ellipsoids at 1 : 1, 1 : 3 and 1 : 10, of few slices: what the scanner's averaging costs."""

import numpy as np
import pytest

import stackloft
from stackloft.testing import phantoms
from stackloft.testing.phantoms.scans import Scans

SHAPES = ((32.0, 25.0, 41.0), (30.0, 30.0, 30.0), (40.0, 26.0, 33.0), (38.0, 30.0, 24.0))
"""Semi-axes, mm."""
SLICES = {1: (12, 16, 24, 40), 3: (12, 16, 24), 10: (12, 16)}
"""Pitch over pixel to slices through the body."""
WAYS = {"straight": (False, 0.0), "turned": (True, 0.0), "turned, noise 3 %": (True, 31.0)}
"""Whether the body is turned anyhow and lies anywhere between the slices; noise in HU of 1040."""
METHODS = "loft,partial-volume"


def errors(shape, ratio, slices, seed, turned, noise, folder):
    """Return how far V and S of the loft and V of partial-volume are off, per cent."""
    rng = np.random.default_rng([seed, ratio, slices])
    body = phantoms.make("ellipsoid", **dict(zip("abc", shape, strict=True)))
    body = body.posed(int(rng.integers(1 << 30))) if turned else body
    low, high = body.extent()
    pitch = (high - low) / slices
    phase = rng.uniform(0.0, 1.0) if turned else 0.5
    scanner = Scans(
        form="nrrd",
        positions=tuple(low + (np.arange(-2, slices + 2) + phase) * pitch),
        aspect=float(ratio),
        noise=noise,
        seed=seed,
        margin=(9.0 + rng.uniform()) * pitch / ratio,
    )
    scanner.write(body, folder)
    methods = stackloft.measure(folder / "scan.nrrd", METHODS).objects[0].methods
    loft, coverage = methods["loft"], methods["partial-volume"]
    return 100.0 * np.array(
        [
            loft.volume.value / body.volume - 1.0,
            loft.area.value / body.area - 1.0,
            coverage.volume.value / body.volume - 1.0,
        ]
    )


@pytest.mark.parametrize(("ratio", "slices", "body"), [(1, 12, 0), (1, 16, 2), (3, 12, 2), (10, 12, 2)])
def test_grey_slabs_of_few_slices(ratio, slices, body, tmp_path):
    loft, area, coverage = errors(SHAPES[body], ratio, slices, 1, ratio > 1, 0.0, tmp_path)
    assert abs(loft) < 0.3
    assert abs(area) < 0.5
    assert abs(coverage) < 0.05


CLAIM = (
    "Grey slabs of four ellipsoids (semi-axes 32 × 25 × 41, 30 × 30 × 30, 40 × 26 × 33, 38 × 30 × 24 mm), "
    "straight and turned anyhow between slices and pixels: per cent off"
)
HEADER = ("pixel : pitch", "slices", "body", "loft V, mean", "worst", "loft S, mean", "worst",
          "partial-volume, mean", "worst")  # fmt: skip


@pytest.mark.prove
def test_grey_slabs_at_every_ratio(proof, tmp_path):
    rows, worst = [], {}
    for ratio, counts in SLICES.items():
        for slices in counts:
            for way, (turned, noise) in WAYS.items():
                found = np.array(
                    [
                        errors(
                            shape, ratio, slices, k, turned, noise, tmp_path / f"{ratio} {slices} {way} {k}"
                        )
                        for k, shape in enumerate(SHAPES)
                    ]
                )
                mean, most = found.mean(axis=0), np.abs(found).max(axis=0)
                worst[ratio, slices, way] = most
                figures = [
                    text for a, b in zip(mean, most, strict=True) for text in (f"{a:+.3f}", f"{b:.3f}")
                ]
                rows.append((f"1 : {ratio}", slices, way, *figures))
    proof("slabs", CLAIM, HEADER, rows)
    for (ratio, slices, way), (volume, area, coverage) in worst.items():
        if WAYS[way][1] == 0.0:
            assert coverage < 0.3, (ratio, slices, way)
            assert volume < 0.3, (ratio, slices, way)
            assert area < 0.5, (ratio, slices, way)
