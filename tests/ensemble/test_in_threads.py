"""Calls side by side: all of them, in order, and truly at the same time."""

import cProfile
import sys
import threading
from math import sqrt

import pytest
import scipy.stats
from numba import get_num_threads
from oracles.inside import use_threads

import analytic
import mcgw
from analytic.scipy_heights import in_time
from mcgw.machine.in_threads import in_threads, pieces


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("n", [0, 1, 2, 3, 64])
def test_all_results_in_order(threads, n):
    with use_threads(threads):
        assert in_threads(lambda x: x * x, range(n)) == [x * x for x in range(n)]


def test_two_calls_run_at_the_same_time():
    with use_threads(2):
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


def test_calls_within_a_call_run_alone():
    """Else two threads would become four; and the caller has its threads back, even after an error."""
    with use_threads(2):
        most = get_num_threads()
        assert in_threads(lambda _: get_num_threads(), range(1)) == [most]
        assert in_threads(lambda _: get_num_threads(), range(4)) == [1] * 4 if most > 1 else [most] * 4
        with pytest.raises(ZeroDivisionError):
            in_threads(lambda x: 1 // x, range(4))
        assert get_num_threads() == most


@pytest.mark.parametrize(("n", "least"), [(0, 64), (1, 64), (65, 64), (130, 64), (1000, 64), (7, 1)])
def test_pieces_cover_everything_once(n, least):
    with use_threads(2):
        cut = pieces(n, least)
        assert [i for first, last in cut for i in range(first, last)] == list(range(n))
        assert all(first % least == 0 for first, _ in cut)
        assert 1 <= len(cut) <= get_num_threads()


@pytest.mark.parametrize("threads", [1, 2])
def test_a_run_draws_with_so_many_threads(threads, make_scene, tmp_path, monkeypatch):
    from mcgw.sampling.counted import Counted

    seen, block = set(), Counted.block

    def noted(self, first, n):
        seen.add(threading.get_ident())
        return block(self, first, n)

    monkeypatch.setattr(Counted, "block", noted)
    mcgw.run(make_scene(n_surfaces=200), tmp_path / "e.h5", threads=threads)
    assert len(seen) == min(threads, get_num_threads())


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
