"""Calls that are given up when they take too long, and what may look on meanwhile."""

import cProfile
import sys
from math import sqrt

import pytest
import scipy.stats

import analytic
from analytic.in_time import in_time


def endless():
    while True:
        abs(complex(*divmod(7, 2)))
        (lambda: None)()


def test_a_call_without_end_is_given_up():
    with pytest.raises(ValueError, match="too long"):
        in_time(0.05, endless, "too long")
    assert sys.getprofile() is None


def test_a_result_is_handed_on():
    assert in_time(5.0, lambda: sqrt(4.0), "too long") == 2.0


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
