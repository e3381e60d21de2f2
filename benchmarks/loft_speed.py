"""How long lofting and integrating 18 sections of 33 points takes."""

from __future__ import annotations

import os
import statistics
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.geometry.skin import skin
from stackloft.sectioning.equal_points import equal_points
from stackloft.testing import phantoms
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

RUNS = 100


def timed(name: str, work) -> None:
    """Print best and median of `work` in ms."""
    for _ in range(10):
        work()
    times = []
    for _ in range(RUNS):
        start = time.process_time()
        work()
        times.append(1e3 * (time.process_time() - start))
    print(f"{name:62s} best {min(times):6.2f} ms   median {statistics.median(times):6.2f} ms")


def main() -> None:
    """Time the parts and the whole on a seeded potato."""
    potato = phantoms.make("potato", seed=3)
    contours = potato.contour_stack(sections=18, points=33)
    sections = equal_points(contours, 33)
    end = RowEnd(2.0, pole=True)
    integrator = SurfaceGauss()

    def loft_and_integrate() -> None:
        patches = skin(closed_rows(sections.points, sections.corners, (end, end)))
        solid_integrals(patches, (None, None), contours.affine)

    told, guessed = LoftReconstructor(ends="round:2"), LoftReconstructor()
    timed("18 × 33 points: loft and integrate", loft_and_integrate)
    timed("18 loops: fit, seams, correspondence", lambda: equal_points(contours, 33))
    timed("18 loops to figures, ends told", lambda: integrator.integrate(told.reconstruct(contours)))
    timed(
        "18 loops to figures, ends guessed with their cost",
        lambda: integrator.integrate(guessed.reconstruct(contours)),
    )


if __name__ == "__main__":
    main()
