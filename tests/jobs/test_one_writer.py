"""One process writes a file at a time, whatever it is about to write; and none outlives its parent."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from oracles.inside import LockedError, Plan, home, locked, parts_of, state_of, tidy, verify
from oracles.said import call

import mcgw
from mcgw.errors import RunError, StoreError

ROOT = Path(__file__).parents[2]
ENV = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests")])}
SIZE = 16


@pytest.fixture(autouse=True)
def _small_blocks_and_no_patience(blocks_of, monkeypatch):
    blocks_of(SIZE)
    monkeypatch.setattr(home("PATIENCE"), "PATIENCE", 0.0)


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(1.0, 2.0), sampler="tail", n_surfaces=SIZE)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "e.h5"


def others(scene):
    """All that can be written to the same file meanwhile."""
    blocks = scene.replace(n_surfaces=3 * SIZE)
    return {
        "the same run": lambda path: mcgw.run(scene, path),
        "in blocks": lambda path: mcgw.run(blocks, path),
        "a share": lambda path: mcgw.run(blocks, path, shard="1/2"),
        "merge": mcgw.merge,
        "save": lambda path: mcgw.save(mcgw.simulate(scene.replace(seed=3)), path),
    }


def test_nothing_else_is_written_beside_a_run_of_one_block(scene, path, monkeypatch):
    """Who waits looks again, with the lock: both looked before either wrote, and nothing is drawn twice."""
    draw, begun, go_on, blocks = Plan.draw, threading.Event(), threading.Event(), []

    def slowly(*arguments):
        blocks.append(arguments)
        begun.set()
        assert go_on.wait(30)
        return draw(*arguments)

    monkeypatch.setattr(Plan, "draw", slowly)
    with ThreadPoolExecutor(3) as pool:
        first = pool.submit(mcgw.run, scene, path)
        assert begun.wait(30)
        for other in others(scene).values():
            with pytest.raises(LockedError, match=f"locked by pid {os.getpid()} on"):
                other(path)
        tidy(path)  # what `show` does; it takes nothing away
        monkeypatch.setattr(home("PATIENCE"), "PATIENCE", 30.0)
        same, another = (pool.submit(mcgw.run, scene.replace(seed=seed), path) for seed in (1, 2))
        time.sleep(0.2)
        go_on.set()
        assert first.result(30).n_surfaces == same.result(30).n_surfaces == SIZE
        with pytest.raises(StoreError, match="seed is 1 there and 2 here"):
            another.result(30)
    assert len(blocks) == 1
    assert verify(path)[0] == ""
    assert [p.name for p in path.parent.iterdir()] == ["e.h5"]


def test_a_finished_file_needs_no_lock(scene, path):
    """Whoever holds it: nothing is to be done, and there is nobody to wait for."""
    swept, over = path.with_name("s.h5"), {"grading.gamma": [0.5, 1.0]}
    mcgw.run(scene, path)
    mcgw.sweep(scene, over, path=swept)
    with locked(parts_of(path)), locked(parts_of(swept)):
        assert mcgw.run(scene, path).n_surfaces == SIZE
        assert mcgw.run(scene, path, shard="1/2") == 0
        assert mcgw.sweep(scene, over, path=swept).shape == (2,)
        assert mcgw.sweep(scene, over, path=swept, shard="2/2") == 0


def test_jobs_share_and_others_wait(scene, path):
    blocks = scene.replace(n_surfaces=3 * SIZE)
    with locked(parts_of(path), shared=True):
        mcgw.run(blocks, path, shard="1/2")
        for name in ("in blocks", "merge", "save", "the same run"):
            with pytest.raises(LockedError):
                others(scene)[name](path)
        tidy(path)
    assert mcgw.run(blocks, path, shard="2/2") == 0
    assert mcgw.merge(path).n_surfaces == 3 * SIZE


def test_an_unfinished_run_is_not_replaced(scene, path):
    blocks = scene.replace(n_surfaces=3 * SIZE)
    mcgw.run(blocks, path, shard="1/2")
    with pytest.raises(StoreError, match="a run that makes this file is not finished"):
        mcgw.save(mcgw.simulate(scene), path)
    with pytest.raises(StoreError, match="holds surfaces up to number 48 already, more than"):
        mcgw.run(scene, path)
    with pytest.raises(StoreError, match=r"holds a different run: .*seed is 1 there and 2"):
        mcgw.run(blocks.replace(seed=2), path)
    assert mcgw.run(scene.replace(n_surfaces=4 * SIZE), path).n_surfaces == 4 * SIZE


def test_drawn_surfaces_are_kept_when_fewer_are_asked_for(scene, path):
    """An extension that stopped half-way is not thrown away by the run that it extends."""
    mcgw.run(scene, path)
    mcgw.run(scene.replace(n_surfaces=4 * SIZE), path, shard="2/2")
    kept = sorted(p.name for p in parts_of(path).glob("shards/*.h5"))
    assert len(kept) == 2
    for _ in range(2):
        assert mcgw.run(scene, path).n_surfaces == SIZE
    assert sorted(p.name for p in parts_of(path).glob("shards/*.h5")) == kept


@pytest.mark.parametrize("there", [True, False], ids=["extended", "new"])
def test_a_file_that_changes_while_it_is_made_is_left_alone(there, scene, path, monkeypatch):
    if there:
        mcgw.run(scene, path)
    write = home("put").write

    def replaced(*words):
        write(*words)
        path.unlink(missing_ok=True)
        path.write_bytes(b"precious")

    monkeypatch.setattr(home("put"), "write", replaced)
    told = "another file now has this name" if there else "File exists"
    with pytest.raises(RunError, match=rf"e\.h5: {told}; it was not changed, .* choose another"):
        mcgw.run(scene.replace(n_surfaces=3 * SIZE), path)
    assert path.read_bytes() == b"precious"
    assert len(list(parts_of(path).glob("shards/*.h5"))) == 3 - there
    assert not list(parts_of(path).glob(".*"))


def leave_behind(path, scene, *, shards):
    """What processes killed at the worst moments leave."""
    folder = parts_of(path)
    (folder / "shards").mkdir(parents=True)
    (folder / "holder").write_text("pid 1 on here\n")
    (folder / ".e.h5.0-1-2.tmp").write_bytes(b"half a file")
    (folder / "shards" / ".block.tmp").write_bytes(b"half a block")
    (folder / "shards" / "block-0000000000016.h5").write_bytes(b"of a worker whose driver is gone")
    if shards:
        (folder / "shards" / "block-0000000000016.h5").unlink()
        Plan(scene, path).begin()
        (folder / "shards" / "block-0000000000000.h5").write_bytes(b"whole")


@pytest.mark.parametrize(
    ("command", "shards"), [("run", True), ("merge", False), ("merge", True), ("show", True)]
)
def test_leftovers_of_a_finished_file_are_cleared(command, shards, scene, path):
    mcgw.run(scene, path)
    leave_behind(path, scene, shards=shards)
    path.with_suffix(".toml").write_text(mcgw.scene_text(scene))
    before = state_of(path)
    done = call(*(("run", path.with_suffix(".toml"), "-o", path) if command == "run" else (command, path)))
    assert done.returncode == 0, done.stderr
    assert state_of(path) == before
    assert sorted(p.name for p in path.parent.iterdir()) == ["e.h5", "e.toml"]
    assert ("was finished before, 16 surfaces" in done.stdout) == (command == "merge")


def test_an_empty_run_of_another_scene_gives_way(scene, path):
    folder, other = parts_of(path), scene.replace(seed=2, n_surfaces=3 * SIZE)
    with locked(folder):
        Plan(scene, path).begin()
    mcgw.run(other, path, shard="1/2")
    assert Plan.open(folder).scene.seed == 2
    leave_behind(path.with_name("f.h5"), scene, shards=False)
    mcgw.run(other, path.with_name("f.h5"))
    assert not parts_of(path.with_name("f.h5")).exists()


def gone(pid, seconds=30):
    """Whether a process ends within some seconds."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] in "ZX":
                return True
        except OSError:
            return True
        time.sleep(0.01)
    os.kill(pid, signal.SIGKILL)
    return False


