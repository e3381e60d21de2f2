"""A distribution that is installed for the length of a test: how a stranger's plug-in arrives."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from textwrap import dedent

from stackloft.registry import rescan


def write_distribution(
    folder: Path,
    name: str,
    entry_points: Mapping[str, Mapping[str, str]],
    modules: Mapping[str, str],
    version: str = "1.0",
) -> Path:
    """Write modules and metadata as an installer would leave them in site-packages.

    Parameters
    ----------
    folder : Path
        Stands for site-packages; put it on the path to install the distribution.
    name, version : str
        Of the distribution.
    entry_points : mapping
        Targets by name, by group, for example ``{"stackloft.readers": {"acme": "acme_xct:Reader"}}``.
    modules : mapping
        Source text by module name.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     site = write_distribution(Path(folder), "acme-xct", {}, {"acme_xct": "x = 1"})
    ...     sorted(item.name for item in site.iterdir())
    ['acme_xct-1.0.dist-info', 'acme_xct.py']
    """
    info = folder / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    groups = [
        f"[{group}]\n" + "".join(f"{key} = {target}\n" for key, target in targets.items())
        for group, targets in entry_points.items()
    ]
    (info / "entry_points.txt").write_text("\n".join(groups))
    for module, text in modules.items():
        (folder / f"{module}.py").write_text(dedent(text))
    return folder


@contextmanager
def installed(
    folder: Path,
    name: str,
    entry_points: Mapping[str, Mapping[str, str]],
    modules: Mapping[str, str],
    version: str = "1.0",
) -> Iterator[None]:
    """Install a distribution (as `write_distribution`) into this process while the block runs."""
    site = str(write_distribution(folder, name, entry_points, modules, version))
    sys.path.insert(0, site)
    _refresh(())
    try:
        yield
    finally:
        sys.path.remove(site)
        _refresh(modules)


def _refresh(modules: Mapping[str, str] | tuple[()]) -> None:
    for module in modules:
        sys.modules.pop(module, None)
    importlib.invalidate_caches()
    rescan()
