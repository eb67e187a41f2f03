"""Sweeps in files: whole or not at all, drawn once, the same digest by whom and however interrupted."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles.begun_runs import settle
from oracles.flipped import flip_a_number
from oracles.inside import RECORD, Jobs, Plan, commit_block, parts_of, read_attributes

import mcgw
from mcgw.cli import main
from mcgw.commands.sweep import _axis
from mcgw.sweeps import groups

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(
    SURFACE, separations=[0.0, 1.0, 2.5], n_surfaces=300, ensemble=mcgw.Sampling(n_asperities=2000), seed=7
)
GAMMA, N = "grading.gamma", "ensemble.n_asperities"
OVER = {GAMMA: np.linspace(0.5, 1.7, 9), N: [200, 2000]}
WORDS = {GAMMA: [0.5, 2.0], "ensemble.count": ["poisson", "fixed"]}
FIRST = 2 * [0, 50, 100, 150, 200, 250]  # surfaces of the chunks
TOML = """
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 40, n_asperities = 300, seed = 4}
"""


def digest(path):
    return read_attributes(path)["digest"]


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch):
    """Six for each group; workers are told which chunk, so that theirs are the same."""
    monkeypatch.setattr(groups, "_ROWS", 50)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2]))


@pytest.fixture
def drawn(monkeypatch):
    """First surfaces of the blocks that are drawn, within their groups."""
    found, plain = [], groups.Pooling.tables

    def counted(pooling, first, *rest):
        found.append(first)
        return plain(pooling, first, *rest)

    monkeypatch.setattr(groups.Pooling, "tables", counted)
    return found


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """Digest of what threads draw."""
    path = tmp_path_factory.mktemp("threads") / "a.h5"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(groups, "_ROWS", 50)
        mcgw.sweep(SCENE, OVER, path=path)
    return digest(path)


def test_a_file_has_the_bits_of_memory(tmp_path):
    pytest.importorskip("xarray")
    tables = [mcgw.Table((-1, k, 6), (1.0, 1.5, 3.0)) for k in (0.33, 0.7)]
    for over in (OVER, {"grading": tables, "surface.E_star": ["70 GPa", 8e10]}):
        path = tmp_path / f"{len(over)}-{'grading' in over}.h5"
        held, memory = mcgw.sweep(SCENE, over, path=path), mcgw.sweep(SCENE, over)
        opened = mcgw.open_sweep(path)
        for sweep in (held, opened):
            for name in memory.quantities:
                assert np.array_equal(sweep.mean(name), memory.mean(name))
                assert np.array_equal(sweep.std(name), memory.std(name))
            assert list(sweep.scenes) == list(memory.scenes)
            assert repr(sweep) == repr(memory)
            assert sweep.to_xarray().identical(memory.to_xarray())
        last = tuple(n - 1 for n in memory.shape)
        found, other = (x.difference("load", (0, 0), (last[0], 0)) for x in (opened, memory))
        assert np.array_equal(found.stderr, other.stderr)
        assert not (tmp_path / f"{path.name}.parts").exists()


def test_other_programs_read_it(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    sweep = mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    with xarray.open_dataset(tmp_path / "a.h5", engine="h5netcdf") as data:
        assert data.load_std.dims == ("gamma", "n_asperities", "separation")
        assert np.array_equal(data.load_std, sweep.std("load"))
        assert (data.gamma.values.tolist(), data.n_asperities.values.tolist()) == tuple(
            map(list, OVER.values())
        )
        assert data.attrs["filetype"] == "mcgw-results"
    zipped = mcgw.sweep(SCENE, WORDS, zipped=True, path=tmp_path / "b.h5")
    with xarray.open_dataset(tmp_path / "b.h5", engine="h5netcdf") as data:
        assert data.load_mean.dims == ("point", "separation")
        assert np.array_equal(data.load_mean, zipped.mean("load"))
        assert data.gamma.values.tolist() == [0.5, 2.0]
        assert data["count"].values.tolist() == [0, 1]
        assert data["count"].attrs["long_name"] == "ensemble.count: 0 poisson, 1 fixed"


@pytest.mark.parametrize("after", [1, 6])
def test_interrupted_anywhere_it_goes_on_to_the_same_digest(tmp_path, monkeypatch, drawn, expected, after):
    """A damaged chunk is drawn again; a finished file is not."""
    path, counted = tmp_path / "a.h5", groups.Pooling.tables

    def stopped(*words):
        if len(drawn) == after:
            raise KeyboardInterrupt
        return counted(*words)

    with monkeypatch.context() as patch:
        patch.setattr(groups.Pooling, "tables", stopped)
        with pytest.raises(KeyboardInterrupt):
            mcgw.sweep(SCENE, OVER, path=path)
        settle()
    assert not path.exists()
    shards = sorted(parts_of(path).glob("shards/block-*.h5"))
    assert len(shards) == after
    flip_a_number(shards[0])
    for _ in range(2):
        mcgw.sweep(SCENE, OVER, path=path, threads=1)
        assert drawn == [*FIRST[: len(shards)], 0, *FIRST[len(shards) :]]
    assert digest(path) == expected
    assert not (tmp_path / "a.h5.parts").exists()


def test_progress_of_a_file_goes_on_from_what_it_holds(tmp_path):
    """By hand: an asperity that touches at d = 0 is one, a scene of a surface 3000; 600 surfaces in all."""
    over, path, told = {GAMMA: [0.5, 1.0, 1.7], N: [200, 20_000]}, tmp_path / "a.h5", []
    each = [50 * (n / 2 + 3 * 3000) for n in (200, 20_000)]
    whole = [0.0, *np.cumsum(6 * [each[0]] + 6 * [each[1]])]
    left = mcgw.sweep(SCENE, over, path=path, shard="1/2", progress=lambda *pair: told.append(pair))
    assert left == 300
    part = np.cumsum([0, each[0], each[0], each[0], each[1], each[1], each[1]])
    assert told == [(round(600 * x / whole[-1]), 600) for x in part]
    told.clear()
    mcgw.sweep(SCENE, over, path=path, threads=1, progress=lambda *pair: told.append(pair))
    rest = part[-1] + part
    assert told == [(round(600 * x / whole[-1]), 600) for x in rest]
    told.clear()
    mcgw.sweep(SCENE, over, path=path, progress=lambda *pair: told.append(pair))
    assert told == [(600, 600)]


def test_another_sweep_is_left_alone(tmp_path):
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    for scene, over in ((SCENE, {GAMMA: [1.0]}), (SCENE.replace(seed=8), OVER)):
        with pytest.raises(mcgw.StoreError, match=r"a\.h5: holds something else than this sweep; choose"):
            mcgw.sweep(scene, over, path=tmp_path / "a.h5")
    e = mcgw.simulate(SCENE, n_surfaces=3)
    mcgw.save(e, tmp_path / "e.h5")
    with pytest.raises(mcgw.StoreError, match="holds something else than this sweep"):
        mcgw.sweep(SCENE, OVER, path=tmp_path / "e.h5")
    with pytest.raises(mcgw.StoreError, match=r"holds a sweep; mcgw\.open_sweep opens it"):
        mcgw.open_ensemble(tmp_path / "a.h5")
    with pytest.raises(mcgw.StoreError, match="holds a sweep; choose another -o, or remove it"):
        mcgw.run(SCENE, tmp_path / "a.h5")
    with pytest.raises(mcgw.StoreError, match=r"not the file of a sweep; mcgw\.open_ensemble opens it"):
        mcgw.open_sweep(tmp_path / "e.h5")

    mcgw.sweep(SCENE, OVER, path=tmp_path / "b.h5", shard="1/2")
    with pytest.raises(mcgw.StoreError, match=r"holds a different sweep: sweep is .* there and .* here"):
        mcgw.sweep(SCENE, {GAMMA: [1.0]}, path=tmp_path / "b.h5")


def test_a_seed_that_nobody_gave_is_that_of_the_file(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0], n_surfaces=5)
    first = mcgw.sweep(scene, {GAMMA: [1.0, 2.0]}, path=tmp_path / "a.h5")
    other = mcgw.Scene(SURFACE, separations=[0.0], n_surfaces=5)
    again = mcgw.sweep(other, {GAMMA: [1.0, 2.0]}, path=tmp_path / "a.h5")
    assert again.scenes[0].seed == first.scenes[0].seed == scene.seed != other.seed


def test_scenes_of_a_file_are_those_of_a_list(tmp_path):
    """By any index or slice."""
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    scenes, memory = mcgw.open_sweep(tmp_path / "a.h5").scenes, mcgw.sweep(SCENE, OVER).scenes
    assert len(scenes) == len(memory) == 18
    for some in (slice(None), slice(3, 9, 2), slice(None, None, -7), slice(-2, None), slice(5, 5)):
        assert tuple(scenes[some]) == tuple(memory[some])
    assert scenes[-1] == memory[-1]
    with pytest.raises(IndexError):
        scenes[18]


@pytest.fixture
def shell(tmp_path, in_tmp_path, capsys):
    (tmp_path / "s.toml").write_text(TOML)

    def call(*words, code=0):
        assert main(list(words)) == code
        return capsys.readouterr()

    return call


def test_the_command(shell, tmp_path):
    over = ["--over", f"{GAMMA}=0.5:1.5:3", "--over", f"{N}=200,1e3"]
    plan = shell("sweep", "s.toml", *over, "--plan").out
    assert "6 scenes" in plan
    assert "80, with" in plan
    alone = shell("sweep", "s.toml", "--over", "ensemble.n_surfaces=20,40", "--plan").out
    assert "groups 2 that share" in " ".join(alone.split())
    assert "computed 2 scenes" in " ".join(alone.split())
    assert os.listdir(tmp_path) == ["s.toml"]
    assert "out/s.sweep.h5: 6 scenes" in shell("sweep", "s.toml", *over).out
    sweep = mcgw.open_sweep("out/s.sweep.h5")
    assert sweep.axes.values == {GAMMA: (0.5, 1.0, 1.5), N: (200, 1000.0)}
    assert sweep.scene((0, 1)).n_asperities == 1000
    shown = shell("show", "out/s.sweep.h5", "--csv", "t.csv").out
    assert "Sweep of 6 scenes" in shown
    table = np.genfromtxt("t.csv", delimiter=",", names=True)
    assert np.array_equal(table["load_mean_N"].reshape(3, 2, 2), sweep.mean("load"))
    assert shell("show", "out/s.sweep.h5", "--digest").out.strip() == digest(tmp_path / "out/s.sweep.h5")
    assert mcgw.scene_from(shell("show", "out/s.sweep.h5", "--scene").out).seed == sweep.scenes[0].seed
    assert "intact" in shell("show", "out/s.sweep.h5", "--verify").out


def test_values_of_the_command_are_numbers_evenly_or_as_they_stand():
    assert _axis("a.b=-1:3:2", "--over") == ("a.b", [-1.0, 3.0])
    assert _axis("a.b=3:1:5", "--over") == ("a.b", [3.0, 2.5, 2.0, 1.5, 1.0])
    assert _axis("a.b=1,0.5,auto", "--over") == ("a.b", [1, 0.5, "auto"])
    assert _axis("a.b=x:1:2", "--over") == ("a.b", ["x:1:2"])
    _, values = _axis("a.b=0:1:1000000", "--over")
    assert (len(values), values[-1]) == (10**6, 1.0)


# --- by others ------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_by_processes_of_which_one_is_killed(tmp_path, expected):
    """All blocks in hand are lost with it; a second kill might meet one again, which ends the sweep."""
    random, killed = np.random.default_rng(5), []

    def kill(done, total):
        if done and not killed and random.random() < 0.5:
            killed.extend(list(jobs._pool._processes or ())[:1])
            for pid in killed:
                os.kill(pid, signal.SIGKILL)

    with Jobs(2) as jobs:
        mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", executor=jobs, progress=kill)
    assert killed
    assert digest(tmp_path / "a.h5") == expected
    assert not list(tmp_path.glob("*.parts"))


def test_in_shares_in_any_order(tmp_path, expected):
    path, left = tmp_path / "a.h5", []
    with pytest.raises(mcgw.StoreError, match="neither this file nor its blocks"):
        mcgw.merge(path)
    for i in (3, 1, 2):
        left.append(mcgw.sweep(SCENE, OVER, path=path, shard=f"{i}/3"))
        assert not path.exists()
        if left[-1]:
            with pytest.raises(mcgw.RunError, match=rf"{left[-1]} of 600 surfaces are missing, from \d+ on"):
                mcgw.merge(path)
    assert left == [400, 200, 0]
    assert mcgw.sweep(SCENE, OVER, path=path, shard="2/3") == 0  # a job that is started again
    merged = mcgw.merge(path)
    assert digest(path) == expected
    assert merged.shape == (9, 2)
    assert not list(tmp_path.glob("*.parts"))
    assert mcgw.sweep(SCENE, OVER, path=path, shard="1/3") == 0
    assert repr(mcgw.merge(path)) == repr(merged)
    with pytest.raises(mcgw.StoreError, match="holds something else than this sweep"):
        mcgw.sweep(SCENE, {"grading.gamma": [1.0]}, path=path, shard="1/3")


def test_a_worker_draws_for_nobody_who_asked_something_else(tmp_path):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path, shard="2/2")
    asked = parts_of(path) / RECORD
    good, run = asked.read_bytes(), Plan.open(parts_of(path))
    for data in (good.replace(b"seed = 7\n", b"seed = 8\n"), good[:-9]):
        asked.write_bytes(data)
        with pytest.raises(mcgw.StoreError, match=r"run\.h5: .*damaged"):
            commit_block(str(parts_of(path)), 0, 50)
    replace(run, identity="0" * 64)._write(expected="anything")
    with pytest.raises(mcgw.RunError, match="this worker cannot draw for that run"):
        commit_block(str(parts_of(path)), 0, 50)


def test_executors_draw_into_a_file():
    pool = ThreadPoolExecutor(1)
    for how in ({"executor": pool}, {"shard": "1/2"}):
        with pytest.raises(ValueError, match=r"^executor, shard: they need a file; give path"):
            mcgw.sweep(SCENE, OVER, **how)
    with pytest.raises(ValueError, match="a share uses threads"):
        mcgw.sweep(SCENE, OVER, path="a.h5", executor=pool, shard="1/2")
