"""One answer at a load, wherever it is asked for, is the mean of specimens that are drawn here."""

import csv
import math

import numpy as np
import pytest
from oracles.inside import solved_pressures
from oracles.laws_of_one_depth import kogut_etsion
from oracles.scenes import scene_by
from scipy import stats

import mcgw
from mcgw.cli import main

FILM = {"conductivities": (150.0, 16.0), "film_resistance": 1e-7}
AIR = {"joint": mcgw.Joint(**FILM, gas="air", rms=2e-6)}
HARDNESS, POISSON = 4e9, 0.3  # first yield at (pi 0.577 H/(2 E*))^2 R
YIELDING = mcgw.KogutEtsion(hardness=HARDNESS, poisson=POISSON)
BODY = {"interaction": {"reference": "body"}}
# What the scene has besides, asperities, contacts of the mean surface, specimens drawn here.
QUICK = {
    "Hertz, two asperities": ({}, 2, 0.3, 20_000),
    "Hertz, 2 contacts": ({}, 100, 2, 4000),
    "Poisson, 20 contacts": ({"count": "poisson"}, 100, 20, 2000),
    "graded, 2 contacts": ({"grading": mcgw.Exponential(0.5)}, 100, 2, 4000),
    "yielding, 10 contacts": ({"law": YIELDING}, 60, 10, 1000),
}
HEAVY = {"heavy tails, 2 contacts": ({"heights": stats.t(4)}, 100, 2, 4000)}
SCENES = {
    "Hertz, 0.06 contacts": ({}, 200, 0.06, 20_000),
    "Hertz, 3000 contacts": ({}, 10_000, 3000, 400),
    "interaction, 2 contacts": (BODY, 200, 2, 20_000),
    "film and gas, 0.06 contacts": (AIR, 200, 0.06, 20_000),
    "film and gas, 60 contacts": (AIR, 200, 60, 20_000),
    "yielding, 2 contacts": ({"law": YIELDING}, 200, 2, 20_000),
}


def hertz(d, critical):
    return d * np.sqrt(d), d


def specimens(scene, load, many, contacts):
    """Answers of specimens drawn anew, each at the separation where literal sums have the load."""
    x, rng, found = scene.surface, np.random.default_rng(20240607), []
    contact = hertz if scene.law.elastic else kogut_etsion
    heights = getattr(scene.heights, "distribution", stats.norm())
    for start in range(0, many, 2000):
        shape = min(2000, many - start), scene.n_asperities
        s, r = (heights.rvs(shape, random_state=rng) - heights.mean()) / heights.std(), x.radius
        if scene.count == "poisson":  # twice as many, of which those beyond the number are not there
            s = np.hstack([s, rng.standard_normal(shape)])
            s[np.arange(s.shape[1]) >= rng.poisson(shape[1], shape[0])[:, None]] = -99.0
        s = -np.sort(-s, axis=1)[:, : 3 * contacts + 40]  # no others touch
        critical = (np.pi * 0.577 * HARDNESS / (2 * x.E_star)) ** 2 * r / x.sigma
        e = scene.grading(s) * 4 / 3 * x.E_star * np.sqrt(r) * x.sigma**1.5
        low, high = np.full((len(s), 1), -8.0), s.max(axis=1, keepdims=True)
        for _ in range(40):
            h = (low + high) / 2
            sums = (e * contact(np.maximum(s - h, 0.0), critical=critical)[0]).sum(1, keepdims=True)
            low, high = np.where(sums > load, h, low), np.where(sums > load, high, h)
        assert s.shape[1] == shape[1] or np.all(s.min(axis=1, keepdims=True) < low)
        d = np.maximum(s - low, 0.0)
        areas = np.pi * r * x.sigma * np.where(d > 0, contact(d, critical=critical)[1], 0.0)
        one = {"area": areas.sum(axis=1), "separation": low[:, 0], "contacts": (d > 0).sum(axis=1)}
        if not scene.law.elastic:
            one["yielded"] = (d >= critical).sum(axis=1)
        else:
            stiffness = 2 * x.E_star * (scene.grading(s) * np.sqrt(r * x.sigma * d)).sum(axis=1)
            one["stiffness"] = 1 / (1 / stiffness + scene.theory.compliance * scene.surface.sigma)
        if scene.film is not None:
            a = np.sqrt(r * x.sigma * d) + 1e-100
            spots = 1 / (scene.film.rho / (4 * a) + scene.film.film_resistance / (np.pi * a**2))
            joint = spots.sum(axis=1) / x.nominal_area + scene.filled(low[:, 0])
            one |= {"joint_conductance": joint, "thermal_resistance": 1 / (joint * x.nominal_area)}
        found.append(one)
    return {name: np.concatenate([each[name] for each in found]) for name in found[0]}


