"""The Python interface: ``stackloft.read`` and ``stackloft.measure``."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stackloft.model.measurement import Result
from stackloft.pipeline.every_object import measure_objects as run
from stackloft.pipeline.layers import Place, check_addresses, options_at
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.workbench import guarded
from stackloft.registry import choose_reader, instantiate


def read(path: str | os.PathLike[str], *, reader: str | None = None, **options: Any) -> Any:
    """Read a file or folder.

    Parameters
    ----------
    path : path
        File or folder.
    reader : str, optional
        A reader's name; None: the one that knows what is there.
    **options
        The reader's options, for example ``pixel_size="0.3mm"``.

    Returns
    -------
    SliceStack, Segmentation, ContourStack or TriMesh
        What the reader makes of it; slices are decoded when they are asked for.

    Raises
    ------
    StackloftError
        Nothing readable there, or an option that the reader does not have.

    Examples
    --------
    >>> read("no-such-folder", pixel_size="0.3mm")
    Traceback (most recent call last):
    stackloft.model.errors.InputError: no-such-folder: no such file or folder
    """
    source = Path(path)
    loaded = choose_reader(source, reader)
    request = MeasureRequest(source, reader, shared=options)
    place = Place(loaded)
    check_addresses([place], request)
    instance = instantiate(loaded, options_at(place, request))
    return guarded(loaded, instance.read, source)


def measure(
    source: Any,
    method: str | None = None,
    *,
    reader: str | None = None,
    segmenter: str | None = None,
    settings: Mapping[str, Mapping[str, Any]] | None = None,
    **options: Any,
) -> Result:
    """Measure a file, a folder or a product of `read`.

    Parameters
    ----------
    source : path or product
        What is measured.
    method : str, optional
        A recipe's name, several with commas, or ``all``; None: ``loft``, of a surface ``polyhedral``.
    reader, segmenter : str, optional
        Named when the choice should not be found from the source.
    settings : mapping, optional
        Options by ``family``, ``name`` or ``family.name``.
    **options
        General options for every plug-in of the chain that has them, for example ``points=33``,
        ``height="78mm"``, ``ends="face,round"``, ``pixel_size="0.3mm"``, ``object="all"``.

    Returns
    -------
    Result
        ``result.objects[0].volume.value`` in mm³.

    Raises
    ------
    StackloftError
        The source cannot be measured; the message says what, where and the fix.

    Examples
    --------
    >>> measure("no-such-folder", pixel_size="0.3mm")
    Traceback (most recent call last):
    stackloft.model.errors.InputError: no-such-folder: no such file or folder
    """
    is_path = isinstance(source, (str, os.PathLike))
    product = None if is_path else source
    name = Path(source) if is_path else Path(type(source).__name__)
    request = MeasureRequest(name, reader, segmenter, method, settings or {}, options)
    return run(request, product=product).result
