"""Calls side by side: all of them, in order, and truly at the same time."""

import threading

import pytest

from mcgw.sampling.in_threads import in_threads
from mcgw.simulation import use_threads


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("n", [0, 1, 2, 3, 64])
def test_all_results_in_order(threads, n):
    with use_threads(threads):
        assert in_threads(lambda x: x * x, range(n)) == [x * x for x in range(n)]


def test_two_calls_run_at_the_same_time():
    with use_threads(2):
        from numba import get_num_threads

        if get_num_threads() < 2:
            pytest.skip("one core")
        meeting = threading.Barrier(2, timeout=60)  # broken, were one call to wait for the other
        assert sorted(in_threads(lambda _: meeting.wait(), [0, 1])) == [0, 1]


def test_an_error_of_any_share_comes_out():
    def fail(x):
        if x == 3:
            raise ValueError("three")

    with use_threads(2), pytest.raises(ValueError, match="three"):
        in_threads(fail, range(4))
