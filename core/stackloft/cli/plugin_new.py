"""``stackloft plugins new``: a complete package around a plug-in that already works.

Templates are packages of their own under ``templates/FAMILY``; ``$name`` is the plug-in's name, ``$package``
the Python package, ``$Class`` the class, ``$api`` the contract's version.
"""

from __future__ import annotations

import re
import sys
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from string import Template

from stackloft.contracts.families import API, FAMILIES
from stackloft.model.errors import OutputError, UsageError
from stackloft.registry.find import nearest
from stackloft.registry.scan import catalogue

USE = {
    "reader": "stackloft measure SOURCE",
    "segmenter": "stackloft measure SOURCE --segmenter {name}",
    "writer": "stackloft measure SOURCE --out RUN --write {name}",
}
"""How a plug-in of a family takes part in a run; others bring a method of their name."""
_BY_METHOD = "stackloft measure SOURCE --method {name}"
_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")


def run(family: str, name: str, out: Path | None) -> None:
    """Write the package and say what to do next.

    Parameters
    ----------
    family : str
        A family that has a kit.
    name : str
        The plug-in's and the distribution's name, lower case with hyphens.
    out : Path, optional
        A folder that is not there yet, or empty; None: `name` in the working directory.

    Raises
    ------
    UsageError
        No such family, or a name that cannot be used.
    OutputError
        The folder is not empty.
    """
    _check(family, name)
    folder = Path(name) if out is None else out
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise OutputError("is there already and not empty", where=str(folder), fix="give --out DIR")
    written = render(family, name)
    for path, text in written.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    sys.stdout.write(
        f"{family} {name}: {len(written)} files in {folder}\n\n"
        f"    cd {folder}\n"
        "    pip install --no-build-isolation --no-deps -e .\n"
        "    pytest\n"
        f"    stackloft plugins check {family}.{name}\n"
        f"    {use_of(family, name)}\n"
    )


def use_of(family: str, name: str) -> str:
    """Return the command line in which a new plug-in takes part.

    Examples
    --------
    >>> use_of("mesher", "acme-mesh")
    'stackloft measure SOURCE --method acme-mesh'
    """
    return USE.get(family, _BY_METHOD).format(name=name)


def families() -> tuple[str, ...]:
    """Return the families that there is a template for."""
    there = {item.name for item in files("stackloft.cli").joinpath("templates").iterdir()}
    return tuple(family for family in FAMILIES if family in there)


def render(family: str, name: str) -> dict[str, str]:
    """Return the files of a new package, text by path.

    Examples
    --------
    >>> sorted(render("integrator", "acme-sum"))[:3]
    ['README.md', 'pyproject.toml', 'src/acme_sum/__init__.py']
    """
    package = name.replace("-", "_")
    words = {
        "name": name,
        "package": package,
        "Class": "".join(part.capitalize() for part in name.split("-")),
        "family": family,
        "api": API,
        "use": use_of(family, name),
    }
    templates = files("stackloft.cli").joinpath("templates")
    texts = {**_texts(templates / "common"), **_texts(templates / family)}
    return {
        Template(path).substitute(words): Template(text).substitute(words) for path, text in texts.items()
    }


def _texts(folder: Traversable, above: str = "") -> dict[str, str]:
    """Return the templates of a folder by path; ``.tmpl`` keeps tools from taking them for code."""
    found: dict[str, str] = {}
    for item in folder.iterdir():
        if item.is_dir():
            found.update(_texts(item, f"{above}{item.name}/"))
        elif item.name.endswith(".tmpl"):
            found[f"{above}{item.name.removesuffix('.tmpl')}"] = item.read_text(encoding="utf-8")
    return found


def _check(family: str, name: str) -> None:
    known = families()
    if family not in known:
        reason = nearest(family, list(known))
        raise UsageError(f"no template for a {family}", expected=", ".join(known), fix=reason)
    if not _NAME.fullmatch(name):
        raise UsageError(f"{name!r} is no name for a plug-in", expected="lower case with hyphens: acme-xct")
    package = name.replace("-", "_")
    if package in sys.stdlib_module_names or package in {"stackloft", "stackloft_plugins"}:
        raise UsageError(f"{name!r} would hide the package {package}", fix="choose another name")
    for listing in catalogue(family):
        if listing.name == name:
            raise UsageError(
                f"{listing.distribution} already has a {family} {name!r}", fix="choose another name"
            )
