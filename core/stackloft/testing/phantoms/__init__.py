"""Bodies whose volume and area are known to 1e-9, as exact contours, photographs or scans.

>>> from stackloft.testing import phantoms
>>> potato = phantoms.make("potato", seed=7, rotation=3, offset=(12.5, -4.0, 130.0))
>>> stack = potato.contour_stack(sections=11, placing="mid")
>>> len(stack), all(len(section.loops) == 1 for section in stack.sections)
(11, True)
"""

from stackloft.testing.phantoms.catalogue import NAMES, SOLID, make
from stackloft.testing.phantoms.contour_file import Contours
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft.testing.phantoms.scans import Scans
from stackloft.testing.phantoms.topology import TOPOLOGY, Topology
from stackloft.testing.phantoms.writing import write_contours, write_phantom, write_photos

__all__ = [
    "NAMES",
    "SOLID",
    "TOPOLOGY",
    "Contours",
    "Phantom",
    "Photographs",
    "Realism",
    "Scans",
    "Topology",
    "make",
    "write_contours",
    "write_phantom",
    "write_photos",
]
