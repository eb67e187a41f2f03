"""One answer at a load, wherever it is asked for, is the mean of specimens that are drawn here."""

import csv

import numpy as np
import pytest
from scipy.stats import norm

import mcgw
from mcgw.cli import main
from mcgw.reports.report_figures import solved_pressures

FILM = mcgw.Film(conductivities=(150.0, 16.0), film_resistance=1e-7)
AIR = {"film": FILM, "joint": mcgw.Joint("air", rms=2e-6)}
BODY = {"interaction": {"reference": "body"}}
# What the scene has besides, asperities, contacts of the mean surface, specimens drawn here.
SCENES = {
    "Hertz, 0.06 contacts": ({}, 200, 0.06, 20_000),
    "Hertz, 2 contacts": ({}, 200, 2, 20_000),
    "Hertz, 60 contacts": ({}, 200, 60, 20_000),
    "Hertz, 3000 contacts": ({}, 10_000, 3000, 400),
    "graded, 2 contacts": ({"grading": mcgw.Exponential(2.0)}, 200, 2, 20_000),
    "interaction, 2 contacts": (BODY, 200, 2, 20_000),
    "interaction, 60 contacts": (BODY, 200, 60, 20_000),
    "film and gas, 0.06 contacts": (AIR, 200, 0.06, 20_000),
    "film and gas, 2 contacts": (AIR, 200, 2, 20_000),
    "film and gas, 60 contacts": (AIR, 200, 60, 20_000),
}


def specimens(scene, load, many):
    """Answers of specimens drawn anew, each at the separation where literal sums have the load."""
    x, rng, found = scene.surface, np.random.default_rng(20240607), []
    for start in range(0, many, 2000):
        s = rng.standard_normal((min(2000, many - start), scene.n_asperities))
        e = scene.grading(s)
        low, high = np.full((len(s), 1), -8.0), s.max(axis=1, keepdims=True)
        for _ in range(48):
            h = (low + high) / 2
            d = np.maximum(s - h, 0.0)
            sums = (
                4 / 3 * x.E_star * x.radius**0.5 * x.sigma**1.5 * (e * d * np.sqrt(d)).sum(1, keepdims=True)
            )
            low, high = np.where(sums > load, h, low), np.where(sums > load, high, h)
        d = x.sigma * np.maximum(s - high, 0.0)
        stiffness = 2 * x.E_star * (e * np.sqrt(x.radius * d)).sum(axis=1)
        one = {"area": np.pi * x.radius * d.sum(axis=1), "separation": high[:, 0]}
        one["stiffness"] = 1 / (1 / stiffness + scene.compliance)
        if scene.film is not None:
            a = np.sqrt(x.radius * d) + 1e-100
            spots = 1 / (scene.film.rho / (4 * a) + scene.film.film_resistance / (np.pi * a**2))
            joint = spots.sum(axis=1) / x.nominal_area + scene.filled(high[:, 0])
            one |= {"joint_conductance": joint, "thermal_resistance": 1 / (joint * x.nominal_area)}
        found.append(one)
    return {name: np.concatenate([each[name] for each in found]) for name in found[0]}


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_the_answer_is_one_and_the_mean_of_specimens(name, tmp_path):
    """|z| < 5: a false alarm in 1e6; 10 deviations would be seen. All ways agree as `same` says."""
    more, n, contacts, many = SCENES[name]
    h = float(norm.isf(contacts / n))
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", n / 3e8, "78.6 GPa")
    scene = mcgw.Scene(
        surface, separations=(h, h - 0.5), quantities=("load", "area", "stiffness"), n_asperities=n,
        n_surfaces=400, seed=5, **more,
    )  # fmt: skip
    pressure = float(scene.theory.mean("pressure", h))
    found = mcgw.solve(scene, pressure=pressure)
    drawn = specimens(scene, found.amount, many)
    for quantity, x in drawn.items():
        value = found.value[quantity]
        low, high = found.interval(quantity)
        own = 0.0 if np.isnan(low) else (high - low) / 4
        error = np.hypot(x.std(ddof=1) / np.sqrt(many), own) + 1e-6 * abs(value)
        assert abs(value - x.mean()) < 5 * error, quantity
        assert abs(value + 10 * error - x.mean()) > 5 * error  # it would be seen

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
    if contacts >= 1:  # the report begins with the pressures of one contact
        first = solved_pressures(scene)[0]
        assert first.amount == pytest.approx(found.amount, rel=1e-12)
        assert first.value["area"] == pytest.approx(found.value["area"], rel=1e-9)
