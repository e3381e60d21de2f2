"""What is known of a written phantom: ``answer.json`` and the keys of ``stack.toml``."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.phantom import Phantom

KEYS = (
    "kind",
    "pixel_size",
    "thickness",
    "positions",
    "ends",
    "end_lengths",
    "height",
    "background",
    "specimen",
    "reference",
    "reference_height",
    "reference_stays",
    "fiducials",
    "camera",
)
"""What a folder can be made to tell; ``ends`` names the kinds of end, ``end_lengths`` their distances too."""


def answer(phantom: Phantom, positions: FloatArray) -> dict[str, Any]:
    """Return the exact figures and how the body was made, ready for JSON.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> known = answer(phantoms.make("box", a=10, b=20, c=30), [0.0])
    >>> known["volume"], known["height"]
    ({'value': 6000, 'unit': 'mm^3'}, 30.0)
    """
    low, high = phantom.extent()
    return {
        "schema": "stackloft.answer/1",
        "phantom": phantom.name,
        "parameters": dict(phantom.body.parameters),
        "rotation": phantom.rotation.tolist(),
        "offset": phantom.offset.tolist(),
        "volume": {"value": phantom.volume, "unit": "mm^3"},
        "area": {"value": phantom.area, "unit": "mm^2"},
        "extent": [low, high],
        "height": high - low,
        "ends": list(phantom.end_kinds),
        "positions": [float(z) for z in positions],
    }


def stack_toml(
    phantom: Phantom, positions: FloatArray, tell: Collection[str], told: Mapping[str, str]
) -> str:
    """Return the text of ``stack.toml`` with the keys asked for.

    `told` holds the values, written as TOML, that the pictures decide: pixel size, background, camera.

    Raises
    ------
    UsageError
        A key that is not among `KEYS`, or a thickness asked for where the positions are not equally spaced.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> bar = phantoms.make("prism", height=60)
    >>> print(stack_toml(bar, bar.positions(3), ["thickness", "end_lengths"], {}), end="")
    thickness = "20mm"
    ends = "flat:10mm,flat:10mm"
    """
    unknown = [key for key in tell if key not in KEYS]
    if unknown:
        raise UsageError("unknown key", where="tell", found=unknown[0], expected=", ".join(KEYS))
    values: Mapping[str, str] = {
        "kind": '"face"',
        "thickness": f'"{_pitch(positions):.12g}mm"' if "thickness" in tell else "",
        "positions": f'"{",".join(f"{z - positions[0]:.12g}" for z in positions)}mm"',
        "ends": f'"{ends_text(phantom, positions, lengths=False)}"',
        "end_lengths": f'"{ends_text(phantom, positions, lengths=True)}"',
        "height": f'"{phantom.height:.12g}mm"',
        "specimen": f'"{phantom.name}"',
        **told,
    }
    for key in tell:
        if key not in values:
            raise UsageError("there is none to tell of", where="tell", found=key)
    wanted = [key for key in KEYS if key in tell and not (key == "ends" and "end_lengths" in tell)]
    return "".join(f"{'ends' if key == 'end_lengths' else key} = {values[key]}\n" for key in wanted)


def ends_text(phantom: Phantom, positions: FloatArray, *, lengths: bool) -> str:
    """Return the ends as ``--ends`` takes them; a plane end off the section always has its length.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> roast = phantoms.make("meat")
    >>> ends_text(roast, roast.positions(11, "faces"), lengths=True)
    'face,round:16mm'
    """
    low, high = phantom.extent()
    words = []
    for kind, distance in zip(phantom.end_kinds, (positions[0] - low, high - positions[-1]), strict=True):
        if kind == "face":
            words.append("face" if abs(distance) < 1e-9 * phantom.height else f"flat:{distance:.12g}mm")
        else:
            words.append(f"{kind}:{distance:.12g}mm" if lengths and kind != "auto" else kind)
    return ",".join(words)


def _pitch(positions: FloatArray) -> float:
    pitch = float(positions[-1] - positions[0]) / (len(positions) - 1)
    even = all(abs(z - positions[0] - i * pitch) < 1e-9 * (1 + abs(z)) for i, z in enumerate(positions))
    if not even:
        raise UsageError(
            "positions are not equally spaced", where="tell", found="thickness", fix="tell positions"
        )
    return pitch
