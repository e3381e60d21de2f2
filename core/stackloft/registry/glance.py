"""What can be told of a plug-in from its source text, without importing anything of it.

====================  ==================================================================
state                 means
====================  ==================================================================
``ok``                nothing speaks against it (``plugins doctor`` really loads it)
``newer``             written for a later minor version of the contract; used, with a warning
``refused``           written for another major version of the contract
``stale``             the entry point names a module or object that is not there
``missing package``   its module imports a package that is not installed
``unreadable``        its source is no Python
====================  ==================================================================
"""

from __future__ import annotations

import ast
import dataclasses
import sys
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from pathlib import Path

from stackloft.contracts.recipe import Recipe
from stackloft.registry.member_checks import api_faults, minor_api_notice
from stackloft.registry.scan import Listing

_RECIPE_API = str(next(item.default for item in dataclasses.fields(Recipe) if item.name == "api"))


@dataclass(frozen=True, slots=True)
class Glance:
    """What one look at the source told."""

    listing: Listing
    state: str
    """See the module's table."""
    reason: str = ""
    """Empty when the state is ``ok``."""
    api: str | None = None
    """The contract's version it is written for; None: cannot be told without importing."""
    path: Path | None = None
    """The source file."""


def glance(listing: Listing) -> Glance:
    """Return what the source of a plug-in tells; imports nothing and raises nothing.

    Examples
    --------
    >>> glance(Listing("reader", "ghost", "acme", "1", "acme_ghost:Reader")).state
    'stale'
    """
    module, _, attributes = listing.target.partition(":")
    spec = source_of(module)
    if spec is None:
        return Glance(listing, "stale", f"there is no module {module}; install {listing.distribution} again")
    path = Path(spec.origin) if spec.origin and spec.origin.endswith(".py") else None
    if path is None:
        return Glance(listing, "ok")
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError, OSError) as error:
        return Glance(listing, "unreadable", f"{type(error).__name__}: {error}", path=path)
    state, reason, api = _judged(tree, attributes.partition(".")[0], listing)
    return Glance(listing, state, reason, api, path)


def source_of(module: str) -> ModuleSpec | None:
    """Return where a module would be imported from, None when nowhere; parents are not imported.

    Examples
    --------
    >>> source_of("no_such_package.at_all") is None
    True
    """
    path, spec, name = None, None, ""
    for part in module.split("."):
        name = f"{name}.{part}" if name else part
        if name in sys.builtin_module_names:
            return ModuleSpec(name, None)
        finders = (getattr(finder, "find_spec", None) for finder in sys.meta_path)
        spec = next((found for find in finders if find and (found := find(name, path, None))), None)
        if spec is None:
            return None
        path = spec.submodule_search_locations
    return spec


def _judged(tree: ast.Module, name: str, listing: Listing) -> tuple[str, str, str | None]:
    """Return state, reason and API version that the source text shows."""
    known = _top_names(tree)
    if name not in known and not _open_ended(tree):
        reason = f"{listing.target.partition(':')[0]} has no {name}; install {listing.distribution} again"
        return "stale", reason, None
    api = _api_of(known.get(name), known)
    faults = [] if api is None else api_faults(api)
    if faults:
        return "refused", faults[0], api
    absent = sorted(package for package in _packages(tree) if source_of(package) is None)
    if absent:
        return "missing package", f"its module imports {', '.join(absent)}, which is not installed", api
    notices = () if api is None else minor_api_notice(listing.key, api)
    return ("newer", notices[0].message, api) if notices else ("ok", "", api)


def _top_names(tree: ast.Module) -> dict[str, ast.stmt]:
    """Return what a module defines at its top level, by name."""
    known: dict[str, ast.stmt] = {}
    for node in ast.walk(tree):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            known.setdefault(node.name, node)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            known.update({alias.asname or alias.name: node for alias in node.names})
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            known.update({target.id: node for target in targets if isinstance(target, ast.Name)})
    return known


def _open_ended(tree: ast.Module) -> bool:
    """Whether a module may have names that its text does not show."""
    names = _top_names(tree)
    return "*" in names or "__getattr__" in names


def _api_of(node: ast.stmt | None, known: dict[str, ast.stmt]) -> str | None:
    """Return the ``api`` of a plug-in class (or of its base in the same file) or of a recipe."""
    if isinstance(node, (ast.Assign, ast.AnnAssign)):
        return _recipe_api(node.value)
    if not isinstance(node, ast.ClassDef):
        return None
    for item in node.body:
        targets = item.targets if isinstance(item, ast.Assign) else [getattr(item, "target", None)]
        value = getattr(item, "value", None)
        if any(isinstance(target, ast.Name) and target.id == "api" for target in targets):
            return value.value if isinstance(value, ast.Constant) and isinstance(value.value, str) else None
    bases = [known.get(base.id) for base in node.bases if isinstance(base, ast.Name)]
    return next((api for base in bases if base is not node and (api := _api_of(base, known))), None)


def _recipe_api(value: ast.expr | None) -> str | None:
    if not (isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id == "Recipe"):
        return None
    said = [item.value for item in value.keywords if item.arg == "api"]
    constants = [item.value for item in said if isinstance(item, ast.Constant)]
    return _RECIPE_API if not said else next((text for text in constants if isinstance(text, str)), None)


def _packages(tree: ast.Module) -> set[str]:
    """Return the top-level packages that importing the module needs (guarded and late imports are not)."""
    packages = set()
    for node in tree.body:
        if isinstance(node, ast.Import):
            packages |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            packages.add(node.module.partition(".")[0])
    return packages
