"""Steps that take slices one by one share the one decoding pass, and refuse for themselves alone."""

from dataclasses import replace

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.run import measure
from stackloft.testing.conformance import ellipsoids

WITHOUT_CONTOURS = ("voxel", "partial-volume", "crofton", "isosurface")


def watched(fineness=2):
    """The kit's ellipsoid as a scan without its empty slices, and the slices decoded so far."""
    scan = ellipsoids.segmentation(fineness)
    decoded = []

    def decode(k):
        decoded.append(k)
        return scan.stack.decode(k + 2)

    m = len(scan) - 5
    stack = replace(
        scan.stack,
        decode=decode,
        names=scan.stack.names[2:-3],
        positions=scan.stack.positions[2:-3],
        pixel_spacing=scan.stack.pixel_spacing[2:-3],
        thickness=scan.stack.thickness[2:-3],
    )
    return replace(scan, stack=stack), decoded, m


def test_all_methods_decode_each_slice_once():
    scan, decoded, m = watched()
    result = measure(MeasureRequest("memory", method="all"), product=scan).result
    rows = result.objects[0].methods
    assert sorted(decoded) == list(range(m))
    assert {name: row.error for name, row in rows.items() if row.error} == {}
    assert set(rows) >= {"loft", "shape-interpolation", "cavalieri", "frustum", *WITHOUT_CONTOURS}
    for name, bound in (
        ("voxel", 1),
        ("partial-volume", 0.2),
        ("crofton", 1),
        ("isosurface", 1.5),
        ("loft", 1),
    ):
        assert abs(rows[name].volume.value / ellipsoids.VOLUME - 1) * 100 < bound, name
    for name in ("crofton", "isosurface", "loft", "shape-interpolation"):
        assert abs(rows[name].area.value / ellipsoids.AREA - 1) * 100 < 1.5, name
    assert rows["cavalieri"].volume.standard_uncertainty > 0
    assert "method-disagrees" not in [warning.code for warning in result.warnings]


def test_streamed_figures_are_those_of_the_integrator_itself():
    from stackloft_plugins.integrators.crofton import Crofton  # noqa: PLC0415
    from stackloft_plugins.integrators.voxel import Voxel  # noqa: PLC0415

    scan, _, _ = watched()
    rows = measure(MeasureRequest("m", method="voxel,crofton"), product=scan).result.objects[0].methods
    assert rows["voxel"].volume.value == Voxel().integrate(scan).volume
    assert rows["crofton"].area.value == Crofton().integrate(scan).area


def test_slices_without_a_body_stop_contours_but_not_voxels():
    scan = ellipsoids.segmentation(2)
    result = measure(MeasureRequest("m", method="voxel,loft"), product=scan).result
    body = result.objects[0]
    assert body.volume.value == pytest.approx(ellipsoids.VOLUME, rel=0.01)
    assert "no body found" in body.methods["loft"].error
    assert body.sections == ()
    with pytest.raises(InputError, match="no body found"):
        measure(MeasureRequest("m", method="loft,voxel"), product=scan)


def test_under_all_the_first_method_that_can_takes_the_lead():
    result = measure(MeasureRequest("m", method="all"), product=ellipsoids.segmentation(2)).result
    body = result.objects[0]
    assert body.volume.method == "crofton"
    assert body.methods["loft"].volume is None
    assert result.recipe["method"].startswith("crofton,")
    (told,) = [x for x in result.warnings if x.code == "main-method"]
    assert told.message.startswith("loft gives no figures (slice 1: no body found")


def test_a_volume_above_its_memory_is_a_row_with_the_reason():
    scan, _, _ = watched()
    request = MeasureRequest("m", method="voxel,crofton", settings={"crofton": {"memory": 0.01}})
    row = measure(request, product=scan).result.objects[0].methods["crofton"]
    assert "needs the whole volume" in row.error
    assert "at most 0.01 MB" in row.error


def test_when_everybody_has_refused_the_pass_ends():
    decoded = []

    def decode(k):
        decoded.append(k)
        return np.zeros((20, 20))

    m = 40
    stack = SliceStack(
        decode,
        tuple(map(str, range(m))),
        (20, 20),
        np.arange(float(m)),
        np.ones((m, 2)),
        SectionKind.SLAB,
    )
    empty = Segmentation(stack, lambda _, picture: SectionField(picture, 1.0))
    with pytest.raises(InputError, match="no body found"):
        measure(MeasureRequest("m"), product=empty)
    assert len(decoded) < 6


def test_a_slice_that_cannot_be_decoded_fails_them_all_with_one_reason():
    scan, _, _ = watched()

    def decode(k):
        raise InputError("unreadable", where=f"slice {k}")

    broken = replace(scan, stack=replace(scan.stack, decode=decode))
    with pytest.raises(InputError, match="slice 0: unreadable"):
        measure(MeasureRequest("m", method="all"), product=broken)
