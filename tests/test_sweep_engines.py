"""Sweeps by processes, dask, shares of several jobs: the digest of threads, whoever dies meanwhile."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.jobs.engines import Processes
from mcgw.sweeps import drawing
from mcgw.sweeps.chunk_task import commit_chunk
from mcgw.sweeps.file import read_attributes
from mcgw.sweeps.folder import ASKED, SweepFolder, folder_of

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0, 2.5], n_surfaces=300, n_asperities=2000, seed=7)
OVER = {"grading.gamma": np.linspace(0.5, 1.7, 9), "ensemble.n_asperities": [200, 2000]}
CHUNKS = 12


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch):
    """Six for each group; workers are told which chunk, so that theirs are the same."""
    monkeypatch.setattr(drawing, "_ROWS", 50)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))


def digest(path):
    return read_attributes(path)["digest"]


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """From memory, whose statistics a file keeps."""
    found = []

    def of():
        if not found:
            path = tmp_path_factory.mktemp("threads") / "a.h5"
            mcgw.sweep(SCENE, OVER, path=path)
            found.append(digest(path))
        return found[0]

    return of


def test_by_processes_of_which_some_are_killed(tmp_path, expected):
    random, killed = np.random.default_rng(5), []
    engine = Processes(2)

    def kill(done, total):
        if done and len(killed) < 2 and random.random() < 0.5:  # fewer than make a block a suspect for good
            alive = [pid for pid in engine._pool._processes or () if pid not in killed]
            killed.extend(alive[:1])
            for pid in alive[:1]:
                os.kill(pid, signal.SIGKILL)

    try:
        mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", engine=engine, progress=kill)
    finally:
        engine.close()
    assert killed
    assert digest(tmp_path / "a.h5") == expected()
    assert not list(tmp_path.glob("*.parts"))


def test_by_the_client_of_a_dask_cluster(tmp_path, expected):
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 2, "processes": False, "dashboard_address": None}
    with (
        distributed.LocalCluster(**options) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", engine=client)
        assert client.status == "running"
    assert digest(tmp_path / "a.h5") == expected()


@pytest.mark.slow
def test_by_dask_workers_of_which_some_are_killed(tmp_path, expected):
    pytest.importorskip("distributed")
    from mcgw.jobs.dask_engine import Dask

    engine, killed = Dask(workers=4, quiet=True), []

    def kill(done, total):
        if done and len(killed) < 2:
            pids = [nanny.process.pid for nanny in engine._cluster.workers.values()]
            killed.append(next(pid for pid in pids if pid and pid not in killed))
            os.kill(killed[-1], signal.SIGKILL)

    try:
        mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", engine=engine, progress=kill)
    finally:
        engine.close()
    assert len(killed) == 2
    assert digest(tmp_path / "a.h5") == expected()


@pytest.mark.parametrize("order", [(1, 2, 3), (3, 1, 2)])
def test_in_shares_in_any_order(tmp_path, expected, order):
    path, left = tmp_path / "a.h5", []
    with pytest.raises(mcgw.StoreError, match="neither this file nor blocks of it"):
        mcgw.merge(path)
    for i in order:
        left.append(mcgw.sweep(SCENE, OVER, path=path, shard=f"{i}/3"))
        assert not path.exists()
        if left[-1]:
            with pytest.raises(
                mcgw.RunError, match=rf"{left[-1]} of 600 surfaces are missing, from surfaces \d+ \.\.\. "
            ):
                mcgw.merge(path)
    assert left == [400, 200, 0]
    assert mcgw.sweep(SCENE, OVER, path=path, shard="2/3") == 0  # a job that is started again
    merged = mcgw.merge(path)
    assert digest(path) == expected()
    assert merged.shape == (9, 2)
    assert not list(tmp_path.glob("*.parts"))
    assert mcgw.sweep(SCENE, OVER, path=path, shard="1/3") == 0
    assert repr(mcgw.merge(path)) == repr(merged)
    with pytest.raises(mcgw.StoreError, match="holds a different sweep"):
        mcgw.sweep(SCENE, {"grading.gamma": [1.0]}, path=path, shard="1/3")


def test_a_damaged_share_is_drawn_again(tmp_path, expected):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path, shard="1/1")
    shard = sorted(folder_of(path).glob("block-*.h5"))[4]
    data = bytearray(shard.read_bytes())
    data[len(data) // 2] ^= 1
    shard.write_bytes(bytes(data))
    with pytest.raises(
        mcgw.RunError, match=r"50 of 600 surfaces are missing, from surfaces 200 \.\.\. 249 of"
    ):
        mcgw.merge(path)
    assert mcgw.sweep(SCENE, OVER, path=path, shard="1/1") == 0
    mcgw.merge(path)
    assert digest(path) == expected()


def test_the_same_call_without_a_share_ends_what_shares_began(tmp_path, expected):
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", shard="2/2")
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", engine="processes", threads=1)
    assert digest(tmp_path / "a.h5") == expected()


SWEEPING = """
import sys, numpy as np
import mcgw
from mcgw.sweeps import drawing
drawing._ROWS = 50
if __name__ == "__main__":
    scene = mcgw.scene_from(open(sys.argv[1]).read())
    over = {"grading.gamma": np.linspace(0.5, 1.7, 9), "ensemble.n_asperities": [200, 2000]}
    how = {"shard": sys.argv[2]} if "/" in sys.argv[2] else {"engine": sys.argv[2], "threads": 2}
    print("begun", flush=True)
    mcgw.sweep(scene, over, path="a.h5", **how)
