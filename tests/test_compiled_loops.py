"""Compiled loops kept on the disk are those that are asked for, whoever compiles at the same time."""

import importlib.util
import sys

import numba
import pytest

from mcgw.machine.compiling import njit

LOOPS = """
def make(njit, n):
    @njit(cache=True)
    def times(x):
        return n * x
    return times
"""


@pytest.fixture
def loops(tmp_path, monkeypatch):
    """A module whose loops are of one name: versions of one function, as those of the moments are."""
    path = tmp_path / "loops.py"
    path.write_text(LOOPS)
    spec = importlib.util.spec_from_file_location("loops", path)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "loops", module)
    spec.loader.exec_module(module)
    return module


def compiled_at_once(loops, njit):
    """Two processes compile two versions; the second is quick, between two steps of the first."""
    one, two = loops.make(njit, 1.0), loops.make(njit, 2.0)
    first, second = one._cache._cache_file, two._cache._cache_file
    seen, save_data = second._load_index(), first._save_data  # the second looks before the first has written

    def interrupted(name, data):
        second._load_index = lambda: dict(seen)
        assert two(3.0) == 6.0
        save_data(name, data)

    first._save_data = interrupted
    assert one(3.0) == 3.0
    return [loops.make(njit, n)(3.0) for n in (1.0, 2.0)]  # as a third process loads them


def test_loops_compiled_at_the_same_time_are_not_mixed_up(loops):
    assert compiled_at_once(loops, njit) == [3.0, 6.0]


def test_with_the_files_of_numba_they_are(loops):
    """Otherwise the test above says nothing."""
    assert compiled_at_once(loops, numba.njit) != [3.0, 6.0]
