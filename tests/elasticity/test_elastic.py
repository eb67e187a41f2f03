"""Means by levels: from the lines of their file, and over lists of maps; what is refused."""

import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import LEVELS, Level, Pressed, located
from oracles.rough import SPECTRUM, rough
from scipy.stats import t as student

import mcgw
from mcgw.elasticity import elastic as public

pytestmark = pytest.mark.usefixtures("cheap")


@pytest.mark.slow
def test_is_what_its_solves_say(tmp_path):
    """Means, errors, table and cost from the lines of the file: a pilot, and fresh maps for each term."""
    path = tmp_path / "s.jsonl"
    asked = {"pressure": 5e7, "E_star": 1e11, "solves": 5, "pilot": 6, "path": path}
    found = mcgw.elastic(SPECTRUM, quantities=["mean_gap", "area"], **asked)
    _, *rows = map(json.loads, path.read_text().splitlines())
    names = [level.name for level in LEVELS]
    by = {(row["level"], row["map"]): row for row in rows}
    assert len(by) == len(rows)
    assert [(row["level"], row["map"]) for row in rows[:18]] == [(n, k) for k in range(6) for n in names]
    cost = {n: np.mean([by[n, k]["seconds"] for k in range(6)]) for n in names}
    used = [names[level] for level in found.planned.chain]
    assert used[-1] == "elastic"
    first, means, variances, parts = 6, [], [], []
    shown = zip(*(column.values for column in found.levels.columns), strict=True)
    terms = [used[:1], *([b, a] for a, b in pairwise(used))]
    for term, many in zip(terms, found.planned.maps, strict=True):
        maps = range(first, first + many)
        first += many
        x = np.array([[by[term[0], k]["values"][q] for q in found.quantities] for k in maps])
        for other in term[1:]:
            x -= [[by[other, k]["values"][q] for q in found.quantities] for k in maps]
        _, number, seconds, mean, std = next(shown)
        assert number == many
        assert seconds == pytest.approx(sum(cost[n] for n in term))
        assert (mean, std) == pytest.approx((x[:, 0].mean(), x[:, 0].std(ddof=1)), rel=1e-9)
        means.append(x.mean(axis=0))
        variances.append(x.var(axis=0, ddof=1) / many)
        parts.append(variances[-1] ** 2 / (many - 1))
    assert next(shown, None) is None
    assert max(k for _, k in by) == first - 1
    degrees = sum(variances) ** 2 / sum(parts)
    assert_allclose(found.found.mean, sum(means), rtol=1e-12)
    assert_allclose(found.found.degrees, degrees, rtol=1e-9)
    assert found.mean("area") == pytest.approx(sum(means)[1], rel=1e-12)
    half = student.ppf(0.95, degrees[1]) * math.sqrt(sum(variances)[1])
    assert_allclose(found.interval("area", 0.9), sum(means)[1] + np.array([-half, half]), rtol=1e-9)
    low, high = found.interval("mean_gap")
    assert high - low == pytest.approx(
        2 * student.ppf(0.975, degrees[0]) * math.sqrt(sum(variances)[0]), rel=1e-9
    )
    assert found.seconds == pytest.approx(sum(row["seconds"] for row in rows))
    words = ["summits, independent", "summits, located", "stand-in"]
    used = [words[level] for level in found.planned.chain]
    assert found.levels.columns[0].values == [used[0], *(f"{b} - {a}" for a, b in pairwise(used))]
    other = mcgw.elastic(SPECTRUM, quantities=["area"], seed=2, **{**asked, "path": None})
    assert other.mean("area") != found.mean("area")


@pytest.mark.parametrize("solves", [None, 4])
@pytest.mark.parametrize("maps", [1, 2, 5, 7])
def test_equal_maps_leave_no_error(maps, solves, rng):
    """Variances are exactly zero, though the mean of some equal numbers is not one of them."""
    one = rough(rng)
    found = mcgw.elastic([one] * maps, pressure=5e7, E_star=1e11, solves=solves)
    heights = one.heights - one.heights.mean()
    truth = located(Pressed(heights, one.size, 1e11, 5e7))["area"]
    assert_allclose(found.interval("area"), 1.25 * truth, rtol=1e-12)
    assert (found.planned.chain, found.planned.maps, found.saved) == ((2,), (4,), 1.0)


def test_takes_a_separation(rng, monkeypatch):
    """The mean of a list, all of whose maps are solved, is theirs; one of five is clear of the plane."""
    maps = [rough(rng) for _ in range(4)]
    maps.append(replace(maps[0], heights=0.01 * maps[0].heights))
    found = mcgw.elastic(maps, separation="1 um", E_star=1e11, solves=5, pilot=5)
    pressures = [
        1.25 * located(Pressed(x.heights - x.heights.mean(), x.size, 1e11, separation=1e-6))["pressure"]
        for x in maps
    ]
    assert pressures[-1] == 0
    assert found.quantities == ("area", "stiffness", "conductance", "pressure")
    assert found.mean("pressure") == pytest.approx(np.mean(pressures), rel=1e-12)
    assert "Pa" in str(found)
    with pytest.raises(mcgw.RunError, match="smaller separation"):
        mcgw.elastic(maps, separation="1 mm", E_star=1e11)
    apart = Level("elastic", "stand-in", lambda pressed: dict.fromkeys(located(pressed), 0.0), 1.0)
    monkeypatch.setattr(public, "LEVELS", (*LEVELS[:2], apart))  # the dearest level decides
    with pytest.raises(mcgw.RunError, match="none of 5 maps touches"):
        mcgw.elastic(maps, separation="1 um", E_star=1e11)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"E_star": None}, "E_star: give"),
        ({"quantities": []}, "area, stiffness"),
        ({"quantities": ["area", "load"]}, "area, stiffness"),
        ({"quantities": ["pressure"]}, "mean_gap"),
        ({"pressure": None, "separation": 1e-6, "quantities": ["mean_gap"]}, "pressure"),
        ({"pressure": None}, "one of the two"),
        ({"separation": 1e-6}, "one of the two"),
        ({"pressure": None, "separation": -1e-6}, "separation = -1e-06"),
        *(({"rel_err": x}, f"rel_err = {x},") for x in (2, 1, 0)),
        ({"solves": 3}, "solves = 3: .*4 or more"),
        ({"pilot": 1}, "4 or more"),
        ({"pilot": 3}, "pilot = 3, .*4 or more"),
        ({"seed": -1}, "seed = -1: give"),
    ],
)
def test_refuses(changes, words):
    with pytest.raises(ValueError, match=words):
        mcgw.elastic(SPECTRUM, **{"pressure": 5e7, "E_star": 1e11, **changes})


def test_a_scene_without_a_spectrum_is_told():
    scene = mcgw.Scene(mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9), separations=0.0, seed=1)
    with pytest.raises(ValueError, match="m0, m2, m4"):
        mcgw.elastic(scene, pressure=1e6)
