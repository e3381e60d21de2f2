"""Volume and area to 1e-9 by a route that shares nothing with the one that made them."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad

from stackloft.testing import phantoms
from stackloft.testing.phantoms.potato import harmonics
from stackloft.testing.phantoms.quadrature import figures

TOLERANCE = 1e-9
EXACT = [
    "ellipsoid",
    "superellipsoid",
    "box",
    "prism",
    "cylinder",
    "cone",
    "double-cone",
    "frustum",
    "twisted-bar",
]
EXACT_VOLUME = [*EXACT, "banana", "dumbbell"]


@pytest.mark.parametrize("name", EXACT_VOLUME)
def test_closed_form_volume_is_the_divergence_integral_of_the_patches(name):
    phantom = phantoms.make(name)
    assert figures(phantom.body.patches)[0] == pytest.approx(phantom.volume, rel=TOLERANCE)


@pytest.mark.parametrize(
    "name", ["ellipsoid", "box", "cylinder", "cone", "double-cone", "frustum", "twisted-bar"]
)
def test_closed_form_area_is_the_area_integral_of_the_patches(name):
    phantom = phantoms.make(name)
    assert figures(phantom.body.patches)[1] == pytest.approx(phantom.area, rel=TOLERANCE)


@pytest.mark.parametrize("axes", [(3.0, 2.0, 1.0), (40.0, 10.0, 25.0), (5.0, 5.0, 9.0)])
def test_ellipsoid_area_by_legendre_elliptic_integrals(axes):
    """DLMF 19.33.1, evaluated with 40 digits."""
    with mpmath.workdps(40):
        a, b, c = sorted((mpmath.mpf(x) for x in axes), reverse=True)
        phi = mpmath.acos(c / a)
        k2 = (a**2 * (b**2 - c**2)) / (b**2 * (a**2 - c**2))
        bracket = (
            mpmath.ellipe(phi, k2) * mpmath.sin(phi) ** 2 + mpmath.ellipf(phi, k2) * mpmath.cos(phi) ** 2
        )
        expected = 2 * mpmath.pi * c**2 + 2 * mpmath.pi * a * b / mpmath.sin(phi) * bracket
    found = phantoms.make("ellipsoid", **dict(zip("abc", axes, strict=True))).area
    assert found == pytest.approx(float(expected), rel=1e-13)


@pytest.mark.parametrize(
    ("p", "n"), [(2.5, 2.0), (3.0, 2.0), (4.0, 2.0), (2.5, 4.0), (1.5, 3.0), (8.0, 6.0), (2.0, 1.0)]
)
def test_superellipsoid_area_by_height_and_angle(p, n):
    """Another parametrisation, by powers of sines and cosines (Barr 1981), and another rule."""
    a, b, c = 3.0, 2.0, 4.0
    body = phantoms.make("superellipsoid", a=a, b=b, c=c, p=p, n=n).body
    rate = 7  # grades the ends so that Gauss–Legendre sees a smooth integrand

    def graded(s):
        return s**rate / (s**rate + (1 - s) ** rate)

    def grading(s):
        d = s**rate + (1 - s) ** rate
        return rate * (s * (1 - s)) ** (rate - 1) / d**2

    def element(s, t):
        turns = [
            np.pi / 2 * graded(one) for one in (s, 1 - s, t, 1 - t)
        ]  # cos f as sin(π/2 − f): no cancellation
        sines = [np.sin(turn) for turn in turns]
        return _superellipsoid_element(sines, (a, b, c), p, n) * (np.pi / 2) ** 2 * grading(s) * grading(t)

    node, weight = np.polynomial.legendre.leggauss(300)
    S, T = np.meshgrid((node + 1) / 2, (node + 1) / 2)
    octant = weight @ element(S, T) @ weight / 4
    assert body.area == pytest.approx(8 * octant, rel=TOLERANCE)


def _superellipsoid_element(sines, axes, p, n):
    """|X_f × X_g| of X = (a·C(g)·cos_n f, b·C(g)·sin_n f, c·S(g)), C = cos^(2/p), cos_n = cos^(2/n)."""
    a, b, c = axes
    sf, cf, sg, cg = sines
    u, v, r, h = cf ** (2 / n), sf ** (2 / n), cg ** (2 / p), sg ** (2 / p)
    du, dv = -2 / n * u * sf / cf, 2 / n * v * cf / sf
    dr, dh = -2 / p * r * sg / cg, 2 / p * h * cg / sg
    along = np.array([a * r * du, b * r * dv, 0 * r])
    up = np.array([a * dr * u, b * dr * v, c * dh])
    return np.linalg.norm(np.cross(along, up, axis=0), axis=0)


@pytest.mark.parametrize("name", ["dumbbell", "double-cone", "cone"])
def test_solids_of_revolution_by_their_meridian(name):
    """V = π∫r² ds and S = 2π∫r·√(1 + r′²) ds, by scipy's adaptive rule."""
    if name == "dumbbell":
        phantom = phantoms.make(name, length=100, thickness=44, pinch=0.4, neck=0.3)

        def half_width(t):  # s = sin t removes the square root at the poles
            s = np.sin(t)
            return 22 * (1 - 0.4 * np.exp(-((s / 0.3) ** 2))) * np.cos(t)

        def slope(t):
            s, e = np.sin(t), np.exp(-((np.sin(t) / 0.3) ** 2))
            return 22 * (0.8 * s / 0.09 * e * np.cos(t) ** 2 - (1 - 0.4 * e) * s)

        bounds, run = (-np.pi / 2, np.pi / 2), lambda t: 50 * np.cos(t)
    else:
        radius, height = 30.0, 80.0
        phantom = phantoms.make(name, radius=radius, height=height)
        reach = height if name == "cone" else height / 2
        half_width, slope = (lambda t: radius * (1 - abs(t) / reach)), (lambda t: radius / reach)
        bounds, run = ((0, reach) if name == "cone" else (-reach, reach)), (lambda t: 1.0)
    volume = np.pi * quad(lambda t: half_width(t) ** 2 * run(t), *bounds, epsrel=1e-12)[0]
    area = (
        2
        * np.pi
        * quad(lambda t: half_width(t) * np.hypot(run(t), slope(t)), *bounds, epsrel=1e-12, limit=200)[0]
    )
    area += np.pi * 30.0**2 if name == "cone" else 0
    assert phantom.volume == pytest.approx(volume, rel=TOLERANCE)
    assert phantom.area == pytest.approx(area, rel=TOLERANCE)


