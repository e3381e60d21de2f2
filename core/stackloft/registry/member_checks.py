"""What a plug-in must look like before it is let in: its own words, not its results."""

from __future__ import annotations

import dataclasses
from typing import Any

from stackloft.contracts.families import API
from stackloft.contracts.recipe import Recipe
from stackloft.model.notices import Notice
from stackloft.registry.fields import default_of

METHODS = {
    "reader": ("probe", "read"),
    "segmenter": ("segment",),
    "reconstructor": ("reconstruct",),
    "mesher": ("mesh",),
    "integrator": ("integrate",),
    "writer": ("write",),
}
"""The methods of each family's Protocol."""

RUN = {family: methods[-1] for family, methods in METHODS.items()}
"""The method of each family that does its work."""


def faults_of(family: str, plugin: Any) -> tuple[str, ...]:
    """Return what keeps `plugin` from being used in `family`; empty when nothing does.

    Examples
    --------
    >>> faults_of("integrator", int)[0]
    'has no api version'
    """
    if family == "recipe":
        return tuple(_recipe_faults(plugin))
    return (
        *api_faults(getattr(plugin, "api", None)),
        *_dataclass_faults(plugin),
        *_member_faults(family, plugin),
    )


def minor_api_notice(key: str, api: str) -> tuple[Notice, ...]:
    """Return a notice when a plug-in was written for a later minor version of the contract."""
    if _version(api) <= _version(API):
        return ()
    message = f"{key} is written for contract {api}, this stackloft offers {API}; it may miss something"
    return (Notice("plugin-api-minor", message),)


def _version(api: str) -> tuple[int, ...]:
    return tuple(int(part) for part in f"{api}.0".split(".")[:2])


def api_faults(api: Any) -> list[str]:
    """Return why a plug-in that says it is written for contract `api` is refused; empty when it is not.

    Another major version is refused; a later minor one is only noticed (`minor_api_notice`).

    Examples
    --------
    >>> api_faults("1.7"), api_faults("2")
    ([], ["api 2 does not fit this stackloft's contract 1"])
    """
    if api is None:
        return ["has no api version"]
    if not isinstance(api, str) or not all(part.isdigit() for part in api.split(".")):
        return [f'api must be text such as "{API}", found {api!r}']
    if _version(api)[0] != _version(API)[0]:
        return [f"api {api} does not fit this stackloft's contract {API}"]
    return []


def _dataclass_faults(plugin: Any) -> list[str]:
    if not (isinstance(plugin, type) and dataclasses.is_dataclass(plugin)):
        return ["is not a dataclass"]
    if not plugin.__dataclass_params__.frozen:  # type: ignore[attr-defined]  # dataclass internals
        return ["is a dataclass that is not frozen"]
    return [fault for item in dataclasses.fields(plugin) if item.init for fault in _field_faults(item)]


def _field_faults(item: dataclasses.Field[Any]) -> list[str]:
    if item.default is dataclasses.MISSING and item.default_factory is dataclasses.MISSING:
        return [f"option {item.name} has no default"]
    try:
        hash(default_of(item))
    except TypeError:
        return [f"option {item.name} has a mutable default ({type(default_of(item)).__name__})"]
    return []


def _member_faults(family: str, plugin: Any) -> list[str]:
    faults = [
        f"has no method {name}()" for name in METHODS[family] if not callable(getattr(plugin, name, None))
    ]
    for name in ("accepts", "produces"):
        types = getattr(plugin, name, None)
        if not isinstance(types, tuple) or not all(isinstance(item, type) for item in types):
            faults.append(f"{name} must be a tuple of types")
    if family == "writer" and not isinstance(getattr(plugin, "suffixes", None), tuple):
        faults.append("suffixes must be a tuple of file suffixes")
    return faults


def _recipe_faults(recipe: Any) -> list[str]:
    if not isinstance(recipe, Recipe):
        return [f"is not a Recipe but {type(recipe).__name__}"]
    faults = api_faults(recipe.api)
    if not recipe.steps:
        faults.append("has no steps")
    for step in recipe.steps:
        family, dot, name = step.partition(".")
        if not dot or not name or family not in METHODS or family in {"reader", "writer"}:
            faults.append(f"step {step!r} is not family.name of a step")
    return faults
