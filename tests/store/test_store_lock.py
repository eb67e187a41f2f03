"""One driver alone or several that share: freed however a holder ends; `test_one_writer` has threads."""

import os
import sqlite3
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest
from filelock import Timeout
from oracles.inside import LOCK_FILES, home, locked, parts_of

import mcgw
from mcgw.errors import StoreError

ROOT = Path(mcgw.__file__).parents[1]

# A process that holds the lock until it is killed; its own child, made by a fork, lives on.
HOLD = """
import os, sys, time
from pathlib import Path
from oracles.inside import locked
with locked(Path(sys.argv[1]), shared=sys.argv[2] == "shared"):
    child = os.fork()
    if not child:
        time.sleep(600)
    print(child, flush=True)
    time.sleep(600)
"""


@pytest.fixture(autouse=True)
def _at_once(monkeypatch):
    monkeypatch.setattr(home("PATIENCE"), "PATIENCE", 0.1)


def free(folder, *, shared=False):
    try:
        with locked(folder, shared=shared):
            return True
    except StoreError:
        return False


def test_alone_or_shared_until_the_last_one_leaves(tmp_path):
    with locked(tmp_path):
        assert not free(tmp_path)
        assert not free(tmp_path, shared=True)
        with pytest.raises(StoreError, match=f"locked by pid {os.getpid()} on .*, which is working on"):
            locked(tmp_path).__enter__()
    tmp_path.mkdir()
    (tmp_path / "holder").write_text("pid 1 on another\n")  # as one that was killed leaves it
    with ExitStack() as first, locked(tmp_path, shared=True):
        first.enter_context(locked(tmp_path, shared=True))
        with pytest.raises(StoreError, match="locked by another process"):  # whoever held it before
            locked(tmp_path).__enter__()
        first.close()
        assert not free(tmp_path)
    assert free(tmp_path)
    assert not tmp_path.exists()


@pytest.mark.parametrize("how", ["shared", "alone"])
def test_kill_9_frees_it_though_a_child_of_the_holder_lives(tmp_path, how):
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests")])}
    holder = subprocess.Popen([sys.executable, "-c", HOLD, tmp_path, how], env=env, stdout=subprocess.PIPE)
    child = int(holder.stdout.readline())
    try:
        assert free(tmp_path, shared=True) == (how == "shared")
        if how == "alone":
            with pytest.raises(StoreError, match=f"locked by pid {holder.pid} on"):
                locked(tmp_path).__enter__()
        assert not free(tmp_path)
        holder.kill()
        holder.wait()
        assert free(tmp_path)
    finally:
        holder.kill()
        os.kill(child, 9)
        holder.communicate()


def test_nothing_planted_is_followed(tmp_path):
    victim, folder = tmp_path / "victim", tmp_path / "run"
    folder.mkdir()
    victim.write_text("mine")
    (folder / "holder").symlink_to(victim)
    with locked(folder):
        assert not (folder / "holder").is_symlink()
        assert {path.name for path in folder.iterdir()} == set(LOCK_FILES)
    assert not folder.exists()
    folder.mkdir()
    (folder / "lock.db").symlink_to(victim)
    with pytest.raises(StoreError, match="cannot be locked"):
        locked(folder).__enter__()
    assert victim.read_text() == "mine"


def test_planted_links_of_files_are_not_followed(make_scene, tmp_path):
    scene, elsewhere = make_scene(n_surfaces=4), tmp_path / "elsewhere"
    elsewhere.mkdir()
    parts_of(tmp_path / "e.h5").symlink_to(elsewhere)
    with pytest.raises(StoreError, match="is not a folder"):
        mcgw.run(scene, tmp_path / "e.h5")
    assert not list(elsewhere.iterdir())
    (tmp_path / "f.h5").symlink_to(elsewhere / "victim")
    with pytest.raises(StoreError, match="is not a regular file"):
        mcgw.run(scene, tmp_path / "f.h5")


def test_a_run_in_a_folder_open_to_all_leaves_nothing(tmp_path, make_scene, blocks_of):
    """The lock would make names of its own in a folder that others can write."""
    blocks_of(4)
    tmp_path.chmod(0o777)
    before = os.umask(0)
    try:
        mcgw.run(make_scene(separations=(2.0,), sampler="tail", n_surfaces=12), tmp_path / "e.h5")
    finally:
        os.umask(before)
    assert [path.name for path in tmp_path.iterdir()] == ["e.h5"]


@pytest.mark.parametrize(
    "error", [sqlite3.OperationalError("disk I/O error"), ValueError("not writable"), Timeout("x")]
)
def test_a_disk_that_keeps_no_locks_is_refused_in_one_line(error, make_scene, tmp_path, monkeypatch):
    def none(*_, **__):
        raise error

    monkeypatch.setattr(home("PATIENCE"), "ReadWriteLock", none)
    with pytest.raises(StoreError, match=r"^[^\n]*disk that keeps[^\n]*$"):
        mcgw.run(make_scene(n_surfaces=4), tmp_path / "e.h5")
    assert not (tmp_path / "e.h5").exists()
