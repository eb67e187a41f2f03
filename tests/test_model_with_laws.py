"""The exact theory under other laws of contact than Hertz's: check values, literal integrals, identities."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from law_means import term
from laws_by_hand import ChangEtsionBogy, Film, HalfSpace, KogutEtsion
from scipy.integrate import quad
from scipy.optimize import brentq

import analytic
from analytic import (
    Clipped,
    Custom,
    Exponential,
    ExponentialHeights,
    Gaussian,
    Homogeneous,
    MeasuredHeights,
    Model,
    Table,
    Weibull,
    laws,
    quantity_of,
)
from analytic.laws.law import ContactLaw

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
LAWS = {
    "kogut-etsion": KogutEtsion(0.05),
    "early": KogutEtsion(1e-3),
    "late": KogutEtsion(10.0),
    "chang": ChangEtsionBogy(0.3),
    "half-space": HalfSpace(0.25),
    "film": Film(0.1),
}
GRADINGS = {
    "uniform": Homogeneous(),
    "no tips": Exponential(0.0),
    "soft tips": Exponential(0.2),
    "stiff tips": Clipped.of(Exponential(2.0)),
    "table": Table([-1.0, 0.0, 0.7, 1.5], [0.4, 1.0, 0.3, 2.0]),
}
HEIGHTS = {"gaussian": Gaussian(), "exponential": ExponentialHeights(), "weibull": Weibull(2.0)}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
every_grading = pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)


def reduced(model, quantity, h):
    """Mean of one asperity over the scale."""
    return float(model.mean(quantity, h)) / model.number / quantity_of(quantity).scale(SURFACE)


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
    return [x for x in [*ends, *grading.breaks, 0.0] if low < x < high]


def literal(f, law, grading, heights, h, top=9.5):
    """Integral of f(s) over the density, by scipy's adaptive rule in the root of s - h, piece by piece."""
    low = max(h, heights.support[0])
    inner = found_by_hand(law, grading, h, low, top)
    if isinstance(heights, Weibull):
        low += 1e-300
    fine = [h + 4.0**-k for k in range(12) if h + 4.0**-k > low]
    edges = np.sqrt(np.unique([low, *inner, *fine, top]) - h)

    def integrand(v):
        s = h + v * v
        return 2 * v * float(f(np.array(s))) * float(heights.density(np.array(s)))

    parts = [quad(integrand, a, b, epsabs=1e-17, epsrel=1e-13, limit=200)[0] for a, b in pairwise(edges)]
    return math.fsum(parts)


CHECKS = [  # physics.md A.1 to A.9: mpmath at 25 digits, Gaussian heights at h = 1
    (KogutEtsion(0.05), "load", 0.05346624148043353),
    (KogutEtsion(0.05), "area", 0.116420109265612),
    (KogutEtsion(0.5), "load", 0.07383090928083739),
    (KogutEtsion(0.5), "area", 0.08489960729421809),
    (ChangEtsionBogy(0.05), "load", 0.05328285176044976),
    (ChangEtsionBogy(0.05), "area", 0.1589956020772286),
    (ChangEtsionBogy(0.5), "load", 0.1088808976941458),
    (ChangEtsionBogy(0.5), "area", 0.1126222643502909),
    (HalfSpace(0.25), "load", 0.07501013481035919),
    (HalfSpace(0.5), "load", 0.07475377552208902),
    (Film(0.1), "conductance", 0.09089518816122444),
    (Film(1.0), "conductance", 0.04466451344935666),
]


@pytest.mark.parametrize(("law", "quantity", "value"), CHECKS)
def test_check_values(law, quantity, value):
    assert reduced(Model(SURFACE, law=law), quantity, 1.0) == pytest.approx(value, rel=1e-12)


