"""Compiled loops kept on the disk are those that are asked for, whoever compiles at the same time."""

import gc
import importlib
import importlib.util
import io
import os
import pty
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from numba.core.errors import TypingError

import mcgw
from mcgw.commands.voice import NEWS, QUIET, speaking
from mcgw.machine import compiling
from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import load, total
from mcgw.store.ensembles import read_attributes

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


def test_loops_compiled_at_the_same_time_are_not_mixed_up(loops):
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
    found = [loops.make(njit, n)(3.0) for n in (1.0, 2.0)]  # as a third process loads them
    assert found == [3.0, 6.0]  # with the files of Numba they are not


def test_lanes_of_what_is_not_contiguous_are_refused():
    """Four numbers at once are neighbours in memory: of a transposed array they would be others."""

    @njit()
    def first(x):
        return total(load(x, 0))

    x = np.arange(16.0).reshape(4, 4)
    assert first(x) == 0 + 1 + 2 + 3
    with pytest.raises(TypeError, match="lanes are neighbours"):
        first(x.T)


def test_what_loops_call_is_no_machine_code_of_its_own():
    """It has none that Python could call, and gives the same; Python's form is compiled when Python asks."""

    @njit()
    def third(x):
        return x / 3

    @njit()
    def ninth(x):
        return third(third(x))

    assert ninth(0.7) == 0.7 / 3 / 3
    assert not third.overloads
    assert third(0.7) == 0.7 / 3
    assert list(third.overloads) == list(ninth.overloads)


@pytest.mark.parametrize("searching", [True, False])
def test_garbage_is_looked_for_as_before(searching):
    """Not while a loop is compiled, and again after one that cannot be."""

    @njit()
    def wrong(x):
        return x.nothing

    (gc.enable if searching else gc.disable)()
    try:
        with pytest.raises(TypingError):
            wrong(1.0)
        assert gc.isenabled() == searching
    finally:
        gc.enable()


def test_a_loop_whose_callee_has_changed_is_compiled_anew(tmp_path, monkeypatch):
    """Numba alone goes on with the old one: the file of the caller is as it was."""
    layer = tmp_path / "house" / "layer"
    layer.mkdir(parents=True)
    for folder in (layer, layer.parent):
        (folder / "__init__.py").touch()
    head = "from mcgw.machine.compiling import njit\n"
    (layer / "caller.py").write_text(
        f"{head}from house.layer.callee import times\n@njit(cache=True)\ndef call(x):\n    return times(x)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    found, own = [], tmp_path / "compiling.py"
    monkeypatch.setattr(compiling, "__file__", str(own))
    for factor, how in (("3.0", "one"), ("6.0", "one"), ("6.0", "one"), ("6.0", "other")):
        own.write_text(how)
        (layer / "callee.py").write_text(f"{head}@njit(cache=True)\ndef times(x):\n    return {factor} * x\n")
        for name in [name for name in sys.modules if name.partition(".")[0] == "house"]:
            monkeypatch.delitem(sys.modules, name)
        importlib.invalidate_caches()
        compiling._stamp_of_package.cache_clear()  # as in another process
        call = importlib.import_module("house.layer.caller").call
        found.append((call(1.0), call.stats.cache_hits.total()))
    assert found == [(3.0, 0), (6.0, 0), (6.0, 1), (6.0, 0)]  # the last: by other steps of the compiler


def test_a_line_says_so_on_a_terminal_alone(loops, monkeypatch):
    """And is gone when the loop is there; -q is silent."""
    for terminal, quiet in ((True, False), (True, True), (False, False)):
        stream = io.StringIO()
        stream.isatty = lambda terminal=terminal: terminal
        monkeypatch.setattr(sys, "stderr", stream)
        with speaking(QUIET if quiet else NEWS):
            assert loops.make(njit, 2.0 + terminal + 2 * quiet)(1.0) > 0
        text = stream.getvalue()
        line = re.fullmatch(r"\r *\r(compiling the loops, once for this machine: \d+( of 12)?)\r( +)\r", text)
        assert bool(text) == bool(line) == (terminal and not quiet)
        assert not line or len(line[3]) == len(line[1])


SCENE = Path(mcgw.__file__).parents[1] / "runs" / "quick.toml"


@pytest.mark.slow
def test_whatever_is_kept_gives_the_same_digest(tmp_path):
    """Nothing yet, on a terminal that counts the loops; all of it; a folder that nobody can write to."""
    digests, terminal = set(), pty.openpty()
    (tmp_path / "file").touch()
    for number, (cache, errors) in enumerate((("loops", terminal[1]), ("loops", None), ("file", None))):
        file = tmp_path / f"{number}.h5"
        env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / cache)}
        call = [sys.executable, "-m", "mcgw", "run", str(SCENE), "-o", str(file)]
        done = subprocess.run(
            call, env=env, stdout=subprocess.PIPE, stderr=errors or subprocess.PIPE, check=True
        )
        assert b"compiling the loops" not in (done.stderr or b"")
        digests.add(read_attributes(file)["digest"])
    said = os.read(terminal[0], 10**5).decode()
    assert "machine: 1 of 12\r" in said
    assert "machine: 12 of 12\r" in said
    assert "machine: 13" not in said
    assert len(digests) == 1


@pytest.mark.parametrize("folder", ["", "elsewhere"])
def test_a_full_disk_is_told_once_with_what_to_do(folder, monkeypatch):
    monkeypatch.setattr(compiling, "_SAID", set())
    monkeypatch.setenv("NUMBA_CACHE_DIR", folder)  # an empty one is none
    with pytest.warns(UserWarning, match=r"^compiled loops cannot be cached in here \(full\), so .*") as told:
        compiling._say("here", "full")
    advice = "; free some space" + ", or set NUMBA_CACHE_DIR to another folder" * (not folder)
    assert str(told[0].message).endswith(f"them{advice}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compiling._say("there", "full")
    with pytest.warns(UserWarning, match="in there .away"):
        compiling._say("there", "away")


@pytest.mark.parametrize("empty", [True, False])
def test_loops_are_counted_and_their_number_is_known_where_none_was_kept(empty, tmp_path, monkeypatch):
    """Twelve take a scene under Hertz's law; what else is compiled is beyond them."""
    said = []
    monkeypatch.setattr(compiling, "_WAS_EMPTY", [])
    monkeypatch.setattr(compiling, "pass_by", said.append)
    if not empty:
        (tmp_path / "a.nbi").touch()
    for _ in range(14):
        compiling._count(tmp_path)
        (tmp_path / "b.nbi").touch()
    of = [" of 12" if empty and k <= 12 else "" for k in range(1, 15)]
    assert said == [f"compiling the loops, once for this machine: {k}{of[k - 1]}" for k in range(1, 15)]
