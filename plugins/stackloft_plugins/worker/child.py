"""The worker's side: ``python -m stackloft_plugins.worker.child module:function SECONDS MEGABYTES``.

Arrays and values come on stdin, the answer leaves on a copy of stdout that the function does not know of;
what it prints goes to stderr. The answer's value is ``null`` when all went well, otherwise the error's words.
"""

from __future__ import annotations

import importlib
import os
import sys

from stackloft_plugins.worker.limits import Limits, keep_to


def main() -> None:
    """Answer one call and leave without cleaning up: a library that crashes on its way out has answered."""
    keep_to(Limits(float(sys.argv[2]), float(sys.argv[3])))
    from stackloft_plugins.worker.message import pack, unpack  # noqa: PLC0415 - NumPy, within the limits

    answer = os.dup(1)
    os.dup2(2, 1)
    arrays, values = unpack(sys.stdin.buffer.read())
    module, _, name = sys.argv[1].partition(":")
    try:
        content = pack(getattr(importlib.import_module(module), name)(arrays, **values))
    except MemoryError:
        content = pack({}, {"kind": "memory", "words": "an allocation was refused"})
    except Exception as error:  # noqa: BLE001 - whatever a library raises is the answer
        content = pack({}, {"kind": "raised", "words": f"{type(error).__name__}: {error}"})
    with os.fdopen(answer, "wb") as stream:
        stream.write(content)
    sys.stderr.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