OF_THE_PACKAGE = [  # the same table, by the laws of the package, put on a surface
    (laws.KogutEtsion(critical=0.05), "load", 0.05346624148043353),
    (laws.KogutEtsion(critical=0.5), "area", 0.08489960729421809),
    (laws.ChangEtsionBogy(critical=0.5), "load", 0.1088808976941458),
    (laws.ZhaoMaiettaChang(critical=0.05), "load", 0.04876778006841703),
    (laws.ZhaoMaiettaChang(critical=0.5), "area", 0.08346351478218223),
    (laws.JacksonGreen(yield_strength=4e6), "load", 0.06273249305786957),  # 0.004 E*, R/sigma = 1000
    (laws.JacksonGreen(yield_strength=4e6), "area", 0.1030235128462129),
    (laws.PowerLawGraded(0.5, reduced_c0=1.0), "area", 1.5 * 0.08331547058768628),
    (laws.Coated(reduced_thickness=0.5, ratio=3.0, poisson=0.3), "stiffness", 0.1780682584080905),
    (laws.Coated(reduced_thickness=0.5, ratio=3.0, poisson=0.3), "load", 0.1321165629933847),
    (laws.Coated(reduced_thickness=0.5, ratio=0.2, poisson=0.3), "load", 0.05308882315001123),
]


@pytest.mark.parametrize(("law", "quantity", "value"), OF_THE_PACKAGE)
def test_check_values_of_the_laws_of_the_package(law, quantity, value):
    surface = replace(SURFACE, radius=1e-3)
    model = Model(surface, law=law)
    found = float(model.mean(quantity, 1.0)) / model.number / quantity_of(quantity).scale(surface)
    assert found == pytest.approx(value, rel=1e-12)


def test_check_value_with_stiff_tips():
    model = Model(SURFACE, law=KogutEtsion(0.05), grading=Exponential(2.0))
    assert reduced(model, "load", 1.0) == pytest.approx(0.0743689879503682, rel=1e-12)


def test_check_values_see_a_wrong_constant():
    wrong = reduced(Model(SURFACE, law=KogutEtsion(0.05, third=1.3)), "load", 1.0)
    assert wrong / 0.05346624148043353 - 1 == pytest.approx(-0.067, abs=5e-4)  # physics.md: -6.7 %


@every_grading
@every_law
def test_means_are_literal_integrals(law, grading):
    model = Model(SURFACE, law=law, grading=grading)
    for h in (-0.4, 1.2):
        for quantity in ("conductance", "yielded") if isinstance(law, Film) else ("load", "yielded"):

            def f(s, quantity=quantity, h=h):
                with np.errstate(divide="ignore", invalid="ignore"):
                    return np.nan_to_num(term(quantity, law, s - h, grading(s)))

            truth = literal(f, law, grading, Gaussian(), h)
            assert reduced(model, quantity, h) == pytest.approx(truth, rel=1e-12, abs=1e-16)


@every_grading
def test_separations_that_share_a_rule_do_not_matter_to_each_other(grading):
    """A limit apart, close together, and far away."""
    h = np.array([-0.5, 0.3, 0.35, 0.35 + 1e-9, 0.351, 1.0, 3.0, 6.0, 8.0, 20.0])
    for law in (KogutEtsion(1e-3), Film(0.1)):
        model = Model(SURFACE, law=law, grading=grading)
        for quantity in ("load", "conductance"):
            alone = [float(model.mean(quantity, x)) for x in h]
            np.testing.assert_allclose(model.mean(quantity, h), alone, rtol=2e-12)


@pytest.mark.parametrize("name", ["exponential", "weibull"])
def test_means_under_other_height_laws(name):
    heights, law, grading = HEIGHTS[name], KogutEtsion(0.05), Exponential(0.2)
    model = Model(SURFACE, law=law, grading=grading, heights=heights)
    for h in (-1.4, 0.3):
        truth = literal(lambda s, h=h: term("load", law, s - h, grading(s)), law, grading, heights, h, 40.0)
        assert reduced(model, "load", h) == pytest.approx(truth, rel=1e-10)


