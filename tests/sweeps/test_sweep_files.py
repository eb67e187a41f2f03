"""Sweeps in files: whole or not at all, drawn once, the same digest by whom and however interrupted."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from oracles.begun_runs import settle
from oracles.flipped import flip_a_number
from oracles.inside import RECORD, Group, Plan, commit_block, home, parts_of, read_attributes
from oracles.said import call

import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(
    SURFACE, separations=[0.0, 1.0, 2.5], n_surfaces=300, ensemble=mcgw.Sampling(n_asperities=2000), seed=7
)
GAMMA, N = "grading.gamma", "ensemble.n_asperities"
OVER = {GAMMA: np.linspace(0.5, 1.7, 9), N: [200, 2000]}
FIRST = 2 * [0, 100, 200]  # surfaces of the chunks


def digest(path):
    return read_attributes(path)["digest"]


@pytest.fixture(autouse=True, scope="module")
def _small_chunks():
    """Three for each group."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(home("Group"), "_ROWS", 100)
        yield


@pytest.fixture(scope="module")
def expected(_small_chunks, tmp_path_factory):
    """Digest of what threads draw."""
    path = tmp_path_factory.mktemp("threads") / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path)
    return digest(path)


def test_a_file_has_the_bits_of_memory(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    tables = [mcgw.Table((-1, k, 6), (1.0, 1.5, 3.0)) for k in (0.33, 0.7)]
    for path, over in (
        (tmp_path / "a.h5", OVER),
        (tmp_path / "b.h5", {"grading": tables, "surface.E_star": ["70 GPa", 8e10]}),
    ):
        held, memory = mcgw.sweep(SCENE, over, path=path), mcgw.sweep(SCENE, over)
        opened = mcgw.open_sweep(path)
        for sweep in (held, opened):
            for name in memory.quantities:
                assert np.array_equal(sweep.mean(name), memory.mean(name))
                assert np.array_equal(sweep.std(name), memory.std(name))
        assert list(opened.scenes) == list(memory.scenes)
        assert repr(opened) == repr(memory)
        assert opened.to_xarray().identical(memory.to_xarray())
        with xarray.open_dataset(path, engine="h5netcdf") as data:
            assert np.array_equal(data.load_std, memory.std("load"))
            assert data.load_std.dims == (*memory.axes.dims, "separation")
        found, other = (x.difference("load", (0, 0), (1, 0)) for x in (opened, memory))
        assert np.array_equal(found.stderr, other.stderr)
        assert not (tmp_path / f"{path.name}.parts").exists()


def test_other_programs_read_points_in_a_row_and_words_as_codes(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    over = {GAMMA: [0.5, 2.0], "ensemble.count": ["poisson", "fixed"]}
    sweep = mcgw.sweep(SCENE, over, zipped=True, path=tmp_path / "a.h5")
    with xarray.open_dataset(tmp_path / "a.h5", engine="h5netcdf") as data:
        assert data.load_std.dims == ("point", "separation")
        assert np.array_equal(data.load_std, sweep.std("load"))
        assert (data.gamma.values.tolist(), data["count"].values.tolist()) == ([0.5, 2.0], [0, 1])
        assert data["count"].attrs["long_name"] == "ensemble.count: 0 poisson, 1 fixed"


@pytest.mark.parametrize("after", [1, pytest.param(3, marks=pytest.mark.slow)])
def test_interrupted_anywhere_it_goes_on_to_the_same_digest(tmp_path, monkeypatch, expected, after):
    """A damaged chunk is drawn again; a finished file is not."""
    path, tables, drawn, stops = tmp_path / "a.h5", Group.tables, [], [after]

    def counted(group, first, *rest):
        if len(drawn) in stops:
            raise KeyboardInterrupt
        drawn.append(first)
        return tables(group, first, *rest)

    monkeypatch.setattr(Group, "tables", counted)
    with pytest.raises(KeyboardInterrupt):
        mcgw.sweep(SCENE, OVER, path=path)
    settle()
    stops.clear()
    assert not path.exists()
    shards = sorted(parts_of(path).glob("shards/block-*.h5"))
    assert len(shards) == after
    flip_a_number(shards[0])
    for _ in range(2):
        mcgw.sweep(SCENE, OVER, path=path, threads=1)
        assert drawn == [*FIRST[:after], 0, *FIRST[after:]]
    assert digest(path) == expected
    assert not parts_of(path).exists()


def test_another_sweep_is_left_alone(tmp_path):
    a, b, e = (tmp_path / f"{name}.h5" for name in "abe")
    mcgw.sweep(SCENE, OVER, path=a)
    mcgw.sweep(SCENE, OVER, path=b, shard="1/2")
    mcgw.save(mcgw.simulate(SCENE, n_surfaces=3), e)
    other, another = {GAMMA: [1.0]}, r"holds a different (sweep|ensemble): .* there and .* here; choose"
    for work, told in (
        (lambda: mcgw.sweep(SCENE, other, path=a), rf"a\.h5: {another}"),
        (lambda: mcgw.sweep(SCENE, other, path=a, shard="1/3"), rf"a\.h5: {another}"),
        (lambda: mcgw.sweep(SCENE.replace(seed=8), OVER, path=a), another),
        (lambda: mcgw.sweep(SCENE, OVER, path=e), another),
        (lambda: mcgw.open_ensemble(a), r"holds a sweep; mcgw\.open_sweep opens it, mcgw compare"),
        (lambda: mcgw.run(SCENE, a), "holds a different sweep: sweep is .* there and None here; choose"),
        (lambda: mcgw.open_sweep(e), r"not the file of a sweep; mcgw\.open_ensemble opens it"),
        (lambda: mcgw.sweep(SCENE, other, path=b), r"holds a different sweep: sweep is .* there and .* here"),
    ):
        with pytest.raises(mcgw.StoreError, match=told):
            work()


def test_a_seed_that_nobody_gave_is_that_of_the_file(tmp_path):
    first, other = (mcgw.Scene(SURFACE, separations=[0.0], n_surfaces=5) for _ in range(2))
    for scene in (first, other):
        made = mcgw.sweep(scene, {GAMMA: [1.0, 2.0]}, path=tmp_path / "a.h5")
        assert made.scenes[0].seed == first.seed != other.seed


def test_commands_show_it(tmp_path):
    """`test_every_flag` and `test_what_users_read` have how it is made, and the rest of what is said."""
    path = tmp_path / "s.h5"
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=20), {GAMMA: [0.5, 1.0, 1.5], N: [200, 1e3]}, path=path)
    assert "Sweep of 6 scenes" in call("show", path, "--csv", tmp_path / "t.csv").stdout
    table = np.genfromtxt(tmp_path / "t.csv", delimiter=",", names=True)
    assert np.array_equal(table["load_mean_N"].reshape((*sweep.shape, 3)), sweep.mean("load"))
    assert call("show", path, "--digest").stdout.strip() == digest(path)
    assert mcgw.scene_from(call("show", path, "--scene").stdout).seed == sweep.scenes[0].seed
    assert "intact" in call("show", path, "--verify").stdout


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


