"""The options of a plug-in, read off its source text: for shells, which cannot wait for an import."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from stackloft.registry.glance import source_of
from stackloft.registry.scan import Listing

_BOOLEANS = ("true", "false")


@dataclass(frozen=True, slots=True)
class GlimpsedOption:
    """What the text tells of one option."""

    name: str
    help: str = ""
    choices: tuple[str, ...] = ()
    """The allowed words, as far as the text tells them."""


def glimpse_options(listing: Listing) -> tuple[GlimpsedOption, ...]:
    """Return the options that the source of a plug-in declares; imports nothing and raises nothing.

    Examples
    --------
    >>> where = "stackloft_plugins.integrators.cavalieri:Cavalieri"
    >>> glimpse_options(Listing("integrator", "cavalieri", "", "", where))[0].choices
    ('rectangle', 'trapezoid')
    """
    module, _, name = listing.target.partition(":")
    try:
        return tuple({option.name: option for option in _of_class(module, name, 8)}.values())
    except (SyntaxError, ValueError, OSError, RecursionError):
        return ()


def _of_class(module: str, name: str, depth: int) -> Iterator[GlimpsedOption]:
    """Yield the options of a class, those of its bases first."""
    where, node = _definition(module, name, depth)
    if not isinstance(node, ast.ClassDef):
        return
    for base in node.bases:
        if isinstance(base, ast.Name) and depth:
            yield from _of_class(where, base.id, depth - 1)
    for item in node.body:
        if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name):
            kind = ast.unparse(item.annotation)
            if not kind.startswith(("ClassVar", "typing.ClassVar")) and not item.target.id.startswith("_"):
                yield _option(where, item.target.id, kind, item.value)


def _option(module: str, name: str, kind: str, value: ast.expr | None) -> GlimpsedOption:
    if not isinstance(value, ast.Call):
        return GlimpsedOption(name, "", _BOOLEANS if kind == "bool" else ())
    said = {item.arg: item.value for item in value.keywords if item.arg}
    about = value.args[1] if len(value.args) > 1 else said.get("help")
    text = about.value if isinstance(about, ast.Constant) and isinstance(about.value, str) else ""
    choices = tuple(_words(module, said["choices"], 8)) if "choices" in said else ()
    return GlimpsedOption(name, text, choices or (_BOOLEANS if kind == "bool" else ()))


def _words(module: str, node: ast.expr | None, depth: int) -> Iterator[str]:
    """Yield the texts that an expression of literals, names and ``tuple(…)`` comes to."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, (ast.Tuple, ast.List, ast.Set)):
        for item in node.elts:
            yield from _words(module, item, depth)
    elif isinstance(node, ast.Dict):
        for key in node.keys:
            yield from _words(module, key, depth)
    elif isinstance(node, ast.Starred):
        yield from _words(module, node.value, depth)
    elif isinstance(node, ast.Call) and node.args:
        yield from _words(module, node.args[0], depth)
    elif isinstance(node, ast.Name) and depth:
        where, found = _definition(module, node.id, depth)
        if isinstance(found, ast.expr):
            yield from _words(where, found, depth - 1)


def _definition(module: str, name: str, depth: int) -> tuple[str, ast.AST | None]:
    """Return where a name of `module` is defined, imports followed, and the class or value it stands for."""
    for node in _body(module):
        if isinstance(node, ast.ClassDef) and node.name == name:
            return module, node
        if isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if any(isinstance(target, ast.Name) and target.id == name for target in targets):
                return module, node.value
        if isinstance(node, ast.ImportFrom) and depth:
            original = next((x.name for x in node.names if (x.asname or x.name) == name), None)
            if original is not None:
                return _definition(_absolute(module, node), original, depth - 1)
    return module, None


def _absolute(module: str, node: ast.ImportFrom) -> str:
    package = module.split(".")[: -node.level] if node.level else []
    return ".".join([*package, *(node.module or "").split(".")])


@cache
def _body(module: str) -> tuple[ast.stmt, ...]:
    spec = source_of(module)
    if spec is None or not spec.origin or not spec.origin.endswith(".py"):
        return ()
    return tuple(ast.parse(Path(spec.origin).read_bytes()).body)