def asked(name):
    """The scene of a name, its answer at the load of its mean surface, and those of specimens."""
    more, n, contacts, many = {**QUICK, **HEAVY, **SCENES}[name]
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", n / 3e8, "78.6 GPa")
    scene = scene_by(
        surface, separations=0.0, quantities=("load", "area", "stiffness"), n_asperities=n,
        n_surfaces=400, seed=5, **more,
    )  # fmt: skip
    h = float(scene.heights.isf(np.array(contacts / n)))
    scene = scene.replace(separations=(h, h - 0.5))
    found = mcgw.solve(scene, pressure=float(scene.theory.mean("pressure", h)))
    return scene, found, specimens(scene, found.amount, many, math.ceil(contacts))


def hold(found, drawn):
    """Means and standard deviations are those of the specimens: |z| < 5, a false alarm in 1e6."""
    for quantity, x in drawn.items():
        value = found.value[quantity]
        low, high = found.interval(quantity)
        own, many = 0.0 if np.isnan(low) else (high - low) / 4, len(x)
        error = np.hypot(x.std(ddof=1) / np.sqrt(many), own) + 1e-6 * abs(value)
        assert abs(value - x.mean()) < 5 * error, quantity
        kurtosis = np.mean(((x - x.mean()) / (x.std() or 1.0)) ** 4)
        spread = np.sqrt(max(kurtosis - 1, 0)) / 2  # relative, of one surface
        error = x.std() * (spread * np.sqrt(1 / many + (own > 0) / found.scene.n_surfaces) + 2e-4)
        assert abs(found.std[quantity] - x.std(ddof=1)) < 5 * error + 1e-5 * abs(value), quantity


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in HEAVY)])
def test_the_answer_is_the_mean_of_specimens_and_exact(name):
    _, found, drawn = asked(name)
    hold(found, drawn)
    for quantity in drawn:
        assert found.interval(quantity) == (found.value[quantity],) * 2


def test_of_one_asperity_alone():
    """Surfaces are drawn: the load of each is that of one contact, as are its area and approach."""
    surface = mcgw.Surface("1 um", "10 um", "1000/mm^2", 1e-9, "100 GPa")
    found = mcgw.solve(mcgw.Scene(surface, separations=0.0, n_surfaces=200, seed=4), load=1e-3)
    depth = (1e-3 / (4 / 3 * surface.E_star * np.sqrt(surface.radius))) ** (2 / 3)
    assert found.value["area"] == pytest.approx(np.pi * surface.radius * depth, rel=1e-9)
    assert found.std["area"] == pytest.approx(0, abs=1e-9 * found.value["area"])
    assert found.std["separation"] == pytest.approx(1, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_the_answer_is_one_wherever_it_is_asked_for(name, tmp_path):
    scene, found, drawn = asked(name)
    hold(found, drawn)
    pressure, surface = found.amount / scene.surface.nominal_area, scene.surface

    def same(value, quantity):
        """To rounding; what is a mean of drawn surfaces, to five of its errors: others may be drawn."""
        low, high = found.interval(quantity)
        error = 0.0 if np.isnan(low) else (high - low) / 4
        off = 5 * np.hypot(error, error) + 1e-8 * abs(found.value[quantity])
        return abs(value - found.value[quantity]) <= off

    several = mcgw.solve(scene, pressure=[2 * pressure, pressure, 4 * pressure])[1]
    for quantity in drawn:
        assert same(several.value[quantity], quantity)
    (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
    words = ["solve", tmp_path / "s.toml", "--pressure", repr(pressure), "--csv", tmp_path / "s.csv"]
    assert main([str(word) for word in words]) == 0
    with open(tmp_path / "s.csv", newline="") as file:
        rows = {row["quantity"]: row for row in csv.DictReader(x for x in file if x[0] != "#")}
    for quantity in drawn:
        assert float(rows[quantity]["value"]) == pytest.approx(found.value[quantity], rel=1e-9)  # as one load
    table, quantity, per = "stiffness-pressure", "stiffness", surface.nominal_area
    if scene.film is not None:
        table, quantity, per = "conductance-pressure", "joint_conductance", 1.0
    path, *_ = mcgw.export(
        scene, tmp_path / "t.txt", to="comsol", table=table, pressures=[pressure, 2 * pressure], quantiles=[]
    )
    exported = np.loadtxt(path, comments="%")
    row = exported[np.argmin(np.abs(exported[:, 0] - pressure))]
    assert same(row[1] * per, quantity)
    if scene.theory.mean("contacts", scene.separations[0]) >= 1:  # where the report has answers
        (first,) = solved_pressures(scene, [pressure])
        assert first.amount == pytest.approx(found.amount, rel=1e-12)
        assert same(first.value["area"], "area")
