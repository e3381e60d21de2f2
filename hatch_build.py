"""hatchling's build hook: compiles the kernels in C, where there is a compiler, into the wheel or in place.

Without a compiler the wheel is pure Python and stackloft works all the same, slower on scans.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from hatchling.builders.config import BuilderConfig
from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import platform_tags

COMPILED = "stackloft/compiled"


class KernelsHook(BuildHookInterface[BuilderConfig]):
    """Adds the library of compiled kernels to wheels; makes it beside its sources for editable installs."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before files are gathered."""
        building = _building(Path(self.root))
        if self.target_name != "wheel" or not building.wanted():
            return
        if version == "editable":
            building.build()
            return
        self._scratch = TemporaryDirectory(prefix="stackloft-")
        library = building.build(Path(self._scratch.name) / building.LIBRARY.name)
        if library is None:
            return
        build_data["force_include"][str(library)] = f"{COMPILED}/{library.name}"
        build_data["pure_python"] = False
        # Called by ctypes, so one library does for every Python 3 of the platform.
        build_data["tag"] = f"py3-none-{_platform()}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Remove the library that went into the wheel."""
        if hasattr(self, "_scratch"):
            self._scratch.cleanup()


def _building(root: Path) -> ModuleType:
    """Return ``building.py``, loaded by its path: what it is part of is not installed yet."""
    spec = importlib.util.spec_from_file_location("building", root / "core" / COMPILED / "building.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _platform() -> str:
    """Return this machine's tag, such as ``linux_x86_64``; manylinux would promise what nobody checked."""
    return next(tag for tag in platform_tags() if not tag.startswith(("manylinux", "musllinux")))
