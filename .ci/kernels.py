"""Say whether the installed wheel has its compiled kernels; leave with 1 when a compiler is here and they are not used.

Usage: kernels.py
"""

import sys
from importlib.metadata import files

from stackloft.compiled.building import LIBRARY, compiler, wanted
from stackloft.compiled.library import kernels, why_not

in_wheel = any(file.name == LIBRARY.name for file in files("stackloft") or ())
print(f"{LIBRARY.name} is {'' if in_wheel else 'not '}in the wheel")
used = kernels() is not None
print(f"kernels: {'used' if used else why_not()}")
sys.exit(wanted() and compiler() is not None and not (used and in_wheel))
