"""`keep = "statistics"`: what follows from surfaces follows without them, in the same bits whoever draws."""

import math
import subprocess
import sys
from fractions import Fraction

import h5py
import numpy as np
import pytest
import scipy.stats
from conftest import SURFACE

import mcgw
from mcgw.ensemble import summarising
from mcgw.ensemble.bins import Bins
from mcgw.ensemble.summary import Summary, push, total
from mcgw.errors import StoreError
from mcgw.jobs.from_python import run
from mcgw.machine.memory import peak_growth
from mcgw.scene.section import SceneError
from mcgw.store.ensembles import read_attributes, verify

H = [0.0, 1.0, 2.5]
SHARES = (0.0, 0.003, 0.05, 1 / 3, 0.5, 0.9, 0.999, 1.0)


def scene(**changes):
    given = {"separations": H, "seed": 3, "n_surfaces": 700, "n_asperities": 300, **changes}
    return mcgw.Scene(given.pop("surface", SURFACE), **given)


YIELDS = mcgw.KogutEtsion(hardness=1.2e9, poisson=0.3)
PUSHED = mcgw.Tangential(friction=0.3, poisson=0.3, displacements=[1e-8, 1e-7])
SPECTRUM = mcgw.SpectralSurface(m0=1e-12, m2=1e-3, m4=1e7, nominal_area="1 mm^2", E_star="80 GPa")
SCENES = {
    "hertz": scene(),
    "graded, poisson": scene(grading=mcgw.Exponential(2.0), count="poisson"),
    "yields, and back": scene(
        law=YIELDS, unload_from=-0.5, quantities=["load", "yielded", "contacts", "area"]
    ),
    "pushed": scene(tangential=PUSHED),
    "interacting": scene(interaction="body"),
    "balanced": scene(interaction={"reference": "mean-plane", "at": "nominal"}, n_surfaces=200),
    "crowds": scene(sampler="aggregate", n_asperities=10**7),
    "direct": scene(sampler="direct", n_asperities=60),
    "lognormal": scene(heights=scipy.stats.lognorm(0.3)),
    "rare": scene(separations=[4.0, 6.0, 9.0], n_asperities=300),
    "own radii": scene(surface=SPECTRUM),
    "one surface": scene(n_surfaces=1),
    "few bits": scene(accuracy=1e-5),
    "two alike": scene(separations=[1.0, 0.0, 1.0]),
}


@pytest.fixture
def small_blocks(monkeypatch):
    """Blocks of 256 surfaces, of four pieces: as many as a long run has."""
    monkeypatch.setattr(summarising, "_ROWS", 64)
    monkeypatch.setattr(summarising, "_MOST", 256)


def exactly(x):
    """Mean, std, and sum of cubes of deviations in exact arithmetic, rounded once."""
    x = [Fraction(v) for v in x.tolist()]
    mean = sum(x) / len(x)
    squares, cubes = (sum((v - mean) ** k for v in x) for k in (2, 3))
    std = math.sqrt(squares / (len(x) - 1)) if len(x) > 1 else math.nan
    return float(mean), std, float(cubes)


@pytest.mark.parametrize("name", SCENES)
def test_statistics_are_those_of_the_surfaces(name):
    """Mean, deviation and skewness against exact arithmetic, covariances against extended precision."""
    asked = SCENES[name]
    full, kept = mcgw.simulate(asked), mcgw.simulate(asked, keep="statistics")
    assert kept.n_surfaces == full.n_surfaces
    columns = np.concatenate(
        [full[q].reshape(full.n_surfaces, -1).astype(np.longdouble) for q in asked.shapes], axis=1
    )
    apart = columns - columns.mean(axis=0)
    stds = np.sqrt((apart**2).sum(axis=0))
    start = 0
    for q in asked.shapes:
        flat = full[q].reshape(full.n_surfaces, -1)
        size = flat.shape[1]
        for k in range(size):
            mean, std, cubes = exactly(flat[:, k])
            np.testing.assert_allclose(kept.mean(q).ravel()[k], mean, rtol=1e-13)
            np.testing.assert_allclose(kept.std(q).ravel()[k], std, rtol=1e-13)
            if full.n_surfaces > 1 and std > 0:
                scale = (std * math.sqrt(full.n_surfaces - 1)) ** 3 / math.sqrt(full.n_surfaces)
                np.testing.assert_allclose(kept.skewness(q).ravel()[k], cubes / scale, atol=1e-11)
        other = next(iter(asked.shapes))
        wanted = (apart[:, start : start + size].T @ apart[:, : len(H)]).astype(float)
        limit = np.outer(stds[start : start + size], stds[: len(H)]).astype(float)
        if full.n_surfaces > 1:
            found = kept.covariance(q, other).reshape(size, -1) * (full.n_surfaces - 1)
            assert np.all(np.abs(found - wanted) <= 1e-13 * limit)
        start += size


