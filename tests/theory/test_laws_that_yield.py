"""Laws of asperities that yield: published values, defects, wrong constants, limits, graded surfaces.

Check values are those of `shared/physics.md`, A: mpmath at 25 to 30 digits, separately written.
"""

from dataclasses import replace
from functools import partial

import numpy as np
import oracles.laws_of_one_depth as by_hand
import pytest
from oracles.law_means import BRIDGED, FOUR, ONE, STEEL, SURFACE, name, term

import analytic
import mcgw
from analytic.laws import (
    ChangEtsionBogy,
    Coated,
    Hertz,
    JacksonGreen,
    JohnsonKendallRoberts,
    KogutEtsion,
    PowerLawGraded,
    ZhaoMaiettaChang,
    piece_of,
)
from analytic.laws.law import slope_in_root
from mcgw.scene.cautions import other_laws

TYPED_ANEW = {  # by `oracles.laws_of_one_depth`
    "kogut": (KogutEtsion(critical=0.05), partial(by_hand.kogut_etsion, critical=0.05)),
    "of nu": (KogutEtsion(critical=1e-4, poisson=0.4), partial(by_hand.kogut_etsion, critical=1e-4, k=0.618)),
    "chang": (ChangEtsionBogy(critical=0.5), by_hand.chang_etsion_bogy),
    "zhao": (ZhaoMaiettaChang(critical=0.05), by_hand.zhao_maietta_chang),
    "jackson": (STEEL, by_hand.jackson_green),
    "softer": (JacksonGreen(yield_strain=0.01, critical=by_hand.yields_at(0.01)),
               partial(by_hand.jackson_green, strain=0.01)),
    "coated": (Coated(ratio=3.0, reduced_thickness=0.5), by_hand.coated),
    "graded": (PowerLawGraded(0.5, reduced_c0=2.0), by_hand.power_law_graded),
    "in metres": (PowerLawGraded(0.3, 5e-6, 0.25).on(SURFACE),
                  partial(by_hand.power_law_graded, k=0.3, depth=5 / 1e3**0.5, nu=0.25)),
    "hertz": (PowerLawGraded(0.0, reduced_c0=0.3), lambda d, e: (e * d**1.5, d)),
    "sticks": (JohnsonKendallRoberts(pull_off=0.3), by_hand.johnson_kendall_roberts),
}  # fmt: skip


@pytest.mark.parametrize("law", TYPED_ANEW)
def test_every_law_is_the_one_typed_anew(law):
    """At moduli that yield each at its own depth, on all pieces; up to 1e5 times the depth of yield."""
    law, anew = TYPED_ANEW[law]
    for e in (0.6, 1.0, 2.0):
        for d in (1e-3, 0.04, 0.31, 2.0, 9.0):
            found = [float(term(quantity, law, np.array(d), np.array(e))) for quantity in ("load", "area")]
            assert found == pytest.approx([float(x) for x in anew(d, e)], rel=1e-12), (d, e)


def test_hardness_and_strength_become_critical_penetrations():
    kogut = KogutEtsion(hardness=1e9, poisson=0.3).on(SURFACE)
    assert kogut.critical == pytest.approx((np.pi * 0.577 * 1e9 / 2e11) ** 2 * 1e3, rel=1e-14)
    chang = ChangEtsionBogy(hardness=1e9).on(SURFACE)
    assert chang.critical == pytest.approx((np.pi * 0.6 * 1e9 / 2e11) ** 2 * 1e3, rel=1e-14)
    assert ChangEtsionBogy(hardness=1e9, poisson=0.3).on(SURFACE).critical == kogut.critical
    zhao = ZhaoMaiettaChang(hardness=1e9).on(SURFACE)
    assert zhao.critical == pytest.approx((3 * np.pi * 0.4 * 1e9 / 4e11) ** 2 * 1e3, rel=1e-14)
    assert STEEL.critical / 1e3 == pytest.approx(1.0296e-4, rel=1e-4)
    for law in (kogut, chang, zhao, STEEL):
        assert law.on(SURFACE) is law


