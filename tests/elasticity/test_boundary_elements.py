"""Boundary elements by Tamaas: Hertz, a gap that is held, and what is told where there is no answer."""

import math

import numpy as np
import pytest
from oracles.inside import LEVELS, Grid, Pressed
from oracles.rough import rough

import mcgw

SIZE = (6.4e-5, 6.4e-5)


def solved(heights, **held):
    return LEVELS[-1].solve(Pressed(heights, SIZE, 1e11, **held))


@pytest.fixture
def tamaas():
    return pytest.importorskip("tamaas")


@pytest.mark.usefixtures("tamaas")
def test_a_paraboloid_is_that_of_hertz():
    """In the middle of a wide cell: area and stiffness to what a grid and images leave, 3 %."""
    columns, side, E_star = 384, 2e-4, 1e9
    n, radius, wide = 256, 2 * side, columns / 256
    y, x = ((np.arange(many) + 0.5) / n - many / (2 * n) for many in (n, columns))
    heights = -((side * y[:, None]) ** 2 + (side * x) ** 2) / (2 * radius)
    heights -= heights.mean()
    a = 0.08 * side  # sqrt(R delta), 20 points
    pressure = 4 / 3 * E_star * a**3 / radius / (wide * side**2)
    found = LEVELS[-1].solve(Pressed(heights, (wide * side, side), E_star, pressure))
    assert found["area"] == pytest.approx(math.pi * a**2, rel=0.03)
    # in series with the images: 1/K = 1/(2 a) + their potential/pi
    images = Grid(heights.shape, (wide * side, side)).potential[0, 0] / math.pi
    assert E_star / found["stiffness"] == pytest.approx(1 / (2 * 1.01 ** (1 / 3) * a) + images, rel=0.03)
    assert found["conductance"] == pytest.approx(2 * found["stiffness"] / E_star, rel=1e-12)


@pytest.mark.usefixtures("tamaas")
def test_the_gap_of_a_pressure_finds_that_pressure_again(rng):
    """Two of Tamaas's problems; clear of the plane nothing touches."""
    heights = rough(rng).heights
    under = solved(heights, pressure=2e7)
    at = solved(heights, separation=under["mean_gap"])
    assert at["pressure"] == pytest.approx(2e7, rel=2e-5)
    assert at["area"] == pytest.approx(under["area"], rel=1e-3)
    assert at["stiffness"] == pytest.approx(under["stiffness"], rel=2e-4)
    nearer = solved(heights, pressure=2.02e7)["mean_gap"]
    assert under["stiffness"] == pytest.approx(2e5 * SIZE[0] ** 2 / (under["mean_gap"] - nearer), rel=1e-3)
    assert solved(heights, separation=float(heights.max())) == dict.fromkeys(at, 0.0)


@pytest.mark.parametrize(("answer", "held", "words"), [
    (FloatingPointError(), {"pressure": 1e6}, "a single point touches; give a higher pressure"),
    (FloatingPointError(), {"separation": 1e-7}, "a single point touches; give a smaller separation"),
    (1.1e-6, {"pressure": 1e6}, "stopped at an error of 1.1e-06; give a lower pressure"),
    (math.nan, {"separation": 1e-7}, "stopped at an error of nan; give a larger separation"),
])  # fmt: skip
def test_what_does_not_end_is_told(tamaas, answer, held, words, rng, monkeypatch):
    def solve(*_):
        if isinstance(answer, Exception):
            raise answer
        return answer

    monkeypatch.setattr(tamaas.PolonskyKeerRey, "solve", solve)
    with pytest.raises(mcgw.RunError, match=words):
        solved(rough(rng).heights, **held)


def test_that_tamaas_is_not_there_is_told(rng, missing):
    missing("tamaas")
    with pytest.raises(mcgw.RunError, match="need Tamaas: in a clone of mcgw, pip install -e"):
        solved(rough(rng).heights, pressure=1e6)
