"""What a run will do, checked before anything is decoded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from stackloft.model.bias import Bias
from stackloft.model.errors import PluginError, StackloftError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import SliceStack
from stackloft.model.tri_mesh import TriMesh
from stackloft.pipeline.chain_check import check_chain
from stackloft.pipeline.layers import Place, check_addresses, check_preset, options_at
from stackloft.pipeline.request import ALL_METHODS, DEFAULT_METHOD, SURFACE_METHOD, MeasureRequest
from stackloft.registry import Loaded, catalogue, choose_reader, find, instantiate, load

OWN = "stackloft"
"""This distribution: its default method stays the primary one of ``all`` when a stranger uses its name."""


@dataclass(frozen=True, slots=True)
class Step:
    """One plug-in with its options, ready to run."""

    loaded: Loaded
    options: Mapping[str, Any]
    """Every option, validated."""
    instance: Any

    @property
    def key(self) -> str:
        """``family.name`` of its plug-in."""
        return self.loaded.key


@dataclass(frozen=True, slots=True)
class Method:
    """One method's steps, or why it cannot run."""

    name: str
    steps: tuple[Step, ...] = ()
    error: StackloftError | None = None
    volume_bias: Bias | None = None
    area_bias: Bias | None = None
    """What its recipe knows of its errors (`Recipe`)."""


@dataclass(frozen=True, slots=True)
class Plan:
    """A whole run; the first method is the primary one."""

    reader: Step | None
    """None when a product is measured that is already in memory."""
    segmenter: Step | None
    """None when what is read are no slices."""
    methods: tuple[Method, ...]
    notices: tuple[Notice, ...] = ()

    def steps(self) -> Iterator[Step]:
        """Yield every step, each method's in order."""
        yield from (step for step in (self.reader, self.segmenter) if step is not None)
        for method in self.methods:
            yield from method.steps


def make_plan(request: MeasureRequest, product: Any = None) -> Plan:
    """Return the plan of a run over ``request.source``, or over `product` when one is given.

    Raises
    ------
    StackloftError
        No reader, an unknown or broken plug-in, steps that do not fit, or an option that is unknown
        or not allowed. Under ``all`` a method that cannot run keeps its reason instead.
    """
    reader = None if product is not None else choose_reader(request.source, request.reader)
    kinds = (type(product),) if reader is None else tuple(reader.plugin.produces)
    segmenter = _choose_segmenter(request, kinds)
    asked = default_method(kinds) if request.method is None else request.method
    names = [name for name in method_names(asked) if asked != ALL_METHODS or _may_start(name, kinds)]
    recipes = [_outline(name, kinds, segmenter, asked) for name in names]
    if asked == ALL_METHODS:
        recipes.sort(key=lambda recipe: isinstance(recipe[1], StackloftError))
    shared = [Place(loaded) for loaded in (reader, segmenter) if loaded is not None]
    own = [place for _, places in recipes if not isinstance(places, StackloftError) for place in places]
    notices = check_addresses([*shared, *own], request)
    if reader is None and request.reader is not None:
        raise UsageError("a product that is already read takes no reader", where="--reader")
    loaded_notices = tuple(notice for place in [*shared, *own] for notice in place.loaded.notices)
    return Plan(
        _step(Place(reader), request) if reader else None,
        _step(Place(segmenter), request) if segmenter else None,
        tuple(_method(name, places, request) for name, places in recipes),
        (*loaded_notices, *notices),
    )


def default_method(kinds: tuple[type, ...]) -> str:
    """Return the method that is taken when nobody names one and `kinds` may be read.

    Examples
    --------
    >>> default_method((SliceStack,)), default_method((TriMesh,))
    ('loft', 'polyhedral')
    """
    return SURFACE_METHOD if all(issubclass(kind, TriMesh) for kind in kinds) else DEFAULT_METHOD


def method_names(method: str) -> tuple[str, ...]:
    """Return the methods that `method` names, the primary one first.

    Examples
    --------
    >>> method_names("frustum, cavalieri")
    ('frustum', 'cavalieri')
    """
    if method != ALL_METHODS:
        names = tuple(dict.fromkeys(name.strip() for name in method.split(",") if name.strip()))
        if not names or ALL_METHODS in names:
            raise UsageError(
                "not a method", where="--method", found=repr(method), expected="NAME, NAME,NAME or all"
            )
        return names
    known = sorted(
        catalogue("recipe"), key=lambda x: (x.name != DEFAULT_METHOD, x.distribution != OWN, x.name)
    )
    return tuple(x.qualified if x.clash else x.name for x in known)


def _choose_segmenter(request: MeasureRequest, kinds: tuple[type, ...]) -> Loaded | None:
    if not any(issubclass(kind, SliceStack) for kind in kinds):
        return None
    if request.segmenter is not None:
        return find("segmenter", request.segmenter)
    outcomes = [load(listing) for listing in catalogue("segmenter")]
    fitting = [x for x in outcomes if isinstance(x, Loaded) and SliceStack in x.plugin.accepts]
    if len(fitting) > 1:
        fitting = [x for x in fitting if getattr(x.plugin, "general", False)] or fitting
    if len(fitting) > 1:
        names = [x.listing.qualified if x.listing.clash else x.name for x in fitting]
        found = ", ".join(names)
        raise PluginError("several segmenters fit these slices", found=found, fix=f"--segmenter {names[0]}")
    return fitting[0] if fitting else None


def _may_start(name: str, kinds: tuple[type, ...]) -> bool:
    """Return whether anybody would miss the method under ``all``: no slow one, none for surfaces not read."""
    recipe = load(next(x for x in catalogue("recipe") if name in {x.name, x.qualified}))
    if isinstance(recipe, Loaded) and recipe.plugin.slow:
        return False  # minutes for a body: only for who names it
    if any(issubclass(kind, TriMesh) for kind in kinds) or not isinstance(recipe, Loaded):
        return True
    family, _, first = recipe.plugin.steps[0].partition(".")
    try:
        taken = find(family, first, prefer=recipe.listing.distribution).plugin.accepts
    except StackloftError:
        return True
    return any(not issubclass(kind, TriMesh) for kind in taken)


def _outline(
    name: str, kinds: tuple[type, ...], segmenter: Loaded | None, asked: str
) -> tuple[str, list[Place] | StackloftError]:
    """Return a method's places, or under ``all`` the error that keeps it from running."""
    try:
        recipe = find("recipe", name)
        places = [_place(step, name, recipe) for step in recipe.plugin.steps]
        check_chain(name, kinds, segmenter, [place.loaded for place in places])
        for place in places:
            check_preset(place)
    except StackloftError as error:
        if asked != ALL_METHODS:
            raise
        return name, error
    return name, places


def _place(step: str, method: str, recipe: Loaded) -> Place:
    family, _, name = step.partition(".")
    loaded = find(family, name, prefer=recipe.listing.distribution)
    return Place(loaded, method, recipe.plugin.options.get(step, {}))


def _method(name: str, places: list[Place] | StackloftError, request: MeasureRequest) -> Method:
    if isinstance(places, StackloftError):
        return Method(name, error=places)
    recipe = find("recipe", name).plugin
    steps = tuple(_step(place, request) for place in places)
    return Method(name, steps, volume_bias=recipe.volume_bias, area_bias=recipe.area_bias)


def _step(place: Place, request: MeasureRequest) -> Step:
    options = options_at(place, request)
    return Step(place.loaded, options, instantiate(place.loaded, options))