@pytest.mark.parametrize("name", ["potato", "apple"])
def test_star_bodies_by_radial_integrals(name):
    """V = ⅓∫r³ dΩ, S = ∫r·√(r² + |∇r|²) dΩ on Chebyshev-free angles: central differences in r only."""
    phantom = phantoms.make(name)
    stretch = {"potato": (1, 1, 1.3), "apple": (1, 0.95, 0.95)}[name]
    theta, w = np.polynomial.legendre.leggauss(120)
    lat, lon = np.arcsin(theta), 2 * np.pi * np.arange(160) / 160
    L, B = (grid.ravel() for grid in np.meshgrid(lon, lat, indexing="xy"))
    weight = np.repeat(w, len(lon)) * 2 * np.pi / len(lon)

    def point(longitude, latitude):
        d = np.stack(
            [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
        )
        return _reach(phantom, d * np.array(stretch)[:, None]), d * np.array(stretch)[:, None]

    r, _ = point(L, B)
    volume = np.prod(stretch) * weight @ r**3 / 3
    assert volume == pytest.approx(phantom.volume, rel=TOLERANCE)
    step = 2e-3
    partial = []
    for dl, db in ((step, 0), (0, step)):
        around = [np.multiply(*point(L + k * dl, B + k * db)) for k in (-3, -2, -1, 1, 2, 3)]
        partial.append(np.tensordot([-1 / 60, 3 / 20, -3 / 4, 3 / 4, -3 / 20, 1 / 60], around, axes=1) / step)
    area = weight @ (np.linalg.norm(np.cross(*partial, axis=0), axis=0) / np.cos(B))
    assert area == pytest.approx(phantom.area, rel=TOLERANCE)


def _reach(phantom, e):
    """Return how far the body's inequality allows along vectors e (3, n), by bisection then secants."""
    inside = phantom.body.fields[0]
    low, high = np.zeros(e.shape[1]), np.full(e.shape[1], 100.0)
    for _ in range(12):
        middle = (low + high) / 2
        within = inside(middle * e) < 0
        low, high = np.where(within, middle, low), np.where(within, high, middle)
    for _ in range(6):
        f, g = inside(low * e), inside(high * e)
        root = np.where(g != f, low - f * (high - low) / np.where(g != f, g - f, 1), low)
        low, high = root, np.where(root == high, low, high)
    return low


def test_meat_and_banana_and_two_lobed_by_their_sections():
    """Volume from the bodies' own inequalities: polar radius by bisection, Gauss over height and angle."""
    for name in ("meat", "banana", "two-lobed"):
        phantom = phantoms.make(name)
        low, high = phantom.extent()
        t, w = np.polynomial.legendre.leggauss(60)
        z = low + (high - low) * (1 + np.sin(t * np.pi / 2)) / 2  # smooths the square roots at the poles
        w = w * (high - low) / 2 * np.pi / 2 * np.cos(t * np.pi / 2)
        areas = [_polar_area(phantom, height) for height in z]
        assert w @ areas == pytest.approx(phantom.volume, rel=TOLERANCE)


def _polar_area(phantom, z):
    (loop,) = phantom.section(z, points=64)
    centre = loop.points.mean(axis=0)
    angle = 2 * np.pi * np.arange(512) / 512
    e = np.stack([np.cos(angle), np.sin(angle)])
    inside = phantom.body.fields[0]
    low, high = np.zeros(512), np.full(512, 2 * np.ptp(loop.points, axis=0).max())
    for _ in range(50):
        middle = (low + high) / 2
        within = inside(np.vstack([centre[:, None] + middle * e, np.full(512, z)])) < 0
        low, high = np.where(within, middle, low), np.where(within, high, middle)
    return np.pi * np.mean(((low + high) / 2) ** 2)


def test_harmonics_are_orthonormal():
    t, w = np.polynomial.legendre.leggauss(20)
    lon = 2 * np.pi * np.arange(24) / 24
    L, T = (grid.ravel() for grid in np.meshgrid(lon, t))
    ring = np.sqrt(1 - T**2)
    y = np.concatenate(harmonics(np.stack([ring * np.cos(L), ring * np.sin(L), T]), 7))
    gram = (y * np.repeat(w, 24) * 2 * np.pi / 24) @ y.T
    assert np.abs(gram - np.eye(64)).max() < 1e-12


@pytest.mark.parametrize("name", phantoms.NAMES)
def test_scaling_gives_the_cube_and_the_square(name):
    """Doubling every length of the patches: V·8, S·4; a pose changes neither."""
    phantom = phantoms.make(name)
    twice = [replace(p, surface=lambda u, v, p=p: 2 * p.surface(u, v)) for p in phantom.body.patches]
    volume, area = figures(twice)
    assert volume == pytest.approx(8 * phantom.volume, rel=TOLERANCE)
    assert area == pytest.approx(4 * phantom.area, rel=TOLERANCE)


@pytest.mark.parametrize("name", phantoms.NAMES)
def test_a_pose_moves_the_boundary_and_keeps_its_figures(name):
    phantom = phantoms.make(name).posed(11, (12.0, -70.0, 33.0))
    R, o = phantom.rotation, phantom.offset[:, None]
    moved = [replace(p, surface=lambda u, v, p=p: R @ p.surface(u, v) + o) for p in phantom.body.patches]
    volume, area = figures(moved)
    assert volume == pytest.approx(phantom.volume, rel=TOLERANCE)
    assert area == pytest.approx(phantom.area, rel=TOLERANCE)
