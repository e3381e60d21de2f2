"""Heavy packages and the system libraries under them: importable here, or what to install."""

from __future__ import annotations

import importlib
import re
import traceback

from stackloft.cli.doctor.row import Row
from stackloft.registry.child import ask_child

HEAVY = {
    "pymeshlab": "pymeshlab",
    "pytetwild": "pytetwild[all]",
    "vtkmodules.vtkCommonCore": "vtk",
    "SimpleITK": "SimpleITK",
    "cv2": "opencv-python-headless",
    "pydicom": "pydicom",
    "skimage.measure": "scikit-image",
}
"""What the built-in plug-ins import when they need it, with its name for pip."""

DEBIAN = {
    "libGL.so.1": "libgl1",
    "libOpenGL.so.0": "libopengl0",
    "libEGL.so.1": "libegl1",
    "libGLU.so.1": "libglu1-mesa",
    "libGLX.so.0": "libglx0",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXrender.so.1": "libxrender1",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libgomp.so.1": "libgomp1",
    "libglib-2.0.so.0": "libglib2.0-0",
    "libgthread-2.0.so.0": "libglib2.0-0",
    "libstdc++.so.6": "libstdc++6",
    "libxcb.so.1": "libxcb1",
    "libfontconfig.so.1": "libfontconfig1",
    "libOSMesa.so.8": "libosmesa6",
}
"""Shared libraries and the Debian and Ubuntu packages they come with."""

_TOGETHER = {"pymeshlab": ("libgl1", "libopengl0")}
"""Packages that need more than the first library the loader misses."""
_ABSENT = re.compile(r"(lib[\w.+-]+\.so[\w.]*): cannot open shared object file")


def packages() -> list[Row]:
    """Return a row for each heavy package, imported in a child process of its own."""
    rows = []
    for module, package in HEAVY.items():
        answer = ask_child("stackloft.cli.doctor.libraries:import_fault", module)
        fault, trace = (answer.fault, answer.stderr) if answer.fault else answer.value
        rows.append(_row(module, package, fault, trace))
    return rows


def _row(module: str, package: str, fault: str, trace: str) -> Row:
    name = module.partition(".")[0]
    if not fault:
        return Row("package", name, "ok")
    library, fix = system_fix(fault, name)
    detail = f"the system library {library} is missing" if library else fault
    return Row("package", name, "broken", detail, fix or f"python -m pip install '{package}'", trace)


def system_fix(fault: str, package: str = "") -> tuple[str, str]:
    """Return the system library that an import error misses, and the line that installs it.

    Examples
    --------
    >>> system_fix("libGL.so.1: cannot open shared object file: No such file", "pymeshlab")
    ('libGL.so.1', 'apt-get install libgl1 libopengl0')
    >>> system_fix("No module named 'vtk'")
    ('', '')
    """
    found = _ABSENT.search(fault)
    if found is None:
        return "", ""
    library = found.group(1)
    wanted = [DEBIAN[library]] if library in DEBIAN else []
    names = dict.fromkeys([*_TOGETHER.get(package, ()), *wanted])
    if not names:
        return library, f"apt-file search {library} tells the package to install"
    return library, f"apt-get install {' '.join(names)}"


def import_fault(module: str) -> tuple[str, str]:
    """Import a module in this process; return what went wrong and the traceback, empty when nothing did.

    Examples
    --------
    >>> import_fault("json")
    ('', '')
    """
    try:
        importlib.import_module(module)
    except Exception as error:  # noqa: BLE001 - a package may raise anything on import
        return f"{type(error).__name__}: {error}", traceback.format_exc()
    return "", ""
