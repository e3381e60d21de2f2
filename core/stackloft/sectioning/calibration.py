"""How well a scanner's voxel size is known, from its calibration, told to a stack."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from stackloft.model.contour_stack import ContourStack
from stackloft.model.notices import Notice
from stackloft.model.scale import ScaleUncertainty
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack

Product = TypeVar("Product", SliceStack, ContourStack, Segmentation)
HELP = "standard uncertainty of the voxel size, in every direction, from the scanner's calibration"


def calibrated(product: Product, percent: float | None) -> Product:
    """Return the product with a voxel size that is known to `percent`; as it is where nobody said so.

    All three directions share the error, so that volume is known to three times as much, area to twice.

    Examples
    --------
    >>> stack = SliceStack(lambda k: np.zeros((4, 4)), ("a", "b"), (4, 4), np.array([0.0, 1.0]),
    ...                    np.ones((2, 2)), "slab")
    >>> known = calibrated(stack, 0.2)
    >>> known.scale_uncertainty.common, known.notices[0].message
    (0.002, 'the voxel size is known to 0.2 %: volume to 0.6 %, area to 0.4 % by that alone')
    """
    if not percent:
        return product
    if isinstance(product, Segmentation):
        return replace(product, stack=calibrated(product.stack, percent))
    text = (
        f"the voxel size is known to {percent:g} %: volume to {3 * percent:g} %, area to {2 * percent:g} % "
        "by that alone"
    )
    own = ScaleUncertainty(percent / 100, np.zeros(len(product)), "--scale-uncertainty", isotropic=True)
    notices = (*product.notices, Notice("scale-uncertainty", text))
    return replace(product, scale_uncertainty=own, notices=notices)
