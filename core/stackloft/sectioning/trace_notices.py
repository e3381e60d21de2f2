"""What is said of a slice when its loops are traced."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from stackloft.model.notices import Notice

SIDES = ("top", "bottom", "left", "right")


def dropped_notice(share: float, name: str) -> Notice:
    """Return what to say of an outline left out, `share` of the body's area."""
    return Notice(
        "second-object",
        f"{name}: left out a second object of {100 * share:.1f} % of the body's area; "
        "move it out of the picture, or give a mask in stack.toml if it belongs to the body",
    )


def filled_notice(share: float, unnoticed: float, name: str) -> Iterator[Notice]:
    """Yield what to say of holes filled, `share` of the body's area, unless too small to notice."""
    if share >= unnoticed:
        yield Notice(
            "hole-filled",
            f"{name}: filled holes of {100 * share:.2g} % of the body's area, taken for glare or seeds",
        )


def border_notice(touched: Iterable[str], name: str) -> Iterator[Notice]:
    """Yield what to say of a body that touches the picture's edges, named ``top``, ``left`` and so on."""
    sides = [side for side in SIDES if side in touched]
    if sides:
        yield Notice(
            "border-contact",
            f"{name}: the body touches the picture's {' and '.join(sides)} edge and is cut off there; "
            "photograph it whole",
        )
