"""Compiled loops kept on the disk are those that are asked for, whoever compiles at the same time."""

import importlib.util
import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest
from filelock import FileLock, Timeout
from oracles.inside import read_attributes

import mcgw
from mcgw.machine import compiling
from mcgw.machine.compiling import loops_folder, njit

LOOP = """
from mcgw.machine.compiling import loops_folder, njit

@njit(cache=True)
def twice(x):
    return 2 * x
"""


@pytest.fixture
def loop(tmp_path, monkeypatch):
    """A loop of a module of its own, compiled by nobody yet."""
    path = tmp_path / "loops.py"
    path.write_text(LOOP)
    spec = importlib.util.spec_from_file_location("loops", path)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "loops", module)
    spec.loader.exec_module(module)
    return module.twice


def test_one_process_compiles_at_a_time(loop, monkeypatch):
    """From the look at what is kept until it is kept; else two give two versions of a loop one number."""
    lock, held = FileLock(Path(loops_folder()) / "mcgw-loops.lock"), []

    def another_waits(step):
        def look(*args):
            try:
                with lock.acquire(timeout=0):
                    held.append(False)
            except Timeout:
                held.append(True)
            return step(*args)

        return look

    kept = loop._cache
    monkeypatch.setattr(kept, "load_overload", another_waits(kept.load_overload))
    monkeypatch.setattr(kept, "save_overload", another_waits(kept.save_overload))
    assert (loop(2), loop(0.5)) == (4, 1.0)
    assert held == [True] * 4
    with lock.acquire(timeout=0):  # nobody holds it now
        pass
    assert len(loop.overloads) == 2


def test_where_nothing_can_be_kept_it_is_said_once(monkeypatch):
    def nowhere(**options):
        if options.get("cache"):
            raise RuntimeError("no locator available")
        return lambda function: function

    monkeypatch.setattr(compiling.numba, "njit", nowhere)
    loops_folder.cache_clear()
    try:
        with pytest.warns(
            UserWarning, match=r"^compiled loops cannot be kept \(no locator .*NUMBA_CACHE_DIR"
        ) as said:
            assert [njit(cache=True)(abs)(-1), njit(cache=True)(abs)(-2)] == [1, 2]
        assert len(said) == 1
    finally:
        loops_folder.cache_clear()


SCENE = Path(mcgw.__file__).parents[1] / "runs" / "quick.toml"


@pytest.mark.slow
def test_whatever_is_kept_gives_the_same_digest(tmp_path):
    """Nothing yet, on a terminal; all of it; a folder that nobody can write to."""
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
    assert "compiling the loops, once for this machine" in said
    assert len(digests) == 1
