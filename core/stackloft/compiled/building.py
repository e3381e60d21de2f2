"""Compile ``source/*.c`` into the one library of kernels, where there is a C compiler.

``python -m stackloft.compiled.building`` compiles beside this file and prints the library's path. hatchling's
hook (``hatch_build.py``) loads this file by its path before stackloft is installed: it needs the standard
library alone.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import uuid
from pathlib import Path

SOURCES = Path(__file__).parent / "source"
"""Folder of the C files; it is installed too, so that a library can be compared with it."""
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
LIBRARY = Path(__file__).with_name(f"_kernels{SUFFIX}")
COMPILERS = ("cc", "gcc", "clang")
"""Looked for in this order, unless ``$CC`` names one."""
# No fused multiply-add (-ffp-contract): figures would depend on the processor.
FLAGS = (
    *("-O3", "-std=c11", "-fPIC", "-shared", "-pthread", "-ffp-contract=off", "-fno-math-errno"),
    *("-fvisibility=hidden", "-Wall", "-Wextra"),
)
SWITCH = "STACKLOFT_COMPILED"
"""Environment variable; ``0``: kernels are neither compiled nor loaded."""


def wanted() -> bool:
    """Return whether the environment lets kernels be compiled and loaded."""
    return os.environ.get(SWITCH, "").strip() != "0"


def compiler() -> list[str] | None:
    """Return the C compiler's command, None when there is none; ``$CC`` rules out every other."""
    told = os.environ.get("CC", "").split()
    candidates = [told] if told else [[name] for name in COMPILERS]
    return next((command for command in candidates if shutil.which(command[0])), None)


def fingerprint() -> int:
    """Return the ABI number of a library made now: 31 bits of SHA-256 over flags and C files."""
    state = hashlib.sha256(" ".join(FLAGS).encode())
    for path in sorted([*SOURCES.glob("*.c"), *SOURCES.glob("*.h")]):
        content = path.read_bytes()
        state.update(f"\n{path.name} {len(content)}\n".encode() + content)
    return int.from_bytes(state.digest()[:4], "big") >> 1


def build(target: Path | None = None) -> Path | None:
    """Compile the kernels; return the library's path, None when it could not be made.

    What went wrong is told on stderr, as are the compiler's warnings.

    Parameters
    ----------
    target : Path, optional
        The library to write; None: the one that is loaded (``LIBRARY``).
    """
    target = LIBRARY if target is None else target
    command = compiler()
    if command is None:
        looked = f"CC={os.environ['CC']}" if os.environ.get("CC", "").strip() else ", ".join(COMPILERS)
        _tell_without(f"no C compiler was found ({looked})")
        return None
    # Under a name of its own, renamed when whole: neither another build nor a process that loads sees half.
    scratch = target.with_name(f"{target.stem}-{uuid.uuid4().hex}{SUFFIX}")
    sources = sorted(map(str, SOURCES.glob("*.c")))
    abi = f"-DSTACKLOFT_ABI={fingerprint()}"
    try:
        done = subprocess.run(
            [*command, *FLAGS, abi, "-o", str(scratch), *sources, "-lm"],
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
        sys.stderr.write(done.stderr)
        if done.returncode:
            _tell_without(f"{' '.join(command)} failed with status {done.returncode}")
            return None
        scratch.replace(target)
    except OSError as error:
        _tell_without(f"{' '.join(command)} made no library: {error}")
        return None
    finally:
        scratch.unlink(missing_ok=True)
    return target


def _tell_without(reason: str) -> None:
    sys.stderr.write(f"stackloft: {reason}; it works without compiled kernels, slower on scans\n")


def main() -> int:
    """Compile in place and print the library's path; status 1 when there is none."""
    if not wanted():
        _tell_without(f"{SWITCH} is 0")
        return 1
    built = build()
    if built is None:
        return 1
    sys.stdout.write(f"{built}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