POOL = """
import sys, time
from oracles.inside import Jobs
if __name__ == "__main__":
    jobs = Jobs(2)
    answers = [jobs.submit(time.sleep, 100) for _ in range(2)]
    while len(jobs._pool._processes) < 2:
        time.sleep(0.01)
    print(*jobs._pool._processes, flush=True)
    time.sleep(100)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc")
def test_workers_end_with_the_driver(tmp_path):
    (tmp_path / "pool.py").write_text(POOL)
    words = [sys.executable, tmp_path / "pool.py"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=ENV) as driver:
        workers = [int(word) for word in driver.stdout.readline().split()]
        driver.kill()
        assert len(workers) == 2
        assert [pid for pid in workers if not gone(pid)] == []


@pytest.mark.slow
def test_random_kills_of_everything():
    """A short one of `runs/reliability/kills.py`."""
    words = [sys.executable, str(ROOT / "runs" / "reliability" / "kills.py"), "6", "7"]
    done = subprocess.run(words, env=ENV, capture_output=True, text=True, timeout=500, check=True)
    found = json.loads(done.stdout)
    assert found["kills"] >= 6
    bad = {key: found[key] for key in ("lost", "wrong", "left", "stuck")}
    assert bad == {"lost": 0, "wrong": 0, "left": 0, "stuck": 0}, done.stderr
