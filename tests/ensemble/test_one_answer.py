"""One answer at a load, wherever it is asked for, is the mean of specimens that are drawn here."""

import csv
import math

import numpy as np
import pytest
from oracles.inside import solved_pressures
from oracles.laws_of_one_depth import kogut_etsion
from oracles.scenes import scene_by

import mcgw
from mcgw.cli import main

FILM = {"conductivities": (150.0, 16.0), "film_resistance": 1e-7}
AIR = {"joint": mcgw.Joint(**FILM, gas="air", rms=2e-6)}
HARDNESS, POISSON = 4e9, 0.3  # first yield at (pi 0.577 H/(2 E*))^2 R
YIELDING = mcgw.KogutEtsion(hardness=HARDNESS, poisson=POISSON)
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
    "yielding, 2 contacts": ({"law": YIELDING}, 200, 2, 20_000),
    "yielding, 60 contacts": ({"law": YIELDING}, 200, 60, 20_000),
    "own radii, 60 contacts": ({}, 200, 60, 20_000),
    "own radii and yielding, 2 contacts": ({"law": YIELDING}, 200, 2, 20_000),
}
M0, M2, M4 = 1e-12, 4e-3, 8e7  # spectral moments of the surfaces with radii of their own


def summits(rng, shape):
    """Reduced heights of summits of a Gaussian surface, and the radii of their geometric mean curvatures, m.

    Nayak (1971): at a summit the mean curvature t has a density of exp(-3 t^2/(4 m4)) times the mean of
    t^2 - u over u <= t^2, exponential of mean 2 m4/3; the height is linear in t and Gaussian about it.
    """
    c = 2 * M4 / 3
    t = np.linspace(0, 9, 20_001) * np.sqrt(c)
    density = np.exp(-(t**2) / (2 * c)) * (t**2 + c * np.expm1(-(t**2) / c))
    share = np.concatenate([[0.0], np.cumsum(density[1:] + density[:-1])])
    mean, square = (float(density @ t**k / density.sum()) for k in (1, 2))
    own = np.interp(rng.random(shape) * share[-1], share, t)
    z = M2 / c * own + np.sqrt(M0 - M2**2 / c) * rng.standard_normal(shape)
    sigma = np.sqrt(M0 - M2**2 / c + (M2 / c) ** 2 * (square - mean**2))
    apart = np.full(shape, np.nan)  # t^2 less the product of the two principal curvatures
    while np.isnan(apart).any():
        u = -c * np.log1p(rng.random(shape) * np.expm1(-(own**2) / c))
        taken = np.isnan(apart) & (rng.random(shape) < 1 - u / own**2)
        apart = np.where(taken, u, apart)
    return (z - M2 / c * mean) / sigma, 1 / np.sqrt(own**2 - apart)


def hertz(d, critical):
    return d * np.sqrt(d), d


def specimens(scene, load, many, contacts):
    """Answers of specimens drawn anew, each at the separation where literal sums have the load."""
    x, rng, found = scene.surface, np.random.default_rng(20240607), []
    contact = hertz if scene.law.elastic else kogut_etsion
    for start in range(0, many, 2000):
        shape = min(2000, many - start), scene.n_asperities
        if scene.summits is None:
            s, r = rng.standard_normal(shape), np.full(shape, x.radius)
        else:
            s, r = summits(rng, shape)
        highest = np.argsort(-s, axis=1)[:, : 3 * contacts + 40]  # no others touch
        s, r = np.take_along_axis(s, highest, 1), np.take_along_axis(r, highest, 1)
        critical = (np.pi * 0.577 * HARDNESS / (2 * x.E_star)) ** 2 * r / x.sigma
        e = scene.grading(s) * 4 / 3 * x.E_star * np.sqrt(r) * x.sigma**1.5
        low, high = np.full((len(s), 1), -8.0), s.max(axis=1, keepdims=True)
        for _ in range(40):
            h = (low + high) / 2
            sums = (e * contact(np.maximum(s - h, 0.0), critical=critical)[0]).sum(1, keepdims=True)
            low, high = np.where(sums > load, h, low), np.where(sums > load, high, h)
        assert np.all(s.min(axis=1, keepdims=True) < low)
        d = np.maximum(s - low, 0.0)
        areas = np.pi * r * x.sigma * np.where(d > 0, contact(d, critical=critical)[1], 0.0)
        one = {"area": areas.sum(axis=1), "separation": low[:, 0]}
        if scene.law.elastic:
            stiffness = 2 * x.E_star * (scene.grading(s) * np.sqrt(r * x.sigma * d)).sum(axis=1)
            one["stiffness"] = 1 / (1 / stiffness + scene.compliance)
        if scene.film is not None:
            a = np.sqrt(r * x.sigma * d) + 1e-100
            spots = 1 / (scene.film.rho / (4 * a) + scene.film.film_resistance / (np.pi * a**2))
            joint = spots.sum(axis=1) / x.nominal_area + scene.filled(low[:, 0])
            one |= {"joint_conductance": joint, "thermal_resistance": 1 / (joint * x.nominal_area)}
        found.append(one)
    return {name: np.concatenate([each[name] for each in found]) for name in found[0]}


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_the_answer_is_one_and_the_mean_of_specimens(name, tmp_path):
    """|z| < 5: a false alarm in 1e6; 10 deviations would be seen. All ways agree as `same` says."""
    more, n, contacts, many = SCENES[name]
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", n / 3e8, "78.6 GPa")
    if "radii" in name:
        surface = mcgw.SpectralSurface(M0, M2, M4, n * 6 * np.pi * 3**0.5 * M2 / M4, "100 GPa")
    scene = scene_by(
        surface, separations=0.0, quantities=("load", "area", "stiffness"), n_asperities=n,
        n_surfaces=400, seed=5, **more,
    )  # fmt: skip
    h, surface = float(scene.heights.isf(np.array(contacts / n))), scene.surface
    scene = scene.replace(separations=(h, h - 0.5))
    pressure = float(scene.theory.mean("pressure", h))
    found = mcgw.solve(scene, pressure=pressure)
    drawn = specimens(scene, found.amount, many, math.ceil(contacts))
    for quantity, x in drawn.items():
        value = found.value[quantity]
        low, high = found.interval(quantity)
        own = 0.0 if np.isnan(low) else (high - low) / 4
        error = np.hypot(x.std(ddof=1) / np.sqrt(many), own) + 1e-6 * abs(value)
        assert abs(value - x.mean()) < 5 * error, quantity
        assert abs(value + 10 * error - x.mean()) > 5 * error  # it would be seen
        spread = np.sqrt(np.mean(((x - x.mean()) / x.std()) ** 4) - 1) / 2  # relative, of one surface
        error = x.std() * (spread * np.sqrt(1 / many + (own > 0) / scene.n_surfaces) + 2e-4)
        assert abs(found.std[quantity] - x.std(ddof=1)) < 5 * error, quantity

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
    if contacts >= 1:  # where the report has answers
        (first,) = solved_pressures(scene, [found.amount / scene.surface.nominal_area])
        assert first.amount == pytest.approx(found.amount, rel=1e-12)
        assert same(first.value["area"], "area")
