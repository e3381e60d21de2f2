"""From integrals to what a person is handed."""

from __future__ import annotations

import math
from collections.abc import Sequence

from stackloft.model.errors import InputError, PluginError
from stackloft.model.measurement import Figure, Integral, MethodRow


def method_row(method: str, integral: Integral, seconds: float) -> MethodRow:
    """Return the row of one method.

    Raises
    ------
    PluginError
        A figure is not finite or is negative, or there is none.
    InputError
        The body has no volume.
    """
    volume, area = (_checked(method, name, getattr(integral, name)) for name in ("volume", "area"))
    if volume is None and area is None:
        raise PluginError(f"method {method} gave neither volume nor area")
    if volume == 0:
        raise InputError("the body has no volume", where=f"method {method}")
    return MethodRow(
        None if volume is None else Figure(volume, "mm^3", method, integral.volume_uncertainty),
        None if area is None else Figure(area, "mm^2", method, integral.area_uncertainty),
        seconds,
    )


def derived_figures(volume: float, area: float | None, weight: float | None) -> dict[str, float | None]:
    """Return what follows from volume (mm³), area (mm²) and weight (g).

    Returns
    -------
    dict
        ``equivalent_diameter`` (6V/π)^(1/3), mm; ``sphericity`` π^(1/3)(6V)^(2/3)/S (Wadell 1935);
        ``specific_surface`` S/V, 1/mm; ``density`` g/cm³; None where something is not known.

    Examples
    --------
    >>> ball = derived_figures(4 / 3 * math.pi * 10**3, 4 * math.pi * 10**2, None)
    >>> [round(ball[name], 12) for name in ("equivalent_diameter", "sphericity", "specific_surface")]
    [20.0, 1.0, 0.3]
    """
    return {
        "equivalent_diameter": math.cbrt(6 * volume / math.pi),
        "sphericity": math.cbrt(math.pi) * math.cbrt(6 * volume) ** 2 / area if area else None,
        "specific_surface": None if area is None else area / volume,
        "density": None if weight is None else weight / (volume / 1000),
    }


def require_volume(rows: Sequence[MethodRow], names: Sequence[str]) -> Figure:
    """Return the primary method's volume; a method without one cannot be the primary one."""
    if rows[0].volume is not None:
        return rows[0].volume
    others = [name for name, row in zip(names, rows, strict=True) if row.volume is not None]
    fix = f"name a method that gives a volume first: --method {others[0] if others else 'loft'},{names[0]}"
    raise InputError(f"method {names[0]} gives no volume", where="--method", fix=fix)


def _checked(method: str, name: str, value: float | None) -> float | None:
    if value is None:
        return None
    number = float(value)
    if not math.isfinite(number) or number < 0:
        raise PluginError(f"method {method} gave no {name} that can be true", found=f"{number:g}")
    return number
