"""Five bananas in a magnetic resonance scanner, and the label map that was drawn of them."""

from pathlib import Path

import numpy as np
import pytest
import SimpleITK

import stackloft

FOLDER = Path("/work/shared/real/banana_mri")
LABELS = FOLDER / "raw_segmentation.nii.gz"
GREY = FOLDER / "20140612_142959t2tsevflisos006a1001.nii.gz"
WITH_SIGNAL = 4
SPLIT = {"segmenter": {"split": 0.5}}
VOLUMES = "loft,cavalieri,frustum,voxel,partial-volume,crofton,isosurface,shape-interpolation"

pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason="the real scans are not here")


def drawn():
    """Return each label's largest component: its volume and its middle, in patient millimetres."""
    image = SimpleITK.ReadImage(str(LABELS))
    values = SimpleITK.GetArrayFromImage(image)
    found = {}
    for label in range(1, int(values.max()) + 1):
        one = SimpleITK.GetImageFromArray((values == label).astype(np.uint8))
        pieces = SimpleITK.RelabelComponent(SimpleITK.ConnectedComponent(one))
        found[label] = float((SimpleITK.GetArrayFromImage(pieces) == 1).sum()) * float(
            np.prod(image.GetSpacing())
        )
    return found


@pytest.mark.parametrize("label", [3])
def test_a_banana_of_the_label_map(label):
    result = stackloft.measure(LABELS, "loft,partial-volume,cavalieri", object=str(label))
    truth = drawn()[label]
    methods = result.objects[0].methods
    assert methods["partial-volume"].volume.value == pytest.approx(truth, rel=1e-9)
    for figures in methods.values():
        assert figures.volume.value == pytest.approx(truth, rel=0.01)


def with_signal():
    """Return the labels whose bananas are seen in the scan: one is as dark as the air."""
    labels, grey = (SimpleITK.GetArrayFromImage(SimpleITK.ReadImage(str(path))) for path in (LABELS, GREY))
    mean = {k: float(grey[labels == k].mean()) for k in range(1, int(labels.max()) + 1)}
    return [k for k, value in mean.items() if value > 0.3 * max(mean.values())]


@pytest.mark.prove
def test_all_bananas(proof):
    truths, rows = drawn(), []
    result = stackloft.measure(LABELS, VOLUMES, object="all")
    for label, body in enumerate(result.objects, start=1):
        for method, figures in body.methods.items():
            off = 100.0 * (figures.volume.value / truths[label] - 1.0)
            rows.append(
                ("label map", f"label {label}", method, f"{figures.volume.value:.0f}", f"{off:+.2f} %")
            )
            assert abs(off) < 1.0, (label, method)
    result = stackloft.measure(GREY, VOLUMES, object="all", settings=SPLIT)
    assert len(result.objects) == WITH_SIGNAL
    assert "bodies-cut" in {notice.code for notice in result.warnings}
    seen = sorted((truths[label], label) for label in with_signal())
    bodies = sorted(result.objects, key=lambda body: body.methods["voxel"].volume.value)
    for body, (truth, label) in zip(bodies, seen, strict=True):
        for method, figures in body.methods.items():
            if figures.error is not None:
                assert method == "partial-volume", (label, method)
                assert "brighter at its edge" in figures.error
                rows.append(
                    ("grey scan", f"label {label}", method, "refused", "the peel outshines the flesh")
                )
                continue
            off = 100.0 * (figures.volume.value / truth - 1.0)
            volume = f"{figures.volume.value:.0f}"
            rows.append(("grey scan", f"label {label}", method, volume, f"{off:+.2f} %"))
            assert abs(off) < 5.0, (label, method)
    claim = (
        "Five bananas (MRI, 1 mm voxels) against each label's largest component: from the label map, and "
        "from the grey scan alone by `--object all --set segmenter.split=0.5`, which finds those with signal"
    )
    proof("bananas", claim, ("from", "banana", "method", "V, mm³", "off by"), rows)
