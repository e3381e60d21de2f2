"""Heat conduction on our own mesh by scikit-fem: a sphere cooled by convection, against its series."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from stackloft.testing import phantoms
from stackloft_plugins.meshers.sweep import Sweep
from stackloft_plugins.reconstructors.loft import LoftReconstructor

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "cooling.py"
RADIUS = 25.0
FOURIER = np.array([0.2, 0.5, 1.0])


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("cooling", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def centre_by_series(fourier):
    """Temperature at the centre, Biot 1: Σ Cₙ exp(−ζₙ² t), 1 − ζ cot ζ = 1 (Carslaw & Jaeger 1959, §9.4)."""
    zeta = np.pi * (np.arange(60) + 0.5)
    c = 4.0 * (np.sin(zeta) - zeta * np.cos(zeta)) / (2.0 * zeta - np.sin(2.0 * zeta))
    return (c * np.exp(-np.outer(fourier, zeta**2))).sum(axis=1)


def cooled_sphere(example, elements):
    sphere = phantoms.make("ellipsoid", a=RADIUS, b=RADIUS, c=RADIUS)
    mesh = Sweep(order=2, elements=elements, growth=1.5).mesh(
        LoftReconstructor().reconstruct(sphere.contour_stack())
    )
    radius = 1e-3 * RADIUS
    fields = example.cooled(mesh, FOURIER * radius**2, 1.0, 1.0, 1.0 / radius, 1.0, 0.0, steps=30)
    centre = 0.5 * (mesh.nodes.min(axis=0) + mesh.nodes.max(axis=0))[None]
    return mesh, np.array([example.at_points(mesh, field, centre)[0] for field in fields])


def test_a_sphere_cools_as_its_series_says(example):
    mesh, found = cooled_sphere(example, 1500)
    assert len(mesh.elements) <= 1500
    np.testing.assert_allclose(found, centre_by_series(FOURIER), rtol=2e-3)


def test_scikit_fem_finds_our_volume_and_area(example):
    from skfem import Basis, ElementTetP2, FacetBasis, Functional  # noqa: PLC0415

    from stackloft_plugins.integrators.fem import Fem  # noqa: PLC0415

    body = LoftReconstructor().reconstruct(phantoms.make("potato", seed=2).contour_stack())
    mesh = Sweep(order=2, elements=800).mesh(body)
    theirs, _ = example.skfem_mesh(mesh)
    one = Functional(lambda _: 1.0)
    ours = Fem(degree=6).integrate(mesh)
    assert one.assemble(Basis(theirs, ElementTetP2(), intorder=4)) * 1e9 == pytest.approx(
        ours.volume, rel=1e-10
    )
    assert one.assemble(FacetBasis(theirs, ElementTetP2(), intorder=6)) * 1e6 == pytest.approx(
        ours.area, rel=1e-5
    )


@pytest.mark.prove
def test_the_sphere_at_three_times_and_the_piece_of_the_page(example, proof, tmp_path):
    exact, rows = centre_by_series(FOURIER), []
    for elements in (800, 2000, 5000):
        mesh, found = cooled_sphere(example, elements)
        off = 100 * (found / exact - 1)
        rows += [
            (len(mesh.elements), time, f"{value:.6f}", f"{true:.6f}", f"{error:+.4f}")
            for time, value, true, error in zip(FOURIER, found, exact, off, strict=True)
        ]
        assert abs(off).max() < 0.2
    proof(
        "cooling-sphere",
        "Transient cooling of a sphere, Biot 1, order 2: temperature at the centre against the series",
        ("elements", "Fourier number", "found", "series", "error %"),
        rows,
    )
    picture = tmp_path / "cooling.png"
    example.main(EXAMPLE.parents[2] / "sample_stacks" / "meat", picture)
    assert picture.stat().st_size > 20_000
