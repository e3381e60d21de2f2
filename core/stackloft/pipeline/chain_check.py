r"""Whether the steps of a method fit together, and start from what was read.

::

    SliceStack --segmenter--> Segmentation --contours--> ContourStack     the ladder every run climbs
         \                         \                          \
          steps of the method enter where the first of them accepts
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import PluginError, StackloftError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.registry import Loaded, Quarantined, catalogue, find, load


def ladder(kind: type, *, segmented: bool) -> tuple[type, ...]:
    """Return `kind` and what follows from it without a method's help; `segmented`: a segmenter is there.

    Examples
    --------
    >>> [step.__name__ for step in ladder(SliceStack, segmented=True)]
    ['SliceStack', 'Segmentation', 'ContourStack']
    """
    if issubclass(kind, SliceStack):
        return (kind, Segmentation, ContourStack) if segmented else (kind,)
    return (kind, ContourStack) if issubclass(kind, Segmentation) else (kind,)


def check_chain(
    method: str, kinds: Sequence[type], segmenter: Loaded | None, steps: Sequence[Loaded]
) -> None:
    """Raise PluginError when the `steps` of `method` do not lead from the product types `kinds` on.

    The message names the nearest step that is missing, and the methods that do start from `kinds`.
    """
    reached = tuple(kinds)
    for number, step in enumerate(steps):
        rungs = [rung for kind in reached for rung in ladder(kind, segmented=segmenter is not None)]
        if not any(issubclass(rung, tuple(step.plugin.accepts)) for rung in rungs):
            fitting = _methods_from(kinds, segmenter) if number == 0 else ()
            raise _missing(method, rungs, step, fitting)
        reached = tuple(step.plugin.produces)
    if steps[-1].family != "integrator":
        raise PluginError(
            f"method {method} ends in {steps[-1].key}", expected="an integrator as its last step"
        )


def _missing(method: str, rungs: Sequence[type], step: Loaded, fitting: tuple[str, ...]) -> PluginError:
    have = " or ".join(dict.fromkeys(rung.__name__ for rung in rungs)) or "nothing"
    need = " or ".join(kind.__name__ for kind in step.plugin.accepts)
    bridge = _bridge(rungs, tuple(step.plugin.accepts))
    if bridge:
        fix = f"{bridge} makes that step; use a method that contains it before {step.key}"
    else:
        step_missing = "Segmentation (a segmenter)" if rungs and rungs[-1] is SliceStack else need
        fix = f"missing is a plug-in that turns {have} into {step_missing}{_quarantined()}"
    if fitting:
        fix += f"; methods that start from {have}: {', '.join(fitting)}"
    return PluginError(f"method {method}: {step.key} cannot take {have}", expected=need, fix=fix)


def _bridge(rungs: Iterable[type], needed: tuple[type, ...]) -> str | None:
    """Return the plug-in that makes the missing step, None when none is installed."""
    have = tuple(rungs)
    for listing in catalogue():
        if listing.family in {"reader", "writer", "recipe"}:
            continue
        outcome = load(listing)
        if isinstance(outcome, Quarantined):
            continue
        takes = any(issubclass(rung, tuple(outcome.plugin.accepts)) for rung in have)
        if takes and any(issubclass(kind, needed) for kind in outcome.plugin.produces):
            return outcome.key
    return None


def _quarantined() -> str:
    """Return the plug-ins that might have made the step but are broken, with their reasons."""
    outcomes = [load(x) for x in catalogue() if x.family not in {"reader", "writer", "recipe"}]
    broken = [f"{x.listing.key} ({x.reason})" for x in outcomes if isinstance(x, Quarantined)]
    return f"; quarantined: {', '.join(broken)}" if broken else ""


def _methods_from(kinds: Sequence[type], segmenter: Loaded | None) -> tuple[str, ...]:
    """Return the methods whose first step takes one of `kinds` or what follows from it."""
    rungs = [rung for kind in kinds for rung in ladder(kind, segmented=segmenter is not None)]
    fitting = []
    for listing in catalogue("recipe"):
        recipe = load(listing)
        if isinstance(recipe, Quarantined):
            continue
        family, _, name = recipe.plugin.steps[0].partition(".")
        try:
            first = find(family, name, prefer=listing.distribution)
        except StackloftError:
            continue
        if any(issubclass(rung, tuple(first.plugin.accepts)) for rung in rungs):
            fitting.append(listing.name)
    return tuple(fitting)
