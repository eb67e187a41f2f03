"""The exact theory under other laws of contact than Hertz's: check values, literal integrals, identities."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.law_means import term
from oracles.laws_by_hand import (
    GRADINGS as PLAIN,
    SURFACE,
    Film,
    HalfSpace,
    chang_etsion_bogy,
    differences,
    kogut_etsion,
    over_pieces,
    reduced,
)
from scipy.optimize import brentq

from analytic import (
    Clipped,
    Custom,
    Exponential,
    ExponentialHeights,
    Gaussian,
    MeasuredHeights,
    Model,
    Table,
    Weibull,
    laws,
    quantity_of,
)

LAWS = {
    "kogut-etsion": kogut_etsion(0.05), "early": kogut_etsion(1e-3), "late": kogut_etsion(10.0),
    "chang": chang_etsion_bogy(0.3), "half-space": HalfSpace(0.25), "film": Film(0.1),
}  # fmt: skip
GRADINGS = PLAIN | {
    "stiff tips": Clipped(Exponential(2.0)),
    "table": Table([-1.0, 0.0, 0.7, 1.5], [0.4, 1.0, 0.3, 2.0]),
    "jump": Custom(lambda s: np.where(s >= 1.3, 0.4, 1.0), breaks=(1.3,)),
    "narrow": Custom(lambda s: np.where((s >= 1.3) & (s < 1.302), 0.3, 1.0), breaks=(1.3, 1.302)),
    "untold jump": Custom(lambda s: np.where(s > 1.3, 0.4, 1.0)),
    "untold kink": Custom(lambda s: 0.3 + np.abs(s - 1.3)),
    "waves": Custom(lambda s: 1 + 0.3 * np.sin(3 * s)),
}
UNTOLD = 1.3
PAIRS = [  # every law, every grading
    ("kogut-etsion", "uniform"), ("kogut-etsion", "table"), ("early", "soft tips"), ("late", "stiff tips"),
    ("chang", "no tips"), ("half-space", "table"), ("film", "soft tips"), ("kogut-etsion", "jump"),
    ("kogut-etsion", "narrow"), ("chang", "untold jump"), ("kogut-etsion", "untold kink"), ("early", "waves"),
]  # fmt: skip


def found_by_hand(law, grading, h, low, high):
    """Heights at which a piece ends: on a fine grid, then by Brent; and breaks of the grading."""
    s = np.linspace(low, high, 20_001)
    ends = []
    for j in range(len(law.limits(np.ones(1)))):

        def gap(x, j=j):
            with np.errstate(divide="ignore"):
                return x - h - law.limits(grading(np.array(x)))[j]

        over = gap(s) >= 0
        for k in np.flatnonzero(over[1:] != over[:-1]):
            ends.append(brentq(gap, s[k], s[k + 1], xtol=1e-15))
    return [x for x in [*ends, *grading.breaks, UNTOLD, 0.0] if low < x < high]


def literal(f, law, grading, heights, h, top=9.5):
    """Integral of f(s) over the density, in the root of s - h, piece by piece."""
    low = max(h, heights.support[0])
    inner = found_by_hand(law, grading, h, low, top)
    if isinstance(heights, Weibull):
        low += 1e-300
    fine = [h + 4.0**-k for k in range(12) if h + 4.0**-k > low]
    edges = np.sqrt(np.unique([low, *inner, *fine, top]) - h)

    def integrand(v):
        s = h + v * v
        return 2 * v * f(s) * heights.pdf(s)

    return over_pieces(integrand, edges)


CHECKS = [  # physics.md A.1 to A.9: mpmath at 25 digits, Gaussian heights at h = 1
    (laws.KogutEtsion(critical=0.05), "load", 0.05346624148043353),
    (laws.ChangEtsionBogy(critical=0.05), "load", 0.05328285176044976),
    (laws.ZhaoMaiettaChang(critical=0.5), "load", 0.06754575844782382),
    (laws.JacksonGreen(yield_strength=4e6), "load", 0.06273249305786957),  # 0.004 E*, R/sigma = 1000
    (laws.PowerLawGraded(0.5, reduced_c0=1.0), "area", 1.5 * 0.08331547058768628),
    (laws.Coated(reduced_thickness=0.5, ratio=3.0, poisson=0.3), "stiffness", 0.1780682584080905),
    (laws.Coated(reduced_thickness=0.5, ratio=0.2, poisson=0.3), "load", 0.05308882315001123),
]


@pytest.mark.parametrize(("law", "quantity", "value"), CHECKS)
def test_check_values(law, quantity, value):
    surface = replace(SURFACE, radius=1e-3)
    model = Model(surface, law=law)
    found = float(model.mean(quantity, 1.0)) / model.number / quantity_of(quantity).scale(surface)
    assert found == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(("law", "grading"), PAIRS)
def test_means_are_literal_integrals(law, grading):
    law, grading = LAWS[law], GRADINGS[grading]
    model = Model(SURFACE, law=law, grading=grading)
    own = "conductance" if isinstance(law, Film) else "load"
    # With "chang" and no tips the first is 1e-5 below the highest s - dc exp(2 s): few heights yield.
    for h, quantity in ((-0.2446, own), (1.2, own), (1.2, "yielded")):

        def f(s, quantity=quantity, h=h):
            with np.errstate(divide="ignore", invalid="ignore"):
                return np.nan_to_num(term(quantity, law, s - h, grading(s)))

        truth = literal(f, law, grading, Gaussian(), h)
        assert reduced(model, quantity, h) == pytest.approx(truth, rel=1e-12, abs=1e-16)


def test_separations_that_share_a_rule_do_not_matter_to_each_other():
    """A limit apart, close together, and far away."""
    h = np.array([-0.5, 0.3, 0.35, 0.35 + 1e-9, 1.0, 8.0, 20.0])
    for law, quantity, grading in (("kogut-etsion", "load", "table"), ("film", "conductance", "uniform")):
        model = Model(SURFACE, law=LAWS[law], grading=GRADINGS[grading])
        alone = [float(model.mean(quantity, x)) for x in h]
        np.testing.assert_allclose(model.mean(quantity, h), alone, rtol=2e-12)


def test_means_under_other_height_laws():
    law, grading = kogut_etsion(0.05), Exponential(0.2)
    for heights, h in ((ExponentialHeights(), 0.3), (Weibull(2.0), -1.4)):
        model = Model(SURFACE, law=law, grading=grading, heights=heights)
        truth = literal(lambda s, h=h: term("load", law, s - h, grading(s)), law, grading, heights, h, 40.0)
        assert reduced(model, "load", h) == pytest.approx(truth, rel=1e-10)
    measured = MeasuredHeights(np.random.default_rng(3).standard_normal(200))
    model, s = Model(SURFACE, law=law, grading=grading, heights=measured), np.array(measured.heights)
    for quantity in ("load", "yielded", "load_slope"):
        truth = term(quantity, law, s - 0.7, grading(s)).mean()
        assert reduced(model, quantity, 0.7) == pytest.approx(truth, rel=1e-14)
    values = model.mean("load", [0.7 - 1e-6, 0.7 + 1e-6])
    assert float(model.slope("load", 0.7)) == pytest.approx((values[0] - values[1]) / 2e-6, rel=1e-7)


@pytest.mark.parametrize(("quantity", "h"), [("load", -0.4), ("yielded", 1.2)])
def test_cumulants_are_literal_moments(quantity, h):
    law, grading, n = kogut_etsion(0.05), Exponential(0.2), 70.0
    model = Model(SURFACE, law=law, grading=grading, n_asperities=n)
    scale = quantity_of(quantity).scale(SURFACE)
    m1, m2, m3 = (
        literal(lambda s, k=k: term(quantity, law, s - h, grading(s)) ** k, law, grading, Gaussian(), h)
        for k in (1, 2, 3)
    )
    fixed = model.cumulants(quantity, h)
    assert float(fixed.variance) == pytest.approx(n * scale**2 * (m2 - m1**2), rel=1e-10)
    k3 = m3 - 3 * m2 * m1 + 2 * m1**3
    assert float(fixed.skewness) == pytest.approx(k3 / (m2 - m1**2) ** 1.5 / n**0.5, rel=1e-9)
    poisson = replace(model, count="poisson").cumulants(quantity, h)
    assert float(poisson.variance) == pytest.approx(n * scale**2 * m2, rel=1e-10)


def test_covariance_across_separations_is_literal():
    law, grading = kogut_etsion(0.05), Exponential(0.2)
    model = Model(SURFACE, law=law, grading=grading, count="poisson", n_asperities=1.0)
    h = np.array([0.2, 0.25, 0.25 + 1e-9, 1.1])  # the second is where asperities yield under the first
    matrix = model.covariance(["load", "yielded", "load_slope"], h)
    scale = quantity_of("load").scale(SURFACE)

    def ends(s):
        return [x for level in h for x in found_by_hand(law, grading, level, level, 9.5) if x > s]

    for i, j in ((0, 1), (1, 2), (0, 3)):
        edges = np.unique([h[j], *ends(h[j]), *(h[j] + 4.0**-k for k in range(16)), 9.5])

        def integrand(s, i=i, j=j):
            both = term("load", law, s - h[i], grading(s)) * term("yielded", law, s - h[j], grading(s))
            return both * Gaussian().pdf(s)

        truth = over_pieces(integrand, edges)
        assert matrix[0, i, 1, j] / scale == pytest.approx(truth, rel=1e-9)
    for k, quantity in enumerate(("load", "yielded", "load_slope")):
        np.testing.assert_allclose(np.diag(matrix[k, :, k, :]), model.std(quantity, h) ** 2, rtol=1e-11)


@pytest.mark.parametrize(
    ("law", "grading", "quantity"), [("chang", "no tips", "load"), ("film", "stiff tips", "area")]
)
def test_slopes_are_those_of_the_mean(law, grading, quantity):
    model, h = Model(SURFACE, law=LAWS[law], grading=GRADINGS[grading]), np.array([[1.0], [0.3]])
    exact = [differences(model, quantity, x) for x in h.ravel()]
    np.testing.assert_allclose(model.slope(quantity, h).ravel(), exact, rtol=1e-9)


def test_check_values_of_slopes():
    """physics.md, 0: Chang's law with a critical penetration of 0.05 at h = 1."""
    model = Model(SURFACE, law=chang_etsion_bogy(0.05))
    load = model.number * quantity_of("load").scale(SURFACE)
    assert float(model.slope("load", 1.0)) / load == pytest.approx(0.1024253228584864, rel=1e-12)
    assert 1.5 * reduced(model, "load_slope", 1.0) == pytest.approx(0.1011402426250286, rel=1e-12)
    edge = replace(model, heights=ExponentialHeights())  # no height is below -1
    assert float(edge.slope("contacts", -0.9999)) == pytest.approx(1000 * math.exp(-1e-4), rel=1e-12)
    # Under Hertz's law too the number of contacts falls by the density at the separation.
    model = Model(SURFACE, grading=Exponential(0.2))
    density = math.exp(-0.245) / math.sqrt(2 * math.pi)
    assert float(model.slope("contacts", 0.7)) == pytest.approx(1000 * density, rel=1e-13)
    for name in ("stiffness", "conductance"):
        assert float(model.slope(name, 0.7)) == pytest.approx(differences(model, name, 0.7), rel=1e-10)


def test_shares_of_the_pieces_are_shares_of_heights():
    """Homogeneous: beyond fixed penetrations. Graded: above the root of s - h = dc/e(s)^2."""
    both, dc = np.array([0.9, 0.4]), 0.05
    law, above = kogut_etsion(dc), Gaussian().sf
    ends = both + dc * np.array([0.0, 1.0, 6.0, 110.0, np.inf])[:, None]
    shares = [Model(SURFACE, law=law).share(piece, both) for piece in range(4)]
    np.testing.assert_allclose(shares, -np.diff(above(ends), axis=0) / above(both), rtol=1e-11)
    h = 0.4
    model = Model(SURFACE, law=law, grading=Exponential(0.2))
    t = brentq(lambda s: s - h - dc / (0.2 + 0.8 * math.exp(-s)) ** 2, h, 3, xtol=1e-15)
    elastic = 1 - float(above(np.array(t)) / above(np.array(h)))
    assert float(model.share(0, h)) == pytest.approx(elastic, 1e-11)
    yielded = float(model.mean("yielded", h) / model.mean("contacts", h))
    assert float(sum(model.share(piece, h) for piece in (1, 2, 3))) == pytest.approx(yielded, rel=1e-13)
