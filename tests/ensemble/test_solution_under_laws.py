"""The separation at a load or area under other contact laws: against a literal search, and theory.

Laws are typed anew, of one depth at a time; the search looks at every separation at which an
asperity goes from piece to piece, from above, and halves behind the first that reaches the value.
"""

from math import pi, sqrt

import numpy as np
import oracles.laws_of_one_depth as by_hand
import pytest
from oracles.inside import Asperities, solutions

import mcgw
from analytic import quantity_of

YIELD_OF_STEEL = by_hand.yields_at(0.004)

# Law of the package, the same by hand, penetrations over 1/e^2 at which pieces begin, and the grading.
LAWS = {
    "kogut-etsion": (mcgw.KogutEtsion(critical=0.05), by_hand.kogut_etsion, (0.05, 0.3, 5.5), 2.0),
    "chang-etsion-bogy": (mcgw.ChangEtsionBogy(critical=0.5), by_hand.chang_etsion_bogy, (0.5,), 1.0),
    "jackson-green": (mcgw.JacksonGreen(yield_strain=0.004, critical=YIELD_OF_STEEL), by_hand.jackson_green,
                      (1.9 * YIELD_OF_STEEL,), 1.2),
    "johnson-kendall-roberts": (mcgw.JohnsonKendallRoberts(pull_off=0.3), by_hand.johnson_kendall_roberts,
                                (), 1.3),
    "coated": (mcgw.Coated(ratio=3.0, reduced_thickness=0.5), by_hand.coated, (), 1.0),
    "power-law-graded": (mcgw.PowerLawGraded(0.5, reduced_c0=2.0), by_hand.power_law_graded, (), 1.5),
}  # fmt: skip
SURFACE = mcgw.Surface(sigma=1e-6, radius=1e-3, eta=3e8, nominal_area=1e-6, E_star=1e11)
SCALES = {"load": 4 / 3 * 1e11 * sqrt(1e-3) * 1e-6**1.5, "area": pi * 1e-3 * 1e-6}


def modulus(s, gamma_):
    return gamma_ - (gamma_ - 1) * np.exp(-s)


def literal_sum(law, given, s, gamma_, h):
    which = ("load", "area").index(given)
    return sum(law(x - h, modulus(x, gamma_))[which] for x in s if x > h)


def literal_search(law, starts, given, s, gamma_, value):
    """Largest separation at which the sum reaches a value, to 1e-13."""
    e = modulus(s, gamma_)
    jumps = np.concatenate([s, *(s - start / e**2 for start in starts)])
    looks = np.sort(np.concatenate([jumps + 1e-13, jumps - 1e-13, np.linspace(-2, s.max(), 50)]))[::-1]
    above = s.max() + 1
    for below in looks:
        if literal_sum(law, given, s, gamma_, below) >= value:
            break
        above = below
    for _ in range(60):
        middle = (above + below) / 2
        reached = literal_sum(law, given, s, gamma_, middle) >= value
        above, below = (above, middle) if reached else (middle, below)
    return below


@pytest.mark.parametrize("given", ["load", "area"])
@pytest.mark.parametrize("name", LAWS)
def test_a_literal_search_finds_the_same(name, given):
    law, typed, starts, gamma_ = LAWS[name]
    scene = mcgw.Scene(
        SURFACE, separations=0.0, grading=mcgw.Exponential(gamma_), law=law,
        ensemble=mcgw.Sampling(n_asperities=60), n_surfaces=3, seed=3,
    )  # fmt: skip
    values = [float(x) for x in scene.theory.mean(given, [2.2, 1.0])]
    for value, solution in zip(values, solutions(scene, given, values, draw=True), strict=True):
        for number in range(3):
            s = solution.heights(number)
            expected = literal_search(typed, starts, given, s, gamma_, value / SCALES[given])
            h = solution.surfaces["separation"][number]
            assert h == pytest.approx(expected, abs=3e-12)
            for name_, scale in SCALES.items():  # on either side of a jump
                sides = [scale * literal_sum(typed, name_, s, gamma_, h + x) for x in (1e-11, -1e-11)]
                told = solution.surfaces[name_][number]
                slack = 1e-8 * max(map(abs, sides))
                assert min(sides) - slack <= told <= max(sides) + slack
            assert solution.surfaces["contacts"][number] == np.count_nonzero(s > h)


@pytest.mark.parametrize("given", ["load", "area"])
def test_below_all_that_was_drawn_at_once_the_search_finds_the_same(given, monkeypatch):
    """Step by step, on the whole of each surface."""
    monkeypatch.setattr("mcgw.ensemble.solution._MARGIN", -1.0)
    test_a_literal_search_finds_the_same("kogut-etsion", given)


def solved_by_hand(law, given, value, heights=(2.0,), ratios=None, start=-3.0):
    """Separation at which listed asperities of one modulus have a load or area over its scale."""
    scene = mcgw.Scene(SURFACE, separations=0.0, law=law, n_surfaces=2, seed=1)
    own = None if ratios is None else np.array(ratios)
    on = Asperities.of(scene, np.array([len(heights)]), np.array(heights), own)
    (h,) = on.separations(quantity_of(given), value * SCALES[given], start)
    return h


@pytest.mark.parametrize("given", ["load", "area"])
def test_radii_of_their_own(given):
    """A summit r times as blunt yields r times as deep, at r^2 times the load and area."""
    s, ratios, law = (2.2, 2.0, 1.0), (0.5, 2.0, 1.3), mcgw.KogutEtsion(critical=0.05)
    which = ("load", "area").index(given)
    for h in (2.1, 1.7, 0.6):
        above = [(x - h, r) for x, r in zip(s, ratios, strict=True) if x > h]
        each = [r**2 * by_hand.kogut_etsion(x / r, 1.0)[which] for x, r in above]
        assert solved_by_hand(law, given, sum(each), s, ratios) == pytest.approx(h, abs=1e-12)


def test_a_load_that_is_jumped_over_is_passed():
    """One asperity of Chang, Etsion and Bogy: between Hertz's load at yield and 1.5 times that."""
    law, at_yield = mcgw.ChangEtsionBogy(critical=0.5), 0.5**1.5
    for value in (1.01 * at_yield, 1.49 * at_yield):
        assert solved_by_hand(law, "load", value) == pytest.approx(1.5, abs=1e-15)
    assert solved_by_hand(law, "load", 0.99 * at_yield) == pytest.approx(2 - (0.99) ** (2 / 3) * 0.5)
    assert np.isnan(solved_by_hand(law, "load", 1.8, start=1.9))


@pytest.mark.parametrize("share", [0.94, 0.96, 0.98, 0.999])
def test_an_area_that_falls_at_yield_is_met_before(share):
    """One asperity of Kogut and Etsion: its area falls by 7 % there, and is the same again farther down."""
    law = mcgw.KogutEtsion(critical=0.05)
    assert solved_by_hand(law, "area", share * 0.05) == pytest.approx(2 - share * 0.05)