@pytest.mark.parametrize("name", SCENES)
def test_quantiles_lie_where_they_are_said_to(name):
    asked = SCENES[name]
    full, kept = mcgw.simulate(asked), mcgw.simulate(asked, keep="statistics")
    for q in asked.shapes:
        for share in SHARES:
            exact, (low, high) = full.quantile(q, share), kept.quantile_range(q, share)
            slack = 1e-12 * np.abs(exact)  # of the interpolation
            assert np.all((low - slack <= exact) & (exact <= high + slack)), (q, share)
            found = kept.quantile(q, share)
            assert np.all((low - slack <= found) & (found <= high + slack))
            if full.n_surfaces > 1:
                far = np.abs(exact - full.mean(q)) + 2 * full.std(q)
                assert np.all(high - low <= far / 32 + slack)
        for mine, theirs in zip(kept.extremes(q), full.extremes(q), strict=True):
            np.testing.assert_array_equal(mine, theirs)
        for mine, theirs in zip(kept.extreme_surfaces(q), full.extreme_surfaces(q), strict=True):
            np.testing.assert_array_equal(mine, theirs)


def test_numbers_of_contacts_have_exact_quantiles():
    """A bin of a number that varies by less than 128 holds one whole number."""
    full, kept = mcgw.simulate(scene()), mcgw.simulate(scene(keep="statistics"))
    for share in (0.01, 0.5, 0.77):
        np.testing.assert_allclose(
            kept.quantile("contacts", share), full.quantile("contacts", share), rtol=1e-12
        )


@pytest.mark.parametrize("distance", [0.0, 1e-9, 0.3, 1.0, 7.7, 300.0, 1e5])
def test_a_value_lies_in_its_bin(distance):
    bins = Bins(np.array([5.0]), np.array([0.25]))
    for value in (5.0 + distance, 5.0 - distance, np.nextafter(5.0 + distance, 9e9)):
        place = np.flatnonzero(bins.counts(0, np.array([value])))
        low, high = bins.ends(np.array([0]), place, whole=False)
        assert low <= value <= high
        assert bins.counts(0, np.array([value])).sum() == 1


def assert_same_bits(one, other):
    for q in one.scene.shapes:
        for get in ("mean", "std", "skewness"):
            np.testing.assert_array_equal(getattr(one, get)(q), getattr(other, get)(q))
        for share in SHARES:
            np.testing.assert_array_equal(one.quantile(q, share), other.quantile(q, share))
        np.testing.assert_array_equal(one.covariance(q, "load"), other.covariance(q, "load"))


@pytest.mark.usefixtures("small_blocks")
def test_same_bits_whoever_draws_them(tmp_path):
    """In memory, in a file, on one thread, by jobs in any order, in steps, after a loss: one digest."""
    asked = scene(n_surfaces=1500, keep="statistics")
    e = run(asked, tmp_path / "a.h5")
    assert read_attributes(tmp_path / "a.h5")["filetype"] == "mcgw-statistics"
    assert_same_bits(e, mcgw.simulate(asked))
    assert_same_bits(e, mcgw.simulate(asked, threads=1))
    wanted = read_attributes(tmp_path / "a.h5")["digest"]
    for i in (3, 1, 2):
        left = run(asked, tmp_path / "b.h5", shard=f"{i}/3")
    assert left == 0
    mcgw.merge(tmp_path / "b.h5")
    for n in (100, 300, 1000, 1500):
        run(asked, tmp_path / "c.h5", n_surfaces=n)
    run(asked, tmp_path / "d.h5", shard="1/2", n_surfaces=700)  # its last block is not a whole one
    run(asked, tmp_path / "d.h5", shard="2/2")
    (tmp_path / "d.h5.parts" / "shards" / "block-0000000000256.h5").unlink()
    run(asked, tmp_path / "d.h5", threads=1)
    for name in "bcd":
        assert read_attributes(tmp_path / f"{name}.h5")["digest"] == wanted, name
        assert_same_bits(e, mcgw.open_ensemble(tmp_path / f"{name}.h5"))
        assert not list((tmp_path / f"{name}.h5.parts").glob("shards/*"))