def test_without_cuts_at_the_ends_of_pieces_means_are_wrong(monkeypatch):
    """A rule over a jump of the load: what the cuts are for."""
    monkeypatch.setattr("analytic.height_rule.cuts_of", lambda *_: [])
    off = reduced(Model(SURFACE, law=KogutEtsion(0.05)), "load", 1.0) / 0.05346624148043353 - 1
    assert abs(off) > 1e-6


def test_measured_heights_are_summed():
    heights = MeasuredHeights(np.random.default_rng(3).standard_normal(200))
    law, grading = KogutEtsion(0.05), Exponential(0.2)
    model = Model(SURFACE, law=law, grading=grading, heights=heights)
    s = np.array(heights.heights)
    for quantity in ("load", "yielded", "load_slope"):
        for h in (-0.5, 0.7):
            truth = term(quantity, law, s - h, grading(s)).mean()
            assert reduced(model, quantity, h) == pytest.approx(truth, rel=1e-14)
    step = 1e-6
    values = model.mean("load", [0.7 - step, 0.7 + step])
    assert float(model.slope("load", 0.7)) == pytest.approx((values[0] - values[1]) / 2e-6, rel=1e-7)
    np.testing.assert_allclose(model.separation_at("load", model.mean("load", [0.7, 1.5])), [0.7, 1.5])


# Fluctuations


def test_cumulants_are_literal_moments():
    law, grading, n = KogutEtsion(0.05), Exponential(0.2), 70.0
    model = Model(SURFACE, law=law, grading=grading, n_asperities=n)
    for quantity in ("load", "area", "yielded"):
        scale = quantity_of(quantity).scale(SURFACE)
        for h in (-0.4, 1.2):
            m1, m2, m3 = (
                literal(
                    lambda s, k=k, h=h: term(quantity, law, s - h, grading(s)) ** k,  # noqa: B023
                    law,
                    grading,
                    Gaussian(),
                    h,
                )
                for k in (1, 2, 3)
            )
            fixed = model.cumulants(quantity, h)
            assert float(fixed.variance) == pytest.approx(n * scale**2 * (m2 - m1**2), rel=1e-10)
            k3 = m3 - 3 * m2 * m1 + 2 * m1**3
            assert float(fixed.skewness) == pytest.approx(k3 / (m2 - m1**2) ** 1.5 / n**0.5, rel=1e-9)
            poisson = replace(model, count="poisson").cumulants(quantity, h)
            assert float(poisson.variance) == pytest.approx(n * scale**2 * m2, rel=1e-10)


def test_covariance_across_separations_is_literal():
    law, grading = KogutEtsion(0.05), Exponential(0.2)
    model = Model(SURFACE, law=law, grading=grading, count="poisson", n_asperities=1.0)
    h = np.array([0.2, 0.25, 0.25 + 1e-9, 1.1])  # the second is where asperities yield under the first
    matrix = model.covariance(["load", "yielded", "load_slope"], h)
    scale = quantity_of("load").scale(SURFACE)

    def ends(s):
        return [x for level in h for x in found_by_hand(law, grading, level, level, 9.5) if x > s]

    for i, j in ((0, 1), (1, 2), (0, 3), (1, 3)):
        edges = np.unique([h[j], *ends(h[j]), *(h[j] + 4.0**-k for k in range(16)), 9.5])

        def integrand(s, i=i, j=j):
            s = np.array(s)
            both = term("load", law, s - h[i], grading(s)) * term("yielded", law, s - h[j], grading(s))
            return float(both * Gaussian().density(s))

        truth = math.fsum(quad(integrand, a, b, epsabs=1e-17, epsrel=1e-12)[0] for a, b in pairwise(edges))
        assert matrix[0, i, 1, j] / scale == pytest.approx(truth, rel=1e-9)
    for k, quantity in enumerate(("load", "yielded", "load_slope")):
        np.testing.assert_allclose(np.diag(matrix[k, :, k, :]), model.std(quantity, h) ** 2, rtol=1e-11)


# Slopes