def test_a_worker_draws_for_nobody_who_asked_something_else(tmp_path):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path, shard="2/2")
    plan = Plan.open(parts_of(path))
    plan.identity = "0" * 64
    home("Plan")._write(parts_of(path) / RECORD, {}, plan._about("mcgw-run"))
    with pytest.raises(mcgw.RunError, match="this worker cannot draw for that run"):
        commit_block(str(parts_of(path)), 0, 100)


def test_executors_draw_into_a_file(tmp_path, expected):
    with ThreadPoolExecutor(1) as pool:
        for how in ({"executor": pool}, {"shard": "1/2"}):
            with pytest.raises(ValueError, match=r"^executor, shard: they need a file; give path"):
                mcgw.sweep(SCENE, OVER, **how)
        with pytest.raises(ValueError, match="a share uses threads"):
            mcgw.sweep(SCENE, OVER, path="a.h5", executor=pool, shard="1/2")
        mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", executor=pool)
    assert digest(tmp_path / "a.h5") == expected


def test_a_sweep_half_done_says_how_far_it_is(tmp_path):
    path, scene = tmp_path / "s.h5", SCENE.replace(n_surfaces=100)
    over = {GAMMA: [0.5, 1.5], "ensemble.count": ["fixed", "poisson"]}
    left = mcgw.sweep(scene, over, path=path, shard="1/2")
    assert left == 100  # one of two groups, by the law of the number of asperities
    assert call("show", path).stdout == (
        f"{path}: a sweep of 4 points over grading.gamma, ensemble.count, not finished: 100 of 200 surfaces "
        "are drawn; run mcgw sweep again to resume\n"
    )
    assert mcgw.scene_from(call("show", "--scene", path).stdout).surface == SURFACE
    for option in ("--verify", "--digest"):
        done = call("show", path, option)
        assert done.returncode == 2
        assert "is an unfinished sweep; finish it with mcgw sweep" in done.stderr
    with pytest.raises(mcgw.StoreError, match="is an unfinished sweep; mcgw show prints its progress"):
        mcgw.open_ensemble(path)
    assert mcgw.sweep(scene, over, path=path).shape == (2, 2)  # nothing of it was removed