def test_the_order_of_joining_would_change_bits():
    """The companion: another tree gives other last digits, so the test above can fail."""
    values = np.random.default_rng(1).normal(size=(64, 5)) ** 3
    bins = Bins(np.zeros(5), np.ones(5))
    leaves = [Summary.of(values[k : k + 8], k, bins) for k in range(0, 64, 8)]
    tree: list[Summary] = []
    for leaf in leaves:
        push(tree, leaf)
    along = leaves[0]
    for leaf in leaves[1:]:
        along = along + leaf
    assert len(tree) == 1
    np.testing.assert_allclose(along.products, total(tree).products, rtol=1e-12)
    assert not np.array_equal(along.products, total(tree).products)
    np.testing.assert_array_equal(along.counts, total(tree).counts)


def test_processes_draw_the_same(tmp_path):
    asked = scene(n_surfaces=9000, separations=[1.0], keep="statistics", n_asperities=20)
    one = run(asked, tmp_path / "a.h5", engine="processes", threads=2)
    assert_same_bits(one, mcgw.simulate(asked))


@pytest.mark.usefixtures("small_blocks")
def test_a_run_in_progress_can_be_looked_at(tmp_path):
    asked = scene(n_surfaces=1500, keep="statistics")
    run(asked, tmp_path / "a.h5", shard="1/3")
    e = mcgw.open_ensemble(tmp_path / "a.h5")
    assert 0 < e.n_surfaces < 1500
    assert np.all(np.abs(e.mean("load") - asked.theory.mean("load", np.array(H))) < 5 * e.stderr("load"))


@pytest.mark.parametrize(
    "name", ["hertz", "yields, and back", "interacting", "balanced", "crowds", "own radii"]
)
def test_compare_takes_them(name, tmp_path):
    """False alarms: one in a thousand each, of the fixed seeds none."""
    e = run(SCENES[name], tmp_path / "a.h5", keep="statistics")
    assert mcgw.compare(e).verdict.agrees


def test_compare_sees_another_modulus(tmp_path):
    """The companion: surfaces of gamma = 2 told as of gamma = 1.9."""
    from dataclasses import replace

    e = mcgw.simulate(scene(grading=mcgw.Exponential(2.0), n_surfaces=20_000, keep="statistics"))
    told = replace(e, scene=e.scene.replace(grading=mcgw.Exponential(1.9)))
    assert not mcgw.compare(told).verdict.agrees


def test_the_file_is_read_by_others_and_says_when_it_is_damaged(tmp_path):
    import xarray

    path = tmp_path / "a.h5"
    e = run(scene(tangential=PUSHED), path, keep="statistics")
    with xarray.open_dataset(path, engine="h5netcdf") as file:
        np.testing.assert_array_equal(file["load_mean"], e.mean("load"))
        assert file["load_quantile"].dims == ("probability", "separation")
        assert file["tangential_load_std"].dims == ("separation", "displacement")
        assert file["load_std"].units == "N"
        xarray.testing.assert_equal(file[list(e.to_xarray())].load(), e.to_xarray())
        assert file["covariance"].shape == (e.scene.width,) * 2
    assert e.to_dataframe()["load_std"].tolist() == e.std("load").tolist()
    assert verify(path)[0] == ""
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    assert verify(path)[0] != ""


def test_a_file_that_says_something_else_than_its_scene_is_refused(tmp_path):
    path = tmp_path / "a.h5"
    run(scene(n_surfaces=10), path, keep="statistics")
    with h5py.File(path, "r+") as file:
        file.attrs["filetype"] = "mcgw-ensemble"
    with pytest.raises(StoreError, match=r"not a whole file"):
        mcgw.open_ensemble(path)


def test_single_surfaces_are_refused_with_what_to_do(tmp_path):
    e = run(scene(n_surfaces=10), tmp_path / "a.h5", keep="statistics")
    for ask in (lambda: e.load, lambda: e["contacts"], lambda: mcgw.regrade(e, mcgw.Exponential(2.0))):
        with pytest.raises(ValueError, match="single surfaces are not kept"):
            ask()
    with pytest.raises(ValueError, match=r"share = 1\.5"):
        e.quantile("load", 1.5)
    with pytest.raises(KeyError, match="conductance"):
        e.covariance("load", "conductance")
    with pytest.raises(SceneError, match="stratified"):
        scene(sampler="stratified", keep="statistics")
    with pytest.raises(StoreError, match=r"different"):
        run(scene(n_surfaces=10), tmp_path / "a.h5")
    with pytest.raises(StoreError, match="covariances between 400000 numbers"):
        mcgw.simulate(scene(separations=np.linspace(0, 4, 100_000), n_surfaces=2, keep="statistics"))


