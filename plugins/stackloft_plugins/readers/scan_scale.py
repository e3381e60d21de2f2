"""How well a scan's voxel size is known: by ``--scale-uncertainty``, else by ``stack.toml``."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.contour_stack import ContourStack
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.sectioning.calibration import HELP, calibrated

CALIBRATION = HELP
Product = TypeVar("Product", SliceStack, ContourStack, Segmentation)


def with_scale(product: Product, percent: float | None, path: Path) -> Product:
    """Return the product with what is known of its voxel size.

    Parameters
    ----------
    product : SliceStack, ContourStack or Segmentation
    percent : float or None
        As the flag gives it.
    path : Path
        The source; ``stack.toml`` in its folder is asked where the flag is silent.
    """
    if percent is None:
        percent = load_stack_file(path if path.is_dir() else path.parent).scale_uncertainty
    return calibrated(product, percent)
