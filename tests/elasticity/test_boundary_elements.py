"""Boundary elements: what is asked of Tamaas and made of its answers, on a bed of springs; Tamaas."""

import math
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from oracles.inside import LEVELS, Pressed, rimless
from oracles.rough import rough
from scipy.optimize import brentq

import mcgw

LATTICE = -3.900264920001956  # 4 zeta(1/2) beta(1/2), physics of a square lattice
BED = 3.0  # pressure over modulus on a bed of springs, for a depth of one side of the map


class Springs:
    """Tamaas's interface over a bed of springs, each of which feels only what is above it."""

    pressure, gap = "pressure", "gap"
    answer = 1e-7  # the error that it stops at, or what it raises

    def __init__(self, model, heights, tolerance, primal, constraint):
        assert (model.E, model.nu) == (1.0, 0.0)
        assert model.shape == list(heights.shape)
        assert model.size == [1.0, pytest.approx(1.5)]
        assert heights.flags.c_contiguous
        assert (tolerance, primal) == (1e-6, constraint)
        self.model, self.heights, self.what, self.max_iter = model, heights, primal, 0

    def solve(self, target):
        assert self.max_iter == 20_000
        if isinstance(self.answer, Exception):
            raise self.answer
        h = self.heights

        def at(d):
            return BED * np.maximum(h - d, 0)

        def off(d):
            held = at(d).mean()
            return held - target if self.what == "pressure" else d + held / BED - target

        traction = at(brentq(off, h.min() - 2, h.max(), xtol=1e-16, rtol=1e-14))
        if self.what == "gap":
            traction[...] = traction.mean()  # of which the mean alone is right
        else:
            assert not np.any(self.model.traction[h == h.min()])  # where it begins is no problem of gaps
        self.model.traction[...] = traction
        self.model.displacement[...] = traction / BED
        return self.answer


def springs_model(kind, size, shape):
    assert kind == "2d"
    return SimpleNamespace(size=size, shape=shape, traction=np.ones(shape) * 0, displacement=np.zeros(shape))


@pytest.fixture
def springs(monkeypatch):
    said = []
    library = ModuleType("tamaas")
    library.Model, library.PolonskyKeerRey = springs_model, Springs
    library.model_type = SimpleNamespace(basic_2d="2d")
    library.LogLevel = SimpleNamespace(error="error")
    library.set_log_level = said.append
    monkeypatch.setitem(sys.modules, "tamaas", library)
    yield library
    assert set(said) <= {"error"}