def test_a_saved_ensemble_is_the_same_file(tmp_path):
    e = mcgw.simulate(scene(keep="statistics"))
    run(scene(keep="statistics"), tmp_path / "a.h5")
    mcgw.save(e, tmp_path / "b.h5")
    digests = {read_attributes(tmp_path / name)["digest"] for name in ("a.h5", "b.h5")}
    assert len(digests) == 1


def test_memory_does_not_grow_with_surfaces():
    few, many = (
        peak_growth(lambda n=n: mcgw.simulate(scene(n_asperities=5, n_surfaces=n, keep="statistics")))
        for n in (40_000, 400_000)
    )
    assert not many > few + 2**24  # 16 MiB, of 38 MB of values; nan where the system does not tell


def test_nobody_pays_who_does_not_ask():
    code = """
import sys, mcgw
surface = mcgw.Surface(1e-6, 1e-5, 3e8, 1e-6, 8e10)
mcgw.simulate(mcgw.Scene(surface, separations=1.0, n_surfaces=3, seed=1)).mean("load")
print([name for name in sys.modules if "summar" in name or name.endswith(".bins")])
"""
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        == "[]\n"
    )


@pytest.mark.parametrize("command", [["report"], ["compare"], ["show", "--csv"], ["export", "--to", "moose"]])
def test_commands_take_the_file(command, tmp_path, capsys):
    from mcgw.cli import main

    run(scene(separations=np.linspace(0, 3, 25)), tmp_path / "a.h5", keep="statistics")
    output = tmp_path / (
        "a.html" if command == ["report"] else "a.png" if command == ["compare"] else "a.csv"
    )
    flag = [] if "--csv" in command else ["-o"]
    assert main([command[0], str(tmp_path / "a.h5"), *command[1:], *flag, str(output)]) == 0
    assert output.stat().st_size > 1000
    if command[0] == "show":
        assert "statistics alone" in capsys.readouterr().out
        assert "quantile_0.99" in output.read_text().splitlines()[0]


def numbers(path):
    lines = [line.split(",") for line in path.read_text().splitlines() if line[:1] not in ("#", "*", "%")]
    return np.array([[float(x) for x in line] for line in lines if line[0][:1] in "-0123456789"])


def test_tables_for_programs_are_those_of_the_surfaces(tmp_path):
    """Against the gap from the statistics of all surfaces, against pressure from the surfaces drawn again."""
    asked = scene(separations=np.linspace(0, 2, 33), film=mcgw.Film(resistivity=1 / 150 + 1 / 16))
    asked = asked.replace(quantities=["load", "conductance_si"])
    full, kept = mcgw.simulate(asked), mcgw.simulate(asked, keep="statistics")
    for table, tolerance in (("pressure-gap", 0.03), ("conductance-pressure", 1e-12)):
        for e, name in ((full, "full"), (kept, "kept")):
            mcgw.export(e, tmp_path / f"{name}.csv", to="moose", table=table, points=9)
        read = [numbers(tmp_path / f"{name}.csv") for name in ("full", "kept")]
        np.testing.assert_allclose(*read, rtol=1e-11)
        q05 = [numbers(tmp_path / f"{name}.q05.csv") for name in ("full", "kept")]
        np.testing.assert_allclose(*q05, rtol=tolerance)


@pytest.mark.usefixtures("small_blocks")
def test_time_ends_between_pieces_and_the_same_number_gives_the_same_bits():
    told = []
    asked = scene(n_surfaces=10**6, keep="statistics", max_seconds=1.0)
    e = mcgw.simulate(asked, progress=lambda done, _: told.append(done))
    assert 0 < e.n_surfaces < 10**6
    assert e.n_surfaces % 64 == 0
    assert told[-1] == e.n_surfaces
    assert len(told) > e.n_surfaces // 64
    assert_same_bits(e, mcgw.simulate(asked, max_seconds=None, n_surfaces=e.n_surfaces))


def test_a_block_takes_seconds_however_large_a_surface_is():
    from mcgw.sampling.samplers import sampler_of

    for n in (10, 10**5, 10**9):
        asked = scene(n_asperities=n, keep="statistics")
        sampler = sampler_of(asked)
        rows = summarising.block_rows(asked, sampler)
        assert 1 <= rows <= 2**20
        assert rows == 1 or rows * sampler.draws <= 1e9
