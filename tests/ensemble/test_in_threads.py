"""Calls side by side: truly at the same time, and alone within each other."""

import cProfile
import sys
import threading

import pytest
import scipy.stats
from oracles.inside import THREADS, use_threads

import analytic
from mcgw.machine.threads import in_threads


def test_two_calls_run_at_the_same_time():
    with use_threads(2):
        if THREADS.get() < 2:
            pytest.skip("one core")
        meeting = threading.Barrier(2, timeout=60)  # broken, were one call to wait for the other
        assert sorted(in_threads(lambda _: meeting.wait(), [0, 1])) == [0, 1]


def test_calls_within_a_call_run_alone():
    """Else two threads would become four; and the caller has its threads back, even after an error."""
    with use_threads(2):
        most = THREADS.get()
        assert in_threads(lambda _: THREADS.get(), range(1)) == [most]
        assert in_threads(lambda _: THREADS.get(), range(4)) == [1] * 4 if most > 1 else [most] * 4
        with pytest.raises(ZeroDivisionError):
            in_threads(lambda x: 1 // (3 - x), range(4))  # of any share
        with use_threads(1000):
            assert THREADS.get() == most


def test_a_profiler_is_left_at_work():
    """`cProfile` cannot be put back by Python: laws of scipy ended in a TypeError under it."""
    profiler = cProfile.Profile()
    profiler.enable()
    try:
        law = analytic.ScipyHeights(scipy.stats.gamma(4))
        assert sys.getprofile() is profiler
    finally:
        profiler.disable()
    assert law.support[1] == float("inf")