class TestBoundaryElements:
    """What is asked of the solver and made of its answers, on a bed of springs that NumPy solves too."""

    size, E_star = (3e-4, 2e-4), 1e9

    def heights(self, rng):
        z = 1e-6 * rng.standard_normal((8, 12))
        return z - z.mean()

    def by_hand(self, z, p):
        """Separation of the plane from the deformed surface's mean plane, and what touches."""
        springs = BED * self.E_star / self.size[1]  # Pa/m
        d = brentq(
            lambda d: springs * np.maximum(z - d, 0).mean() - p, -1e-4, z.max(), xtol=1e-20, rtol=1e-14
        )
        return d + p / springs, z > d

    @pytest.mark.usefixtures("springs")
    @pytest.mark.parametrize("p", [2e6, 2e7])
    def test_make_si_values(self, p, rng):
        z, nominal = self.heights(rng), 6e-8
        found = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, p))
        gap, touching = self.by_hand(z, p)
        nearer, _ = self.by_hand(z, 1.02 * p)
        stiffness = 0.02 * p * nominal / (gap - nearer)
        expected = {
            "area": rimless(touching) * nominal, "stiffness": stiffness,
            "conductance": 2 * stiffness / self.E_star, "mean_gap": gap,
        }  # fmt: skip
        assert found == pytest.approx(expected, rel=1e-9)
        at = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=gap))
        expected["pressure"] = p
        del expected["mean_gap"]
        assert at == pytest.approx(expected, rel=1e-8)

    @pytest.mark.usefixtures("springs")
    def test_of_a_plane_above_all_say_zero(self, rng):
        z = self.heights(rng)
        clear = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=float(z.max())))
        assert clear == dict.fromkeys(("area", "stiffness", "conductance", "pressure"), 0.0)
        near = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=0.99 * float(z.max())))
        assert min(near.values()) > 0

    @pytest.mark.usefixtures("springs")
    @pytest.mark.parametrize(
        ("answer", "held", "words"),
        [
            (FloatingPointError(), {"pressure": 1e6}, "a single point touches; give a higher pressure"),
            (FloatingPointError(), {"separation": 1e-7}, "a single point touches; give a smaller separation"),
            (1.1e-6, {"pressure": 1e6}, "stopped at an error of 1.1e-06; give a lower pressure"),
            (math.nan, {"separation": 1e-7}, "stopped at an error of nan; give a larger separation"),
        ],
    )
    def test_that_do_not_end_are_told(self, answer, held, words, rng, monkeypatch):
        monkeypatch.setattr(Springs, "answer", answer)
        with pytest.raises(mcgw.RunError, match=words):
            LEVELS[-1].solve(Pressed(self.heights(rng), self.size, self.E_star, **held))
        monkeypatch.setattr(Springs, "answer", 1e-6)
        assert LEVELS[-1].timed(Pressed(self.heights(rng), self.size, self.E_star, **held))[0]

    def test_that_are_not_there_are_told(self, rng, monkeypatch):
        monkeypatch.setitem(sys.modules, "tamaas", None)
        with pytest.raises(
            mcgw.RunError, match=r"need Tamaas: in a clone of mcgw, pip install -e '\.\[bem\]'"
        ):
            LEVELS[-1].solve(Pressed(self.heights(rng), self.size, self.E_star, 1e6))


@pytest.mark.site
def test_boundary_elements_find_hertz():
    """A paraboloid in the middle of a wide cell: area and stiffness to what a grid and images leave, 3 %."""
    pytest.importorskip("tamaas")
    n, radius, side = 512, 2.0, 1.0
    grid = (np.arange(n) + 0.5) / n - 0.5
    heights = -(grid[:, None] ** 2 + grid**2) / (2 * radius)
    a = 0.08  # sqrt(R delta), 41 points
    load = 4 / 3 * a**3 / radius
    found = LEVELS[-1].solve(Pressed(heights - heights.mean(), (side, side), 1.0, load))
    assert found["area"] == pytest.approx(math.pi * a**2, rel=0.03)
    # in series with the images: 1/K = 1/(2 a) + the lattice's constant/pi
    assert 1 / found["stiffness"] == pytest.approx(
        1 / (2 * 1.01 ** (1 / 3) * a) + LATTICE / math.pi, rel=0.03
    )
    assert found["conductance"] == pytest.approx(2 * found["stiffness"], rel=1e-12)
    wide = LEVELS[-1].solve(Pressed(3 * (heights - heights.mean()), (3.0, 3.0), 2.0, 2 * load))
    assert wide["area"] == pytest.approx(9 * found["area"], rel=1e-6)
    assert wide["stiffness"] == pytest.approx(6 * found["stiffness"], rel=1e-6)
    assert wide["mean_gap"] == pytest.approx(3 * found["mean_gap"], rel=1e-6)


@pytest.mark.site
def test_boundary_elements_hold_a_gap(rng):
    """The gap of a pressure, given, finds that pressure again: two of Tamaas's problems."""
    pytest.importorskip("tamaas")
    heights = rough(rng).heights
    for p in (2e7, 1e9):
        under = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, p))
        at = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, separation=under["mean_gap"]))
        assert at["pressure"] == pytest.approx(p, rel=2e-5)
        assert at["area"] == pytest.approx(under["area"], rel=1e-3)
        assert at["stiffness"] == pytest.approx(under["stiffness"], rel=2e-4)
    clear = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, separation=float(heights.max())))
    assert set(clear.values()) == {0.0}
    with pytest.raises(mcgw.RunError, match="higher pressure"):
        LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 1e2))
