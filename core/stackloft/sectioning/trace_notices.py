"""What is said of a slice when its loops are traced."""

from __future__ import annotations

from collections.abc import Iterator

from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField


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


def border_notice(section: SectionField, shape: tuple[int, int], name: str) -> Iterator[Notice]:
    """Yield what to say of a body that touches the picture's edges."""
    inside = section.above()
    (top, left), (rows, columns) = section.offset, inside.shape
    sides = {
        "top": top == 0 and inside[0].any(),
        "bottom": top + rows == shape[0] and inside[-1].any(),
        "left": left == 0 and inside[:, 0].any(),
        "right": left + columns == shape[1] and inside[:, -1].any(),
    }
    touched = [side for side, touches in sides.items() if touches]
    if touched:
        yield Notice(
            "border-contact",
            f"{name}: the body touches the picture's {' and '.join(touched)} edge and is cut off there; "
            "photograph it whole",
        )
