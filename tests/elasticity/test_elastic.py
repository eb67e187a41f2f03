"""Means by levels: from the lines of their file, and over lists of maps; what is refused."""

import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import LEVELS, Pressed, located
from oracles.rough import SPECTRUM, rough
from scipy.stats import t as student

import mcgw

pytestmark = pytest.mark.usefixtures("cheap")


@pytest.mark.slow
def test_is_what_its_solves_say(tmp_path):
    """Means and errors from the lines of the file: a pilot, and fresh maps for each term."""
    path = tmp_path / "s.jsonl"
    asked = {"pressure": 5e7, "E_star": 1e11, "solves": 5, "pilot": 6, "path": path}
    found = mcgw.elastic(SPECTRUM, quantities=["mean_gap", "area"], **asked)
    _, *rows = map(json.loads, path.read_text().splitlines())
    names = [level.name for level in LEVELS]
    by = {(row["level"], row["map"]): row for row in rows}
    assert len(by) == len(rows)
    assert [(row["level"], row["map"]) for row in rows[:18]] == [(n, k) for k in range(6) for n in names]
    used = [names[level] for level in found.planned.chain]
    assert used[-1] == "elastic"
    first, means, variances, parts = 6, [], [], []
    terms = [used[:1], *([b, a] for a, b in pairwise(used))]
    for term, many in zip(terms, found.planned.maps, strict=True):
        maps = range(first, first + many)
        first += many
        x = np.array([[by[term[0], k]["values"][q] for q in found.quantities] for k in maps])
        for other in term[1:]:
            x -= [[by[other, k]["values"][q] for q in found.quantities] for k in maps]
        means.append(x.mean(axis=0))
        variances.append(x.var(axis=0, ddof=1) / many)
        parts.append(variances[-1] ** 2 / (many - 1))
    assert max(k for _, k in by) == first - 1
    degrees = sum(variances) ** 2 / sum(parts)
    assert_allclose(found.found.mean, sum(means), rtol=1e-12)
    assert_allclose(found.found.degrees, degrees, rtol=1e-9)
    assert found.mean("area") == pytest.approx(sum(means)[1], rel=1e-12)
    half = student.ppf(0.95, degrees[1]) * math.sqrt(sum(variances)[1])
    assert_allclose(found.interval("area", 0.9), sum(means)[1] + np.array([-half, half]), rtol=1e-9)
    assert found.seconds == pytest.approx(sum(row["seconds"] for row in rows))
    other = mcgw.elastic(SPECTRUM, quantities=["area"], seed=2, **{**asked, "path": None})
    assert other.mean("area") != found.mean("area")


@pytest.mark.parametrize(("maps", "solves"), [(1, None), (5, 4), (7, None)])
def test_equal_maps_leave_no_error(maps, solves, rng):
    """Variances are exactly zero, though the mean of some equal numbers is not one of them."""
    one = rough(rng)
    found = mcgw.elastic([one] * maps, pressure=5e7, E_star=1e11, solves=solves)
    heights = one.heights - one.heights.mean()
    truth = located(Pressed(heights, one.size, 1e11, 5e7))["area"]
    assert_allclose(found.interval("area"), 1.25 * truth, rtol=1e-12)
    assert (found.planned.chain, found.planned.maps, found.saved) == ((2,), (4,), 1.0)


def test_takes_a_separation(rng):
    """The mean of a list, all of whose maps are solved, is theirs; one of five is clear of the plane."""
    maps = [rough(rng) for _ in range(4)]
    maps.append(replace(maps[0], heights=0.01 * maps[0].heights))
    found = mcgw.elastic(maps, separation="1 um", E_star=1e11, solves=5, pilot=5)
    pressures = [
        1.25 * located(Pressed(x.heights - x.heights.mean(), x.size, 1e11, separation=1e-6))["pressure"]
        for x in maps
    ]
    assert pressures[-1] == 0
    assert found.mean("pressure") == pytest.approx(np.mean(pressures), rel=1e-12)
    with pytest.raises(mcgw.RunError, match="smaller separation"):
        mcgw.elastic(maps, separation="1 mm", E_star=1e11)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"E_star": None}, "E_star: give"),
        ({"quantities": []}, "area, stiffness"),
        ({"quantities": ["pressure"]}, "mean_gap"),
        ({"pressure": None, "separation": 1e-6, "quantities": ["mean_gap"]}, "pressure"),
        ({"pressure": None}, "one of the two"),
        ({"separation": 1e-6}, "one of the two"),
        ({"pressure": None, "separation": -1e-6}, "separation = -1e-06"),
        ({"rel_err": 1}, "rel_err = 1,"),
        ({"solves": 3}, "solves = 3: .*4 or more"),
        ({"pilot": 3}, "pilot = 3, .*4 or more"),
        ({"seed": -1}, "seed = -1: give"),
    ],
)
def test_refuses(changes, words):
    with pytest.raises(ValueError, match=words):
        mcgw.elastic(SPECTRUM, **{"pressure": 5e7, "E_star": 1e11, **changes})