def differences(model, quantity, h, step=4e-3):
    """-d mean/dh by differences of the eighth order: the mean is smooth, jumps are smeared over heights."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    up = model.mean(quantity, h + step * np.array(list(weights)))
    down = model.mean(quantity, h - step * np.array(list(weights)))
    return float((down - up) @ np.array(list(weights.values())) / step)


SMOOTH = {name: GRADINGS[name] for name in ("uniform", "soft tips", "stiff tips")}


@pytest.mark.parametrize("grading", SMOOTH.values(), ids=SMOOTH)
@every_law
@pytest.mark.parametrize("quantity", ["load", "area", "contacts"])
def test_slopes_count_the_jumps(law, grading, quantity):
    model = Model(SURFACE, law=law, grading=grading)
    for h in (0.3, 1.0):
        assert float(model.slope(quantity, h)) == pytest.approx(differences(model, quantity, h), rel=1e-10)


@pytest.mark.parametrize(
    "law",
    [
        laws.KogutEtsion(critical=0.05, bridge="hermite"),
        laws.ZhaoMaiettaChang(critical=0.05),
        laws.JacksonGreen(yield_strength=4e6),
        laws.Coated(ratio=3.0, reduced_thickness=0.5),
    ],
    ids=["bridged", "zhao", "jackson", "coated"],
)
def test_slopes_of_the_laws_of_the_package(law):
    model = Model(replace(SURFACE, radius=1e-3), law=law, grading=Exponential(0.2))
    for quantity in ("load", "area", "stiffness"):
        slope = float(model.slope(quantity, 0.4))
        assert slope == pytest.approx(differences(model, quantity, 0.4), rel=1e-10)


def test_slopes_at_two_crossings_of_one_limit():
    """Soft tips (gamma = 0) yield between two heights: asperities jump at the upper one as well."""
    model = Model(SURFACE, law=ChangEtsionBogy(0.05), grading=Exponential(0.0))
    for quantity in ("load", "yielded"):
        slope = float(model.slope(quantity, 0.2))
        assert slope == pytest.approx(differences(model, quantity, 0.2), rel=1e-10)


def test_slope_with_jumps_of_the_modulus():
    """Asperities beyond a jump of the modulus yield at its height whatever the separation: no term."""
    grading = Custom(lambda s: np.where(s > 1.0, 0.5, 1.0), breaks=(1.0,))
    model = Model(SURFACE, law=ChangEtsionBogy(0.3), grading=grading)
    for h in (0.2, 0.5, 0.9):  # of the two limits 0.3 and 1.2: one below the jump, or the jump itself
        assert float(model.slope("load", h)) == pytest.approx(differences(model, "load", h), rel=1e-10)
    loads = model.mean("load", np.linspace(-2, 4, 121))
    assert np.all(np.diff(loads) < 0)


@pytest.mark.parametrize("gamma", [1.0, 2.0])
def test_without_the_jumps_slopes_are_wrong(gamma):
    model = Model(SURFACE, law=ChangEtsionBogy(0.05), grading=Exponential(gamma))
    slope = float(model.slope("load", 1.0))
    within = 1.5 * reduced(model, "load_slope", 1.0) * model.number * quantity_of("load").scale(SURFACE)
    assert slope == pytest.approx(differences(model, "load", 1.0), rel=1e-10)
    assert within < 0.996 * slope  # the jumps at yield are 1.3 % of it, 0.5 % where tips are stiff


def test_check_values_of_slopes():
    """physics.md, 0: Chang's law with a critical penetration of 0.05 at h = 1."""
    model = Model(SURFACE, law=ChangEtsionBogy(0.05))
    load = model.number * quantity_of("load").scale(SURFACE)
    assert float(model.slope("load", 1.0)) / load == pytest.approx(0.1024253228584864, rel=1e-12)
    assert 1.5 * reduced(model, "load_slope", 1.0) == pytest.approx(0.1011402426250286, rel=1e-12)
    graded = replace(model, grading=Exponential(2.0))
    assert float(graded.slope("load", 1.0)) / load == pytest.approx(0.10492023, abs=5e-9)


