r"""One of several classes of grey levels in a scan: air, fat, flesh, bone.

::

    count   _                        thresholds t_1 < t_2 that make the variance between the
           / \    _       _          classes greatest; class 1 lies below t_1, class 2 between
          /   \__/ \_____/ \__       them, class 3 above t_2
             t_1       t_2     grey

Source: Otsu (1979); for several classes Liao, Chen & Chung (2001), J. Inf. Sci. Eng. 17:713.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SliceStack
from stackloft_plugins.segmenters.histogram_levels import grey_histogram, otsu
from stackloft_plugins.segmenters.slab_level import pooled_sample


def class_levels(stack: SliceStack, channel: str, classes: int, sample: int) -> tuple[float, ...]:
    """Return the levels between classes of a scan's grey levels, from a sample of its slices.

    Parameters
    ----------
    stack : SliceStack
    channel : str
        What grey is made of.
    classes : int
        2 to 4.
    sample : int
        How many slices are looked at, evenly from the first to the last.

    Raises
    ------
    InputError
        The scan has fewer grey levels than classes.
    """
    counts, centres = grey_histogram(pooled_sample(stack, channel, sample))
    if len(counts) < classes or np.count_nonzero(counts) < classes:
        raise InputError(
            f"cannot be told into {classes} classes",
            where=f"{stack.names[0]} … {stack.names[-1]}",
            found=f"{np.count_nonzero(counts)} grey levels",
        )
    if classes == 2:
        return (otsu(counts, centres),)
    from skimage.filters import threshold_multiotsu  # noqa: PLC0415 - slow to import, seldom used

    found = threshold_multiotsu(classes=classes, hist=(counts, centres))  # type: ignore[no-untyped-call]
    half = 0.5 * float(centres[1] - centres[0])
    return tuple(float(level) + half for level in found)


def class_window(levels: tuple[float, ...], wanted: int | None) -> tuple[float, float]:
    """Return from which grey level to which a class reaches; the outermost are open.

    Raises
    ------
    UsageError
        No class was named, or there is no such class.

    Examples
    --------
    >>> class_window((-500.0, 150.0), 2), class_window((-500.0, 150.0), 3)
    ((-500.0, 150.0), (150.0, inf))
    """
    bounds = (-np.inf, *levels, np.inf)
    told = ", ".join(f"{k}: {low:.4g} to {high:.4g}" for k, (low, high) in enumerate(pairwise(bounds), 1))
    if wanted is None or not 1 <= wanted <= len(levels) + 1:
        raise UsageError(
            "which class is the body?" if wanted is None else "no such class",
            where="--set segmenter.class",
            found="" if wanted is None else str(wanted),
            expected=told,
        )
    return float(bounds[wanted - 1]), float(bounds[wanted])
