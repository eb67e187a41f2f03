"""The stop rule: it keeps its promise, it is known beforehand, and it does not wait for what cannot come."""

import numpy as np
import pytest
from oracles.inside import after, checkpoints, forecast, spread_of, upper_contacts

import analytic
import mcgw
from mcgw.cli import main
from mcgw.errors import StoreError

SEEDS = 2500


def test_forecast_is_where_every_interval_is_narrow_enough(make_scene):
    """And a sixteenth less is not: the number needed is that of the mean known least."""
    scene = make_scene(rel_err=0.02, n_surfaces=10**7, separations=(0.0, 1.5), n_asperities=300)
    expected = forecast(scene)
    for name in scene.quantities:
        reach = spread_of(scene, name).reach(expected.needed[name])
        np.testing.assert_allclose(reach, 0.02, rtol=1e-6)
    most = max(float(n.max()) for n in expected.needed.values())
    assert most <= expected.surfaces < most * 17 / 16 + 64
    variance = scene.theory.cumulants("load", [1.5])
    gaussian = (1.959964 / 0.02) ** 2 * variance.variance[0] / variance.mean[0] ** 2
    assert expected.needed["load"][1] == pytest.approx(gaussian, rel=0.05)


@pytest.mark.slow
def test_stopped_ensembles_cover(make_scene):
    """Homogeneous, h = 2, one ensemble cut into 2500: fewer than 0.93 cover by chance once in 4e5."""
    scene = make_scene(
        rel_err=0.1, n_surfaces=10**8, separations=(2.0,), grading=None, n_asperities=700,
        quantities=("load",),
    )  # fmt: skip
    n = forecast(scene).surfaces
    ensemble = mcgw.simulate(scene.replace(rel_err=None, n_surfaces=SEEDS * n))
    means = ensemble.load.reshape(SEEDS, n).mean(axis=1)
    exact = float(scene.theory.mean("load", 2.0))
    for number, enough in ((n, True), (16 * n, False)):  # the companion: a quarter of the width
        low, high = (means / end for end in spread_of(scene, "load").ratio(number)[::-1])
        assert (np.mean((low <= exact) & (exact <= high)) >= 0.93) == enough


@pytest.mark.slow
def test_rare_stiff_tips_are_waited_for(make_scene):
    """A modulus of 1e5 above 4.5 sigma, in one of a thousand surfaces.

    A look after 64 surfaces mostly sees the body alone, and that as well as asked.
    """
    tips = analytic.Table([-5.0, 4.5, 4.5 + 1e-6, 9.0], [1.0, 1.0, 1e5, 1e5])
    scene = make_scene(
        rel_err=0.1, n_surfaces=10**8, separations=(1.0,), grading=tips, n_asperities=300,
        quantities=("load",),
    )  # fmt: skip
    plain = scene.replace(grading=analytic.Homogeneous())
    body, exact = (float(x.theory.mean("load", 1.0)) for x in (plain, scene))
    assert 30 < exact / body < 40
    n = forecast(scene).surfaces
    assert n > 1e5
    assert n == pytest.approx(1.96**2 / 0.01 / (float(scene.heights.sf(np.array(4.5))) * 300), rel=1)
    low, high = mcgw.simulate(scene).interval("load")
    assert low[0] < exact < high[0]
    assert spread_of(plain, "load").reach(64)[0] < 0.1


def test_the_same_again_draws_nothing_and_a_wider_rule_keeps_what_is_there(make_scene, tmp_path):
    scene = make_scene(rel_err=0.05, n_surfaces=10**6, separations=(0.0,), n_asperities=10)
    wider, path = scene.replace(rel_err=0.1), tmp_path / "a.h5"
    n, first = mcgw.run(scene, path).n_surfaces, mcgw.simulate(scene)
    np.testing.assert_array_equal(mcgw.open_ensemble(path).load, first.load)
    assert mcgw.open_ensemble(path).scene == first.scene == scene.replace(rel_err=None, n_surfaces=n)
    assert mcgw.run(scene, tmp_path / "shares.h5", shard="1/1") == 0
    assert mcgw.merge(tmp_path / "shares.h5").n_surfaces == n
    before = path.stat().st_mtime_ns
    assert mcgw.run(scene, path).n_surfaces == n
    assert forecast(wider).surfaces < n
    assert mcgw.run(wider, path).n_surfaces == n
    assert path.stat().st_mtime_ns == before
    assert mcgw.run(scene.replace(rel_err=0.025), path).n_surfaces > 3 * n
    with pytest.raises(StoreError, match="different ensemble"):
        mcgw.run(scene.replace(seed=2), path)


def test_what_nothing_reaches_is_reported_and_what_may_come_is_waited_for(make_scene):
    """h = 4.5 has one contact in 98 surfaces: it takes (1.96/0.1)^2 = 384 of them."""
    scene = make_scene(rel_err=0.1, n_surfaces=10**4, separations=(0.0, 12.0))
    with pytest.warns(UserWarning, match=r"4 means need more surfaces than n_surfaces allows; "):
        ensemble = mcgw.simulate(scene)
    assert ensemble.n_surfaces == 64
    assert f"no contact in {ensemble.n_surfaces} surfaces" in after(ensemble, scene)[0]
    assert upper_contacts(100) == pytest.approx(-np.log(0.05) / 100, rel=1e-14)
    few = make_scene(rel_err=0.1, n_surfaces=10**7, separations=(4.5,), quantities=("contacts",))
    assert mcgw.simulate(few).contacts.sum() > 300


