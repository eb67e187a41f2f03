"""Speed and accuracy: prices are measured, needs are counted, and what is advised follows from both."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import (
    WANTS,
    Ladder,
    Needs,
    Rung,
    Task,
    Way,
    advise,
    sampled_ways,
    wants_of,
    worst_of_values,
)
from oracles.scenes import scene_by
from scipy.stats import kstwobign, norm

import analytic
import mcgw
from mcgw import tradeoff
from mcgw.sampling import samplers
from mcgw.statistics import measured_ways


@pytest.fixture(scope="module")
def scene():
    from conftest import SURFACE

    one = {"separations": (1.0,), "quantities": ("load",), "n_asperities": 2000, "n_surfaces": 200}
    return scene_by(surface=SURFACE, grading=analytic.Exponential(2.0), seed=1, **one)


@pytest.fixture(scope="module")
def study(scene):
    return tradeoff(scene, seconds=0.5)


# What was measured


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
    assert study.advice("values", 1e-6).way.floor < 1e-12
    assert len(study.table()) == 6 * len(WANTS)
    assert "needs no surfaces" in study.sentence


@pytest.mark.slow
def test_a_sampler_that_is_off_by_a_percent_is_not_advised(scene, monkeypatch):
    """The companion: its values, and with enough repeats its means, are found out."""
    right, ways = samplers._MAKERS["cells"], {}
    before = {name: worst_of_values(scene.replace(sampler=name), 4) for name in ("cells", "tail", "direct")}
    assert max(before.values()) < 1e-12

    def wrong(scene):
        sampler = right(scene)
        block = sampler.block

        def scaled(first, n):
            found = block(first, n)
            return replace(found, sums={name: 1.01 * x for name, x in found.sums.items()})

        object.__setattr__(sampler, "block", scaled)
        return sampler

    for name, maker in (("right", right), ("wrong", wrong)):
        monkeypatch.setitem(samplers._MAKERS, "cells", maker)
        off = worst_of_values(scene.replace(sampler="cells"), 4)
        made = [Way("cells", "values", off, 0.0, 1e-6), Way("tail", "values", 0.0, 0.0, 1e-4)]
        ways[name] = advise("values", 1e-3, made, Needs(scene)).way.name
    assert ways == {"right": "cells", "wrong": "tail"}
    answers = measured_ways.Answers(scene)
    task = answers.sampled("cells", 20_000)
    for number in range(16):
        task.run(measured_ways.moved(scene, number))
    bias = {p.want: p.bias for p in task.points()}
    assert bias["mean"] == pytest.approx(0.01, rel=0.1)
    assert bias["distribution"] > 0


def test_points_and_prices_by_hand(scene):
    errors = iter([{"mean": x} for x in (0.1, -0.3, 0.2)])
    task = Task("tail", 4, lambda scene: None, lambda found: next(errors))
    for _ in range(3):
        task.run(scene)
    task.seconds = [1.0, 5.0, 2.0]
    (p,) = task.points()
    squares = np.array([0.01, 0.09, 0.04])
    assert (p.seconds, p.repeats, p.bias) == (2.0, 3, 0.0)
    assert p.rms == pytest.approx(math.sqrt(squares.mean()))
    assert p.stderr == pytest.approx(squares.std() / (2 * p.rms * math.sqrt(3)))
    sizes = (10, 110, 1010)
    straight = [replace(p, n_surfaces=n, seconds=1 + n / 20) for n in sizes]
    assert measured_ways._price(straight, 9.0) == pytest.approx((1.0, 0.05))
    flat = [replace(p, n_surfaces=n, seconds=2.0) for n in sizes]
    assert measured_ways._price(flat, 1e-3) == pytest.approx((2.0 - 0.001 * sum(sizes) / 3, 1e-3))
    assert measured_ways._price(flat[:1], 9.0) == (0.0, 9.0)
    bent = [replace(p, n_surfaces=n, seconds=s) for n, s in ((10, 3.0), (110, 6.5), (1010, 51.5))]
    set_up, each = measured_ways._price(bent, 9.0)
    ratios = np.array([(set_up + each * q.n_surfaces) / q.seconds for q in bent])
    for change in (1e-3, -1e-3):  # no other line is nearer, in ratio, to all three
        for other in ((set_up * (1 + change), each), (set_up, each * (1 + change))):
            then = np.array([(other[0] + other[1] * q.n_surfaces) / q.seconds for q in bent])
            assert np.sum((then - 1) ** 2) > np.sum((ratios - 1) ** 2)


# What is needed


@pytest.mark.slow
def test_a_target_is_1_96_standard_errors(scene):
    """Against drawn scatter of 400 ensembles, to 15 %; of means by theory, to a sixteenth."""
    needs, n = Needs(scene), 2000
    load = mcgw.simulate(scene, n_surfaces=400 * n).load[:, 0].reshape(400, n)
    found = {"std": load.std(axis=1, ddof=1), "quantile": np.quantile(load, 0.99, axis=1)}
    for want, values in found.items():
        assert 1.96 * values.std() / values.mean() * math.sqrt(n) == pytest.approx(
            needs.of_one(want), rel=0.15
        )
    assert needs.of_one("distribution") == pytest.approx(kstwobign.ppf(0.95), rel=1e-4)
    spread = float(scene.theory.std("load", 1.0) / scene.theory.mean("load", 1.0))
    plain = (norm.ppf(0.975) * spread / 1e-3) ** 2
    assert plain <= needs.surfaces("mean", 1e-3) * 1.001 <= 1.08 * plain
    assert needs.surfaces("mean", 1e-9) == math.inf
    assert needs.surfaces("quantile", 0.1) == 2000  # 20 lie beyond
    assert needs.surfaces("values", 1e-6) == 200
    assert needs.surfaces("std", 0.0) == math.inf


@pytest.mark.slow
def test_poisson_numbers_widen_the_scatter_of_a_standard_deviation_as_drawn(scene):
    scene = scene.replace(count="poisson", n_asperities=100)
    load = mcgw.simulate(scene, n_surfaces=400_000).load[:, 0].reshape(400, 1000)
    std = load.std(axis=1, ddof=1)
    drawn = 1.96 * std.std() / std.mean() * math.sqrt(1000)
    assert drawn == pytest.approx(Needs(scene).of_one("std"), rel=0.15)


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


# What is advised


def way(name, want, floor, set_up, each=0.0):
    return Way(name, want, floor, set_up, each)


def test_the_cheapest_way_that_is_good_enough(scene):
    ways = [
        way("theory", "mean", 1e-13, 1e-3), way("cells", "mean", 0.0, 1e-5, 1e-9),
        way("tail", "mean", 0.0, 0.9e-5, 1e-9), way("aggregate", "mean", 1e-3, 0.0, 1e-10),
    ]  # fmt: skip
    needs = Needs(scene)
    names = [advise("mean", target, ways, needs).way.name for target in (1e-1, 1e-2, 1e-3, 1e-5)]
    assert names == ["aggregate", "aggregate", "cells", "theory"]
    coarse = advise("mean", 1e-2, ways, needs)
    assert coarse.n_surfaces == needs.surfaces("mean", 1e-2 - 1e-3)  # what the floor leaves
    assert coarse.seconds == pytest.approx(1e-10 * coarse.n_surfaces)
    assert advise("std", 1e-2, ways, needs).way is None


def test_auto_is_named_first(make_scene):
    few = make_scene(n_asperities=100, separations=(2.0,))
    assert sampled_ways(few)[0] == "tail"
    assert sampled_ways(make_scene(separations=(0.0,)))[0] == "cells"
    radii = {"heights": analytic.Nayak(5.0), "summits": analytic.RandomCurvature(5.0), "grading": None}
    assert "aggregate" not in sampled_ways(make_scene(**radii))
    yields = make_scene(law=analytic.KogutEtsion(critical=0.1), **radii)
    assert sampled_ways(yields) == ["tail", "direct", "solve"]


def test_the_ladder_says_where_more_surfaces_do_not_help():
    surfaces = [Rung("surfaces", n, n / 10, 0.09 / math.sqrt(n), 0.03) for n in (10, 100, 1000)]
    formula = Rung("formula", 0, 2e-3, 1e-3, 0.03)
    assert surfaces[0].whole == pytest.approx(math.hypot(0.09 / math.sqrt(10), 0.03))
    told = Ladder((formula, *surfaces), "").sentence
    assert told == "The model is off by 3 %; theory, 2 ms, is as good as any number of surfaces."
    told = Ladder((replace(formula, drawn=0.2), *surfaces), "").sentence
    assert told == "The model is off by 3 %; more than 100 surfaces do not help."
    dear = Rung("boundary elements", 9, 200.0, 0.01, 0.0)
    assert Ladder((formula, dear), "").sentence.endswith("; `mcgw elastic` gets 1 % in 3.3 min.")
    assert "not known here: far off" in Ladder((replace(formula, model=math.nan),), "far off").sentence


def test_what_is_typed_is_python_that_runs(scene, study):
    """Of every way that draws nothing, and of one that draws."""
    names = {"scene": scene, "mcgw": mcgw}
    for want in ("mean", "std", "quantile", "conductance"):
        code = study.advice(want, 1e-5).code(study.scene, study.load)
        assert eval(code, names) > 0
    assert eval(study.advice("values", 1e-5).code(study.scene, study.load), names).load.shape == (200, 1)
    with pytest.raises(ValueError, match="want = 'median': give one of mean, std"):
        study.plot(want="median")


def test_what_cannot_be_traded_off_is_refused(make_scene):
    with pytest.raises(ValueError, match="seconds = 0: give a finite number > 0"):
        tradeoff(make_scene(), seconds=0)
    with pytest.raises(ValueError, match=r"mean load at d/sigma = 60 is 0: a relative error needs"):
        tradeoff(make_scene(separations=(60.0,), grading=None))
    measured = make_scene(
        heights=analytic.MeasuredHeights([0.0, 1.0, 3.0]), n_asperities=3, n_surfaces=1, sampler="direct"
    )
    with pytest.raises(ValueError, match="measured heights are summed exactly"):
        tradeoff(measured)