def test_slopes_of_quantities_that_start_at_once():
    """Under Hertz's law too: the number of contacts falls by the density at the separation."""
    model = Model(SURFACE, grading=Exponential(0.2))
    assert float(model.slope("contacts", 0.7)) == pytest.approx(
        1000 * math.exp(-0.245) / math.sqrt(2 * math.pi), rel=1e-13
    )
    for quantity in ("stiffness", "conductance"):
        assert float(model.slope(quantity, 0.7)) == pytest.approx(
            differences(model, quantity, 0.7), rel=1e-10
        )


# The separation of a load


@pytest.mark.parametrize("heights", HEIGHTS.values(), ids=HEIGHTS)
def test_separations_belong_to_means(heights):
    model = Model(SURFACE, law=KogutEtsion(0.05), grading=Exponential(0.2), heights=heights)
    h = np.array([[-2.0], [15.0]])
    np.testing.assert_allclose(model.separation_at("load", model.mean("load", h)), h, rtol=1e-12)


def test_a_pressure_has_the_separation_of_its_load():
    model = Model(SURFACE, law=KogutEtsion(0.05), grading=Exponential(2.0))
    pressure = float(model.mean("pressure", 0.4))
    assert float(model.mean("load", 0.4)) == pytest.approx(pressure * SURFACE.nominal_area, rel=1e-14)
    assert float(model.separation_at("pressure", pressure)) == pytest.approx(0.4, abs=1e-12)


@every_grading
@every_law
def test_loads_fall_as_the_surface_goes_away(law, grading):
    loads = Model(SURFACE, law=law, grading=grading).mean("load", np.linspace(-1.5, 5, 40))
    assert np.all(np.diff(loads) < 0)


def test_values_beyond_reach_are_refused_in_one_line():
    model = Model(SURFACE, law=KogutEtsion(0.05))
    with pytest.raises(ValueError, match="contacts: not reached between h = -40 and 3"):
        model.separation_at("contacts", 1001.0)
    with pytest.raises(ValueError, match="give finite values > 0"):
        model.separation_at("load", -1.0)


# Who yields


def test_shares_of_the_pieces_are_shares_of_heights():
    """Homogeneous: beyond fixed penetrations. Graded: above the root of s - h = dc/e(s)^2."""
    h, dc = 0.4, 0.05
    law = KogutEtsion(dc)
    above = Gaussian().above
    ends = h + dc * np.array([0.0, 1.0, 6.0, 110.0, np.inf])
    shares = [float(Model(SURFACE, law=law).share(piece, h)) for piece in range(4)]
    truth = -np.diff(above(ends)) / above(np.array(h))
    np.testing.assert_allclose(shares, truth, rtol=1e-11)
    model = Model(SURFACE, law=law, grading=Exponential(0.2))
    t = brentq(lambda s: s - h - dc / (0.2 + 0.8 * math.exp(-s)) ** 2, h, 3, xtol=1e-15)
    assert float(model.share(0, h)) == pytest.approx(
        1 - float(above(np.array(t)) / above(np.array(h))), 1e-11
    )
    yielded = model.mean("yielded", h) / model.mean("contacts", h)
    assert float(sum(model.share(piece, h) for piece in (1, 2, 3))) == pytest.approx(
        float(yielded), rel=1e-13
    )


# Limits, and Hertz


def test_hertz_named_is_hertz_left_out():
    h = np.linspace(-2, 4, 9)
    named, left_out = (Model(SURFACE, grading=Exponential(0.2), law=law) for law in (ContactLaw(), None))
    for quantity in analytic.QUANTITIES:
        np.testing.assert_array_equal(named.mean(quantity, h), left_out.mean(quantity, h))
        np.testing.assert_array_equal(named.std(quantity, h), left_out.std(quantity, h))
    np.testing.assert_array_equal(named.slope("load", h), left_out.slope("load", h))
    np.testing.assert_allclose(named.mean("load_slope", h), named.mean("stiffness", h), rtol=1e-12)
    np.testing.assert_allclose(named.std("load_slope", h), named.std("stiffness", h), rtol=1e-12)
    np.testing.assert_array_equal(named.mean("yielded", h), 0.0)
    np.testing.assert_array_equal(named.share(0, h), 1.0)


