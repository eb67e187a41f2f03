"""Models against boundary elements: what users are told follows from the solves, and the models are these."""

import csv
import hashlib
import math
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "runs" / "validation"
CONDENSED = ROOT / "mcgw" / "validity" / "table.csv"

sys.path.insert(0, str(FOLDER))

import conductance  # noqa: E402
import deviations  # noqa: E402
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


@pytest.mark.parametrize(("kind", "x", "p"), [("gaussian", 20.0, 1e-3), ("caps", 0.06, 1e-2)])
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
