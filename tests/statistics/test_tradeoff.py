"""Speed and accuracy: prices are measured, needs are counted, and what is advised follows from both."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE
from oracles.inside import (
    WANTS,
    Rung,
    Task,
    Way,
    advise,
    of_one,
    sampled_ways,
    surfaces_for,
    wants_of,
    worst_of_values,
    worth,
)
from oracles.scenes import scene_by
from scipy.stats import kstwobign, norm

import analytic
import mcgw
from mcgw import tradeoff
from mcgw.sampling import asperities
from mcgw.statistics import measured_ways


@pytest.fixture(scope="module")
def scene():
    one = {"separations": (1.0,), "quantities": ("load",), "n_asperities": 2000, "n_surfaces": 200}
    return scene_by(surface=SURFACE, grading=analytic.Exponential(2.0), seed=1, **one)


@pytest.fixture(scope="module")
def study(scene):
    return tradeoff(scene, seconds=0.5)


def test_errors_of_a_real_study_are_those_of_theory(study):
    """Root mean squares of 16 repeats: within 5 of their standard errors of what theory expects."""
    spread = float(study.scene.theory.std("load", 1.0) / study.scene.theory.mean("load", 1.0))
    drawn = [p for p in study.points if p.want == "mean" and p.n_surfaces]
    assert {p.way for p in drawn} >= {"cells", "tail"}
    for p in drawn:
        expected = spread / math.sqrt(p.n_surfaces)
        assert abs(p.rms / expected - 1) < 5 / math.sqrt(2 * p.repeats)
        assert 0 < p.stderr < p.rms
        assert p.repeats >= 16
    assert not any(p.bias for p in study.points)


def test_each_way_states_what_it_can_give(study):
    given = {name: {way.want for way in study.ways if way.name == name} for name in ("theory", "exact law")}
    assert given == {
        "theory": {"mean", "std", "conductance"}, "exact law": {"quantile", "distribution", "conductance"}
    }  # fmt: skip
    assert wants_of("aggregate") == ("mean", "std")
    assert study.advice("mean", 1e-4).way.name == "theory"
    assert study.advice("mean", 1e-14).way is None  # a gap, not a number
    of_mean_surface = next(x.floor for x in study.ways if (x.name, x.want) == ("theory", "conductance"))
    assert 1e-6 < of_mean_surface < 1e-2  # its order is one over the number of contacts
    assert study.advice("values", 1e-6).way.floor < 1e-12
    assert len(study.table()) == 6 * len(WANTS)
    errors = {rung.n_surfaces: rung.drawn for rung in study.ladder if rung.name == "surfaces"}
    assert errors[100] == pytest.approx(10 * errors[10_000])
    assert "needs no surfaces" in study.sentence


def test_values_of_a_sampler_that_is_off_by_a_percent_are_found_out(scene, monkeypatch):
    """The companion: each sum over its asperities is 1.01 times as large."""
    assert max(worst_of_values(scene.replace(sampler=name), 4) for name in ("cells", "direct")) < 1e-12
    right = asperities.asperity_sums

    def wrong(*asked):
        return {name: 1.01 * x for name, x in right(*asked).items()}

    monkeypatch.setattr(asperities, "asperity_sums", wrong)
    assert worst_of_values(scene.replace(sampler="cells"), 4) == pytest.approx(0.01 / 1.01, rel=1e-9)


def test_points_and_prices_by_hand(scene):
    errors = iter([{"mean": x} for x in (0.1, -0.3, 0.2)])
    task = Task("tail", 4, lambda scene: None, lambda found: next(errors))
    for _ in range(3):
        task.run(scene)
    task.seconds[:] = [1.0, 5.0, 2.0]
    (p,) = task.points()
    squares = np.array([0.01, 0.09, 0.04])
    assert (p.seconds, p.repeats, p.bias) == (2.0, 3, 0.0)
    assert p.rms == pytest.approx(math.sqrt(squares.mean()))
    assert p.stderr == pytest.approx(squares.std() / (2 * p.rms * math.sqrt(3)))
    off = Task("tail", 4, lambda scene: None, lambda found: {"mean": 0.01, "distribution": 0.7})
    for _ in range(16):
        off.run(scene)
    assert [(p.want, p.bias) for p in off.points()] == [("mean", 0.01), ("distribution", 0.7)]
    sizes = (10, 110, 1010)
    straight = [replace(p, n_surfaces=n, seconds=1 + n / 20) for n in sizes]
    assert measured_ways._price(straight, 9.0) == pytest.approx((1.0, 0.05))
    flat = [replace(p, n_surfaces=n, seconds=2.0) for n in sizes]
    assert measured_ways._price(flat, 1e-3) == pytest.approx((2.0 - 0.001 * sum(sizes) / 3, 1e-3))
    assert measured_ways._price(flat, 1.0) == (0.0, 1.0)
    seconds = np.array([3.0, 6.5, 51.5])
    bent = [replace(p, n_surfaces=n, seconds=s) for n, s in zip(sizes, seconds, strict=True)]
    each, set_up = np.polyfit(sizes, seconds, 1, w=1 / seconds)  # nearest to all three in ratio
    assert measured_ways._price(bent, 9.0) == pytest.approx((set_up, each))


@pytest.mark.slow
@pytest.mark.parametrize(("count", "n_asperities"), [("fixed", 2000), ("poisson", 100)])
def test_a_target_is_1_96_standard_errors(scene, count, n_asperities):
    """Against the drawn scatter of 400 ensembles, to 15 %."""
    scene, n = scene.replace(count=count, n_asperities=n_asperities), 2000
    load = mcgw.simulate(scene, n_surfaces=400 * n).load[:, 0].reshape(400, n)
    for want, values in {
        "std": load.std(axis=1, ddof=1),
        "quantile": np.quantile(load, 0.99, axis=1),
    }.items():
        drawn = 1.96 * values.std() / values.mean() * math.sqrt(n)
        assert of_one(scene, want) == pytest.approx(drawn, rel=0.15)


def test_needs_are_those_of_theory(scene):
    """Of means to a sixteenth, as a rule of stopping counts them; 20 of 2000 lie beyond the quantile."""
    assert of_one(scene, "distribution") == pytest.approx(kstwobign.ppf(0.95), rel=1e-4)
    spread = float(scene.theory.std("load", 1.0) / scene.theory.mean("load", 1.0))
    plain = (norm.ppf(0.975) * spread / 1e-3) ** 2
    assert plain <= surfaces_for(scene, "mean", 1e-3) * 1.001 <= 1.08 * plain
    for want, target, n in (("mean", 1e-9, math.inf), ("std", 0.0, math.inf), ("quantile", 0.1, 2000)):
        assert surfaces_for(scene, want, target) == n
    assert surfaces_for(scene, "values", 1e-6) == scene.n_surfaces


def test_solve_draws_what_rel_err_asks_for(scene):
    """1.96 standard errors of every mean, as drawn: to 15 %, four of their own standard errors."""
    asked = {"pressure": "2 MPa", "n_surfaces": 10**6}
    found = mcgw.solve(scene, rel_err=0.004, **asked)
    n = found.surfaces["area"].size
    bounds = {x: 1.96 * y.std(ddof=1) / y.mean() / math.sqrt(n) for x, y in found.surfaces.items()}
    worst = max(bounds[x] for x in ("area", "stiffness", "conductance"))
    assert worst == pytest.approx(0.004, rel=0.15)
    assert (found.scene.rel_err, found.scene.n_surfaces) == (None, n)
    assert mcgw.solve(scene, rel_err={"load": 0.004}, **asked).surfaces["area"].size == 64  # it is given
    assert mcgw.solve(scene, rel_err=0.008, **asked).surfaces["area"].size < n / 2
    with pytest.warns(UserWarning, match=r"rel_err needs .* surfaces, and n_surfaces = 100"):
        mcgw.solve(scene, rel_err=0.004, pressure="2 MPa", n_surfaces=100)


def test_the_cheapest_way_that_is_good_enough(scene):
    ways = [
        Way("theory", "mean", 1e-13, 1e-3, 0.0), Way("cells", "mean", 0.0, 1e-5, 1e-9),
        Way("tail", "mean", 0.0, 0.9e-5, 1e-9), Way("aggregate", "mean", 1e-3, 0.0, 1e-10),
    ]  # fmt: skip
    names = [advise("mean", target, ways, scene).way.name for target in (1e-1, 1e-2, 1e-3, 1e-5)]
    assert names == ["aggregate", "aggregate", "cells", "theory"]
    assert advise("mean", 1e-5, ways, scene).n_surfaces == 0
    coarse = advise("mean", 1e-2, ways, scene)
    assert coarse.n_surfaces == surfaces_for(scene, "mean", 1e-2 - 1e-3)  # what the floor leaves
    assert coarse.seconds == pytest.approx(1e-10 * coarse.n_surfaces)
    assert advise("std", 1e-2, ways, scene).way is None


def test_auto_is_named_first(make_scene):
    assert sampled_ways(make_scene(n_asperities=100, separations=(2.0,)))[0] == "tail"
    assert sampled_ways(make_scene(separations=(0.0,)))[0] == "cells"
    radii = {"heights": analytic.Nayak(5.0), "summits": analytic.RandomCurvature(5.0), "grading": None}
    yields = make_scene(law=analytic.KogutEtsion(critical=0.1), **radii)
    assert sampled_ways(yields) == ["tail", "direct", "solve"]


def test_the_ladder_says_where_more_surfaces_do_not_help():
    surfaces = [Rung("surfaces", n, n / 10, 0.09 / math.sqrt(n), 0.03) for n in (10, 100, 1000)]
    formula = Rung("formula", 0, 2e-3, 1e-3, 0.03)
    told = worth((formula, *surfaces), "")
    assert told == "The model is off by 3 %; theory, 2 ms, is as good as any number of surfaces."
    told = worth((replace(formula, drawn=0.2), *surfaces), "")
    assert told == "The model is off by 3 %; more than 100 surfaces do not help."
    dear = Rung("boundary elements", 9, 200.0, 0.01, 0.0)
    assert worth((formula, dear), "").endswith("; `mcgw elastic` gets 1 % in 3.3 min.")
    assert "not known here: far off" in worth((replace(formula, model=math.nan),), "far off")


def test_what_is_typed_is_python_that_runs(scene, study):
    """Of every way that draws nothing, and of one that draws."""
    known = {"scene": scene, "mcgw": mcgw}
    for want in ("mean", "std", "quantile", "conductance"):
        assert eval(study.advice(want, 1e-5).code(study.scene, study.load), known) > 0
    drawn = study.advice("values", 1e-5).code(study.scene, study.load)
    assert eval(drawn, known).load.shape == (200, 1)