@pytest.mark.parametrize("law", [*FOUR, *BRIDGED], ids=name)
def test_slopes_are_those_of_a_difference(law):
    """Fourth order; and the first piece is odd in the root of the penetration."""
    e = np.array([0.7, 1.3])
    edges = np.concatenate([np.zeros((1, 2)), law.limits(e)])
    for piece, start in enumerate(edges):
        delta = 1.2 * start + (0.02 if piece == 0 else 0.0)
        step = 1e-3 * delta

        def load(k, delta=delta, step=step, piece=piece):
            return law.load(piece, np.sqrt(delta + k * step), e)

        difference = (load(-2) - 8 * load(-1) + 8 * load(1) - load(2)) / (12 * step)
        slope = slope_in_root(partial(law.load, piece, e=e), np.sqrt(delta))
        np.testing.assert_allclose(slope, difference, rtol=3e-11)
    y = np.array([0.3, 0.01])
    assert np.array_equal(law.load(0, -y, e), -law.load(0, y, e))
    assert np.array_equal(law.radius(0, -y, e), -law.radius(0, y, e))


ELASTIC = Hertz(), PowerLawGraded(0.4, reduced_c0=0.7), Coated(ratio=3.0, reduced_thickness=0.5)


@pytest.mark.parametrize("law", [*FOUR, *BRIDGED, *ELASTIC], ids=name)
def test_asperities_without_stiffness_carry_nothing_and_never_yield(law):
    """Nor does anything warn: warnings are errors here."""
    e, delta = np.array([0.0, 1e-200, 1e-3, 1.0]), np.geomspace(1e-12, 30, 200)[:, None]
    limits = law.limits(e)
    assert np.all(np.isposinf(limits[:, :2]))
    assert np.all(np.isfinite(limits[:, 2:]))
    for quantity in ("load", "area", "stiffness", "conductance", "load_slope", "yielded"):
        value = term(quantity, law, delta, e)
        assert np.all(np.isfinite(value))
        assert quantity in ("area", "conductance") or np.all(value[:, 0] == 0)
    for piece in range(len(limits) + 1):
        assert np.all(law.load(piece, np.sqrt(delta), e[:1]) == 0)
        assert np.all(np.isfinite(law.radius(piece, np.sqrt(delta), e[:1])))


@pytest.mark.parametrize("law", BRIDGED, ids=name)
def test_bridges_join_the_published_pieces(law):
    """Load, area and slopes at their ends; between them the law is the published one, to the bit."""

    def slope(j, y, e):
        return slope_in_root(partial(law.load, j, e=e), y)

    for j, limit in enumerate(law.limits(ONE)):
        for formula, within in ((law.load, 1e-13), (law.radius, 1e-13), (slope, 1e-12)):
            y = np.sqrt(limit)
            assert formula(j, y, ONE) == pytest.approx(formula(j + 1, y, ONE), rel=within)
    delta = np.geomspace(1e-4, 20, 2001)
    between = piece_of(law, delta, ONE) % 2 == 0
    for quantity in ("load", "area", "load_slope"):
        a, b = (term(quantity, x, delta, ONE) for x in (law, replace(law, bridge=None)))
        assert np.array_equal(a[between], b[between])
        assert not np.array_equal(a, b)


def test_rival_laws_of_a_hardness_are_those_of_its_critical_penetration():
    """By the formula of Chang, Etsion and Bogy, typed in; else none would be compared."""
    hardness, poisson = 1.2e9, 0.3
    surface = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
    critical = (np.pi * (0.454 + 0.41 * poisson) * hardness / (2 * 78.6e9)) ** 2 * 13e-6 / 1.37e-6
    told = {"hardness": {"hardness": hardness}, "critical": {"critical": critical}}
    found = [
        other_laws(
            mcgw.Scene(surface, separations=[1.0], law=mcgw.KogutEtsion(poisson=poisson, **one), seed=1)
        )
        for one in told.values()
    ]
    assert found[0].critical == pytest.approx(critical, rel=1e-12)
    assert found[0].load == pytest.approx(found[1].load, rel=1e-12)
    assert found[0].load["hertz"] > 1
