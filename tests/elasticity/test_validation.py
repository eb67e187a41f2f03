"""Models against boundary elements: what users are told follows from the solves, and the models are these."""

import csv
import hashlib
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mcgw
from mcgw.maps import Topography
from mcgw.validity import error_table

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "runs" / "validation"
CONDENSED = ROOT / "mcgw" / "validity" / "table.csv"

sys.path.insert(0, str(FOLDER))

import charted  # noqa: E402
import conductance  # noqa: E402
import deviations  # noqa: E402
import fitted_maps  # noqa: E402
import models  # noqa: E402
import solve_table  # noqa: E402

sys.path.remove(str(FOLDER))

ROWS = solve_table.read()


def table():
    lines = CONDENSED.read_text().splitlines()
    head = [line for line in lines if line.startswith("#")]
    return head, list(csv.DictReader(lines[len(head) :]))


def rows_of(kind, x, purposes=("study", "caps")):
    return [row for row in ROWS if (row["kind"], row["x"]) == (kind, x) and row["purpose"] in purposes]


def test_the_table_holds_every_solve_it_counts():
    head, lines = table()
    assert hashlib.sha256(solve_table.PATH.read_bytes()).hexdigest()[:16] in " ".join(head)
    assert tuple(lines[0]) == deviations.COLUMNS
    lines = [line for line in lines if line["maps"] != "0"]  # the others are of theory
    assert min(int(line["maps"]) for line in lines) >= 3
    maps = {(x["map"], float(x["x"]), float(x["p"])): int(x["maps"]) for x in lines}
    counted = [row for row in ROWS if row["purpose"] in ("study", "caps")]
    assert sum(maps.values()) == len(counted)
    assert {key[1] for key in maps if key[0] == "gaussian"} == {2, 3, 5, 7, 10, 20, 50, 100}
    assert {key[1] for key in maps if key[0] == "caps"} == {0.002, 0.006, 0.02, 0.06, 0.2}


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "x", "p"), [("gaussian", 100.0, 1e-3), ("caps", 0.06, 1e-2)])
def test_the_table_is_made_of_the_solves(kind, x, p):
    found = deviations.condensed([row for row in rows_of(kind, x) if row["p"] == p])
    text = deviations.table_text(found, b"", 0).splitlines()
    text = text[text.index(",".join(deviations.COLUMNS)) + 1 :]
    assert len(text) == (9 if kind == "gaussian" else 3)
    assert set(text) <= set(CONDENSED.read_text().splitlines())


def test_conductance_is_as_far_off_as_stiffness():
    """Barber's relation, by sums over a grid of heights; at alpha = 5 the neighbours are half of all."""
    row = next(row for row in rows_of("gaussian", 5.0) if row["p"] == 0.1)
    alone, beside = conductance.errors(row)
    stiffness = {
        one.interaction: one.stiffness for one in deviations.deviations(row) if one.model == "own radii"
    }
    assert alone == pytest.approx(stiffness["none"], abs=1e-3)
    assert beside == pytest.approx(stiffness["summits"], abs=2e-3)
    assert alone < -0.45
    assert abs(beside) < 0.06


def test_the_solver_finds_hertz_and_the_square_lattice():
    """One paraboloid a cell: its area, and its gap, which images raise by 1.2415 p."""
    pytest.importorskip("tamaas")
    sys.path.insert(0, str(FOLDER))
    try:
        from boundary_elements import Solver
    finally:
        sys.path.remove(str(FOLDER))
    radius, n, p = 0.5, 256, 2e-3
    x = np.arange(n) / n - 0.5
    z = -(x[:, None] ** 2 + x**2) / (2 * radius)
    found = Solver(z, 1e-9).at(p)
    a = (3 * p * radius / 4) ** (1 / 3)
    plane = found.gap + z.mean()
    assert found.spots == 1
    assert found.area == pytest.approx(math.pi * a**2, rel=0.02)
    assert plane == pytest.approx(-(a**2) / radius + models.SQUARE_LATTICE * p, abs=2e-3 * a**2 / radius)
    compliance = 1 / (2 * (3 * 1.01 * p * radius / 4) ** (1 / 3)) - models.SQUARE_LATTICE
    assert found.stiffness == pytest.approx(1 / compliance, rel=5e-3)
    assert abs(plane + a**2 / radius) > 0.02 * a**2 / radius  # without images it would be seen