@every_grading
def test_what_hardly_yields_is_elastic(grading):
    h = np.linspace(-1, 4, 6)
    late = Model(SURFACE, law=KogutEtsion(1e9), grading=Clipped(grading))
    hertz = replace(late, law=None)
    for quantity in analytic.QUANTITIES:
        np.testing.assert_allclose(late.mean(quantity, h), hertz.mean(quantity, h), rtol=1e-12)


def test_what_yields_at_once_is_plastic():
    """P = 2 pi R delta H: the load of all is 3 sqrt(dc)/K times the mean penetration."""
    dc, h = 1e-9, np.array([0.0, 2.0])
    model = Model(SURFACE, law=KogutEtsion(dc))
    n = model.number
    load = n * quantity_of("load").scale(SURFACE) * 3 * math.sqrt(dc) / 0.577 * analytic.fn(1, h)
    np.testing.assert_allclose(model.mean("load", h), load, rtol=1e-6)
    area = n * quantity_of("area").scale(SURFACE) * 2 * analytic.fn(1, h)
    np.testing.assert_allclose(model.mean("area", h), area, rtol=1e-6)


# What is refused


def test_negative_moduli_do_not_yield():
    model = Model(SURFACE, law=KogutEtsion(0.05), grading=Exponential(2.0))
    assert np.isfinite(model.mean("load", 0.0))
    with pytest.raises(
        ValueError, match=r"grading: E\*\(s\)/E\* = -.* needs a modulus >= 0; clip it"
    ) as told:
        model.mean("load", -1.0)
    assert "\n" not in str(told.value)
    elastic = Model(SURFACE, law=HalfSpace(0.5), grading=Exponential(2.0))
    assert np.isfinite(elastic.mean("load", -1.0))


def test_questions_without_an_answer_are_refused():
    model = Model(SURFACE, law=KogutEtsion(0.05))
    with pytest.raises(ValueError, match="load_slope"):
        model.slope("load_slope", 0.0)
    with pytest.raises(ValueError, match="every separation must be finite"):
        model.mean("load", math.nan)
    with pytest.raises(KeyError, match="load_slope, conductance_si, yielded"):
        model.mean("force", 0.0)


def test_unloading_is_known_where_nothing_yields():
    h = np.array([0.3, 1.0])
    for law in (None, HalfSpace(0.25)):
        model = Model(SURFACE, law=law)
        np.testing.assert_array_equal(model.mean("load_unloading", h), model.mean("load", h))
        np.testing.assert_array_equal(model.std("load_unloading", h), model.std("load", h))
        np.testing.assert_array_equal(model.slope("load_unloading", h), model.slope("load", h))
    model = Model(SURFACE, law=KogutEtsion(0.05))
    for question in (model.mean, model.slope, model.std, model.separation_at):
        with pytest.raises(ValueError, match="law = 'by hand: kogut-etsion': its unloading is not known"):
            question("load_unloading", 0.5)


def test_constants_are_asked_for_when_the_model_is_made():
    class Unfinished(KogutEtsion):
        def on(self, surface):  # noqa: ARG002
            raise ValueError("critical: give it")

    with pytest.raises(ValueError, match="critical: give it"):
        Model(SURFACE, law=Unfinished())


def test_laws_are_bound_to_the_surface():
    class InMetres(KogutEtsion):
        def on(self, surface):
            return KogutEtsion(50e-9 / surface.sigma)

    assert reduced(Model(SURFACE, law=InMetres()), "load", 1.0) == pytest.approx(
        0.05346624148043353, rel=1e-12
    )
