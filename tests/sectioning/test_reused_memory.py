"""Memory is used again when the last view of it has gone, and never before."""

import threading

import numpy as np
import pytest

from stackloft.model import reused_memory
from stackloft.model.reused_memory import LARGE, empty, memory_reused

SIDE = 1100  # LARGE bytes and more


def place(array):
    return array.__array_interface__["data"][0]


def test_a_view_keeps_its_memory():
    with memory_reused():
        first = empty((SIDE, SIDE), np.uint8)
        view, where = first[1:, ::2].view(), place(first)
        del first
        assert place(empty((SIDE, SIDE), np.uint8)) != where
        view[:] = 7
        second = empty((SIDE, SIDE), np.uint8)
        second[:] = 1
        assert (view == 7).all()


def test_what_goes_is_given_again_whatever_its_type():
    with memory_reused():
        first = empty((SIDE, SIDE), np.int16)
        where = place(first)
        del first
        again = empty((SIDE, SIDE // 2), np.float32)
        assert place(again) == where
        assert again.flags.writeable
        assert again.shape == (SIDE, SIDE // 2)


def test_arrays_outlive_the_end_and_nothing_stays_behind():
    with memory_reused():
        kept = empty((SIDE, SIDE), np.uint8)
        kept[:] = 3
        del_me = empty((SIDE, SIDE), np.uint8)
        del del_me
        assert reused_memory._free
    assert not reused_memory._free
    assert (kept == 3).all()
    del kept
    assert not reused_memory._free


@pytest.mark.parametrize("side", [SIDE, 10])
def test_elsewhere_and_small_ones_are_plain_arrays(side):
    assert empty((side, side), np.uint8).base is None
    assert side**2 > LARGE or side == 10


def test_threads_never_share_what_both_hold():
    wrong = []

    def work(number):
        rng = np.random.default_rng(number)
        for _ in range(60):
            array = empty((SIDE, int(rng.integers(SIDE, 2 * SIDE))), np.uint8)
            array[:] = number
            if not (array == number).all():
                wrong.append(number)

    with memory_reused():
        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not wrong
