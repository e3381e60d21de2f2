"""Entry points are written at install: what an edit of ``pyproject.toml`` has made stale since."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable
from importlib.metadata import Distribution, distributions
from pathlib import Path
from urllib.parse import unquote, urlparse

from stackloft.cli.doctor.row import Row
from stackloft.contracts.families import FAMILIES

GROUPS = frozenset(f"stackloft.{family}s" for family in FAMILIES)


def stale_entry_points(found: Iterable[Distribution] | None = None) -> list[Row]:
    """Return a row for each editable distribution whose plug-ins differ from its ``pyproject.toml``.

    Parameters
    ----------
    found : iterable of Distribution, optional
        Those looked at; None: all that are installed.
    """
    rows = (_compared(dist) for dist in (distributions() if found is None else found))
    return [row for row in rows if row is not None]


def _compared(dist: Distribution) -> Row | None:
    folder = editable_folder(dist)
    declared = None if folder is None else _declared(folder / "pyproject.toml")
    if folder is None or declared is None:
        return None
    installed = {(x.group, x.name, x.value) for x in dist.entry_points if x.group in GROUPS}
    if not installed | declared:
        return None
    name = dist.metadata["Name"]
    if installed == declared:
        return Row("entry point", name, "ok", f"{len(installed)} as in {folder / 'pyproject.toml'}")
    parts = [
        f"{word}: {', '.join(f'{group} {key} = {target}' for group, key, target in sorted(difference))}"
        for word, difference in (
            ("in pyproject.toml but not installed", declared - installed),
            ("installed but no longer in pyproject.toml", installed - declared),
        )
        if difference
    ]
    fix = f"python -m pip install --no-build-isolation --no-deps -e {folder}"
    return Row("entry point", name, "broken", "; ".join(parts), fix)


def editable_folder(dist: Distribution) -> Path | None:
    """Return the folder an editable distribution is installed from, None when it is none (PEP 610)."""
    try:
        origin = json.loads(dist.read_text("direct_url.json") or "{}")
    except ValueError:
        return None
    url = urlparse(str(origin.get("url", "")))
    editable = bool(origin.get("dir_info", {}).get("editable")) and url.scheme == "file"
    return Path(unquote(url.path)) if editable else None


def _declared(pyproject: Path) -> set[tuple[str, str, str]] | None:
    """Return the plug-ins that a project declares; None when it does not say (or computes) them."""
    try:
        project = tomllib.loads(pyproject.read_text(encoding="utf-8")).get("project")
    except (OSError, ValueError):
        return None
    if not isinstance(project, dict) or "entry-points" in project.get("dynamic", ()):
        return None
    groups = project.get("entry-points", {})
    return {
        (group, name, target)
        for group, targets in groups.items()
        if group in GROUPS
        for name, target in targets.items()
    }
