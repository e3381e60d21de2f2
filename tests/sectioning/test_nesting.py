"""Loops that touch are told from loops that cross."""

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.sectioning.nesting import enclosing_loops


def circle(radius, x=0.0):
    t = 2 * np.pi * np.arange(160) / 160
    return np.column_stack([x + radius * np.cos(t), radius * np.sin(t)])


@pytest.mark.parametrize("overstep", [-1e-3, 0.0, 1e-3, 9e-3])
def test_loops_that_overstep_by_less_than_they_are_known_to_touch(overstep):
    assert enclosing_loops([circle(10.0), circle(5.0, 15.0 - overstep)]) == [[], []]
    assert enclosing_loops([circle(10.0), circle(5.0, 5.0 + overstep)]) == [[], [0]]


@pytest.mark.parametrize("overstep", [0.05, 1.0, 5.0])
def test_loops_that_overstep_by_more_cross(overstep):
    for x in (15.0 - overstep, 5.0 + overstep):
        with pytest.raises(InputError, match="s7: loops cross each other"):
            enclosing_loops([circle(10.0), circle(5.0, x)], "s7")