def test_means_without_a_wish_are_not_held_to_one(make_scene):
    """Neither where contacts are few nor where they are many: only what was asked is told."""
    scene = make_scene(n_surfaces=5, separations=(0.0, 2.0, 3.5), quantities=("load", "area"))
    wished = scene.replace(n_surfaces=10**9, rel_err={"load": [1e-6, np.inf, np.inf]})
    (told,) = after(mcgw.simulate(scene), wished)
    assert told.startswith("load at d/sigma = 0 has a relative error of ")
    assert told.endswith(", not 1e-06")
    (few,) = after(mcgw.simulate(scene), wished.replace(rel_err={"area": [np.inf, np.inf, 0.1]}))
    assert few == "area at d/sigma = 3.5: too few contacts"
    assert len(after(mcgw.simulate(scene), scene)) == 2  # of no wish, one that any interval keeps


def test_a_limit_too_low_is_said_in_one_line(make_scene, tmp_path, capsys):
    scene = make_scene(rel_err=0.01, n_surfaces=200, separations=(0.0, 3.0), n_asperities=300)
    assert forecast(scene).surfaces == 200
    assert ("load", 3.0) in forecast(scene).out_of_reach
    with pytest.warns(UserWarning, match="n_surfaces allows") as told:
        assert mcgw.simulate(scene).n_surfaces == 200
    assert told[0].filename == __file__  # where the user asked
    (tmp_path / "scene.toml").write_text(mcgw.scene_text(scene))
    assert main(["run", str(tmp_path / "scene.toml"), "-o", str(tmp_path / "a.h5")]) == 0
    assert capsys.readouterr().out.count("n_surfaces allows") == 1


def test_surfaces_that_all_agree_are_not_proof(make_scene):
    """One asperity that almost surely touches: the mean 0.99865 is not 1 to 1e-3 after 64 ones."""
    rule = {"rel_err": 1e-3, "n_surfaces": 10**5, "quantities": ("contacts",)}
    scene = make_scene(n_asperities=1, separations=(-3.0,), grading=analytic.Exponential(1.0), **rule)
    assert mcgw.simulate(scene).n_surfaces >= 2900


def test_time_ends_a_run(make_scene, tmp_path):
    scene = make_scene(n_surfaces=10**9, max_seconds=0.2)
    for asked in (scene, scene.replace(rel_err=1e-3)):
        assert 0 < mcgw.simulate(asked).n_surfaces < 10**8
    path = tmp_path / "a.h5"
    n = mcgw.run(scene.replace(n_surfaces=300_000), path).n_surfaces
    assert 64 <= n < 300_000
    assert mcgw.run(scene.replace(n_surfaces=300_000, max_seconds=1e-9), path).n_surfaces == n
    assert mcgw.run(scene.replace(n_surfaces=n + 5, max_seconds=600.0), path).n_surfaces == n + 5
    with pytest.raises(ValueError, match="max_seconds: the jobs of a run end at different times"):
        mcgw.run(scene, path, shard="1/2")


@pytest.fixture
def asked(make_scene):
    return lambda rel_err: make_scene(rel_err=rel_err, separations=(0.0, 1.0, 2.0), n_surfaces=10**9)


def test_each_quantity_may_have_its_own_number(asked):
    """What is asked of one quantity or separation alone is what one number for all asks of it."""
    needed = forecast(asked(1e-2)).needed
    one = forecast(asked({"load": "1 %"}))
    assert set(one.needed) == {"load"}
    np.testing.assert_array_equal(one.needed["load"], needed["load"])
    assert one.surfaces == next(n for n in checkpoints(10**9) if n >= needed["load"].max())
    two = forecast(asked({"load": [1e-2, np.inf, np.inf], "contacts": 5e-2}))
    np.testing.assert_array_equal(two.needed["load"], [needed["load"][0], 0, 0])
    np.testing.assert_array_equal(two.needed["contacts"], forecast(asked(5e-2)).needed["contacts"])


def test_means_are_known_as_well_as_each_was_asked(asked, tmp_path):
    scene = asked({"load": 2e-2, "contacts": [5e-3, np.inf, 1e-2]})
    for e in (mcgw.run(scene, tmp_path / "a.h5"), mcgw.simulate(scene, keep="statistics")):
        low, high = e.interval("load")
        assert np.all(np.maximum(high / e.mean("load") - 1, 1 - low / e.mean("load")) <= 2.1e-2)
        low, high = e.interval("contacts")
        reach = np.maximum(high / e.mean("contacts") - 1, 1 - low / e.mean("contacts"))
        assert reach[0] <= 5.2e-3
        assert reach[2] <= 1.05e-2
        assert after(e, scene) == []
        assert "until rel_err = load 0.02, contacts 0.005 at best" in str(scene)
        assert after(e, asked({"load": 1e-3}))[0].startswith("load at d/sigma = 0 has a relative error of")
