"""Whether the compiled kernels are used here, and how to get them; nothing is broken without them."""

from __future__ import annotations

from stackloft.cli.doctor.row import Row
from stackloft.compiled.building import LIBRARY, SWITCH, compiler, wanted
from stackloft.compiled.library import kernels, why_not

BUILD = "python -m stackloft.compiled.building"


def compiled_kernels() -> Row:
    """Return whether the library of compiled kernels is loaded."""
    if kernels() is not None:
        return Row("kernels", "compiled", "ok", str(LIBRARY))
    if not wanted():
        fix = f"unset {SWITCH}"
    else:
        fix = BUILD if compiler() else f"apt-get install gcc libc6-dev, then: {BUILD}"
    return Row("kernels", "compiled", "warning", f"not used, scans take longer: {why_not()}", fix)