@pytest.mark.slow
def test_fresh_maps_are_as_the_table_says():
    """Where a model calls itself within 10 %, maps of other seeds, alpha and H are, but for their scatter."""
    fresh = [row for row in ROWS if row["purpose"] == "fresh"]
    assert {(row["hurst"], row["x"]) for row in fresh} >= {(h, a) for h in (0.5, 1.0) for a in (3, 7, 15)}
    _, lines = table()
    chart = [
        deviations.Condensed(
            x["map"], x["model"], x["interaction"], float(x["x"]), float(x["p"]),
            {q: float(x[q]) for q in deviations.QUANTITIES},
            {q: float(x[f"{q}_std"]) for q in deviations.QUANTITIES},
            int(x["maps"]), float(x["contacts"]), float(x["waves"]),
        )
        for x in lines
        if int(x["maps"])  # the others are by theory
    ]  # fmt: skip
    found = charted.fresh(chart, fresh)
    valid = [one for one in found if one.claimed]
    assert len(valid) > 20
    assert all(one.holds for one in valid)
    assert not all(one.holds for one in found)  # elsewhere they are beyond it
    assert np.mean([one.z**2 for one in found]) < 2.0
    wrong = [replace(one, measured=one.measured + 0.15) for one in found]
    assert np.mean([one.z**2 for one in wrong]) > 4.0


@pytest.mark.slow
def test_95_percent_hold_of_maps_left_out(monkeypatch):
    """Each Gaussian map against a table of all others: of the intervals about the bias 93 to 97 % hold it.

    The error of each figure is shared by loads and neighbouring figures of one map; of 59 maps, whose share
    outside scatters by 4 %, a rule of 95 % has a mean share of 91 to 99 % in all but one of a thousand.
    """
    monkeypatch.setattr(deviations, "MODELS", ("one radius",))
    monkeypatch.setattr(deviations, "INTERACTIONS", ("none",))
    rows = [row for row in ROWS if row["kind"] == "gaussian" and row["purpose"] == "study"]
    found = [(row, deviations.deviations(row)[0]) for row in rows]
    inside, below, many = 0, 0, 0
    for key in {(row["x"], row["seed"]) for row in rows}:
        others = [row for row in rows if (row["x"], row["seed"]) != key]
        known = {id(row): one for row, one in found}
        with monkeypatch.context() as patch:
            patch.setattr(deviations, "deviations", lambda row, known=known: [known[id(row)]])
            lines = deviations.table_text(deviations.condensed(others), b"", 0).splitlines()
        grid = error_table.Grid(error_table.read(lines), along_separation=False)
        for row, one in found:
            if (row["x"], row["seed"]) != key:
                continue
            for name in deviations.QUANTITIES:
                real = getattr(one, name)
                at = np.array([row["p"] * (1 + real) if name == "load" else row["p"]])
                said = grid.expected(row["x"], at)
                (bias,), (off,) = said.bias[name], said.off[name]
                if math.isnan(bias):
                    continue
                low = bias - off if name == "separation" else (1 + bias) ** 2 / (1 + bias + off) - 1
                many += 1
                inside += low <= real <= bias + off
                below += abs(real) <= abs(bias) + off
    assert many > 1500
    assert 0.91 < inside / many < 0.99
    assert below / many > 0.95


@pytest.mark.slow
def test_corrected_answers_are_those_of_boundary_elements():
    """Four fresh isotropic maps, three loads: within 6 % rms of area; 95 % intervals (12: two may miss)."""
    solves, off, missed, plain = fitted_maps.read(), [], 0, []
    for each in fitted_maps.MAPS[:4]:
        heights = each.heights()
        n, side, slope = len(heights), fitted_maps.SIDE, fitted_maps.SLOPE
        z = Topography(slope * side * heights, (side / n,) * 2, periodic=True)
        fit = mcgw.fit(z, cutoff=None, form="none")
        scene = mcgw.fitted_scene(fit, heights="nayak", E_star=fitted_maps.MODULUS, n_surfaces=60)
        area = scene.surface.nominal_area
        for row in solves[each.name]:
            solved = mcgw.solve(scene, load=row["p"] * fitted_maps.MODULUS * slope * area)
            found, right = solved.corrected("area"), row["area"] * area
            off.append(found.value / right - 1)
            plain.append(solved.value["area"] / right - 1)
            missed += not found.low <= right <= found.high
    assert np.sqrt(np.mean(np.square(off))) < 0.06
    assert np.sqrt(np.mean(np.square(plain))) > 0.15  # as the model itself is
    assert missed <= 2