"""


@pytest.mark.parametrize(("how", "seconds"), [(["processes"], (1.0, 5.0)), (["1/2", "2/2"], (0.2, 1.5))])
def test_a_driver_that_is_killed_at_random_moments(tmp_path, expected, how, seconds):
    """Three times each, with its workers; then it is let go on to its end."""
    (tmp_path / "s.toml").write_text(mcgw.scene_text(SCENE))
    (tmp_path / "sweeping.py").write_text(SWEEPING)
    random, kills = np.random.default_rng(2), 0
    for word in how:
        for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGKILL, 0):
            call = [sys.executable, "sweeping.py", "s.toml", word]
            quiet = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
            with subprocess.Popen(call, cwd=tmp_path, **quiet) as child:
                child.stdout.readline()
                if number:
                    time.sleep(random.uniform(*seconds))
                    child.send_signal(number)
            kills += child.returncode != 0
        assert child.returncode == 0
    assert kills
    if len(how) == 2:
        mcgw.merge(tmp_path / "a.h5")
    assert digest(tmp_path / "a.h5") == expected()


def test_a_worker_draws_for_nobody_who_asked_something_else(tmp_path):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path, shard="2/2")
    folder = folder_of(path)
    chunk = SweepFolder.open(folder).missing()[0]
    asked = folder / ASKED
    asked.write_text(asked.read_text().replace("seed = 7\n", "seed = 8\n"))
    with pytest.raises(mcgw.RunError, match=r"cannot be gone on with here: asked\.toml was changed"):
        commit_chunk(str(folder), chunk)
    asked.write_text("identity = 3")
    with pytest.raises(mcgw.StoreError, match=r"asked\.toml: damaged"):
        commit_chunk(str(folder), chunk)


def test_engines_draw_into_a_file():
    for how in ({"engine": "processes"}, {"shard": "1/2"}):
        with pytest.raises(ValueError, match=r"^engine, shard: others draw into a file; give path"):
            mcgw.sweep(SCENE, OVER, **how)
    with pytest.raises(ValueError, match="a share is drawn by threads"):
        mcgw.sweep(SCENE, OVER, path="a.h5", engine="processes", shard="1/2")


def test_the_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(mcgw.scene_text(SCENE))
    call = ["sweep", "s.toml", "--over", "grading.gamma=0.5:1.5:3", "-o"]
    assert main([*call, "p.h5", "--processes", "2"]) == 0
    assert main([*call, "s.h5", "--shard", "2/2"]) == 0
    assert main(["merge", "s.h5"]) == 1
    assert main([*call, "s.h5", "--shard", "1/2"]) == 0
    capsys.readouterr()
    assert main(["merge", "s.h5"]) == 0
    assert capsys.readouterr().out == "s.h5: 3 scenes, seed 7\n"
    assert main(["merge", "s.h5"]) == 0
    assert "was finished before, 3 scenes" in capsys.readouterr().out
    assert digest(tmp_path / "s.h5") == digest(tmp_path / "p.h5")
    assert main([*call, "s.h5", "--shard", "3/2"]) == 2
