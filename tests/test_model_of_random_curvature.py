"""`Model` of summits with radii of their own: exact values, literal sums over drawn summits, wrong versions.

Summits are drawn by rejection here (three numbers and a Rayleigh one; nothing is inverted). Means, products
and cubes of what they add are compared by z over independent blocks; |z| < 4 for fixed seeds, a false alarm
of 6e-5 each. The area has no fourth moment (its cube no variance), so variances are compared where radii
have a bound, with one that changes them.
"""

import math
from dataclasses import replace

import laws_by_hand
import numpy as np
import pytest

import analytic
from analytic import (
    Exponential,
    ExponentialHeights,
    KogutEtsion,
    Model,
    Nayak,
    RandomCurvature,
    SpectralMoments,
)
from analytic.curvature import MEAN_CURVATURE
from analytic.laws import LoadingBranch, term_of
from analytic.summits import over_radii, random_fluctuations

ALPHA = 2.0
MOMENTS = SpectralMoments(1e-12, 1e-3, ALPHA * 1e6)
SURFACE = MOMENTS.surface(1e-8, 1e9)
H = np.array([-1.0, 0.4, 1.5])
NAMES = ("load", "area", "stiffness", "contacts", "conductance")


def model(largest=math.inf, **own):
    return Model(SURFACE, heights=Nayak(ALPHA), curvature=RandomCurvature(ALPHA, largest), **own)


def summits(n, alpha=ALPHA, seed=4):
    """Reduced heights and radius ratios, by rejection."""
    rng = np.random.default_rng(seed)
    tau = np.sqrt(2 * rng.chisquare(3, n))
    square = 2 * rng.standard_exponential(n)
    kept = rng.random(n) < 1 - square / tau**2
    tau, g = tau[kept], np.sqrt(tau[kept] ** 2 - square[kept])
    rho = math.sqrt(1.5 / alpha)
    x = rho / math.sqrt(2) * tau + math.sqrt(1 - rho * rho) * rng.standard_normal(tau.size)
    sd = math.sqrt(1 - (1 + 16 / math.pi - 3 * math.sqrt(3)) / alpha)
    return (x - 4 / math.sqrt(math.pi * alpha)) / sd, 8 / math.sqrt(3 * math.pi) / g


def added(name, s, c, h, gamma):
    """What summits add at separations: literally Hertz's formulas, each with its own radius, SI."""
    depth = np.maximum(s[:, None] - h, 0.0) * SURFACE.sigma
    radius, touch = c[:, None] * SURFACE.radius, s[:, None] > h
    stiff = SURFACE.E_star * (gamma - (gamma - 1) * np.exp(-s[:, None]))
    return {
        "load": 4 / 3 * stiff * np.sqrt(radius) * depth**1.5,
        "area": math.pi * radius * depth,
        "stiffness": 2 * stiff * np.sqrt(radius * depth),
        "contacts": 1.0 * touch,
        "conductance": 4 * np.sqrt(radius * depth),
    }[name]


def z_of(values, exact):
    """Deviations of means from exact ones in standard errors."""
    return (values.mean(axis=0) - exact) / (values.std(axis=0) / math.sqrt(len(values)))


def test_means_are_the_check_values():
    """A, P, K per summit at x = 2 (`test_summit_curvature` has where they come from), in SI."""
    law, q, m = Nayak(ALPHA), math.sqrt(MOMENTS.m4 / 3), model()
    h, n, m0 = (2 - law.mean) / law.std, SURFACE.n_asperities, MOMENTS.m0
    assert float(m.mean("contacts", h)) / n == pytest.approx(0.2852230161151171, rel=1e-12)
    area = math.pi * m0**0.5 / q
    assert float(m.mean("area", h)) / n / area == pytest.approx(0.04260601204160218, rel=1e-12)
    load = 4 / 3 * SURFACE.E_star * m0**0.75 * q**-0.5
    assert float(m.mean("load", h)) / n / load == pytest.approx(0.06566624072252187, rel=1e-12)
    stiffness = 2 * SURFACE.E_star * m0**0.25 * q**-0.5
    assert float(m.mean("stiffness", h)) / n / stiffness == pytest.approx(0.1018374596744787, rel=1e-12)


@pytest.mark.parametrize("gamma", [1.0, 1.6])
def test_means_and_covariances_of_drawn_summits(gamma):
    m, (s, c) = model(largest=3.0, grading=Exponential(gamma), count="poisson"), summits(500_000)
    c = np.minimum(c, 3.0)
    n, columns = SURFACE.n_asperities, [added(name, s, c, H, gamma) for name in NAMES]
    for name, f in zip(NAMES, columns, strict=True):
        assert np.abs(z_of(f, m.mean(name, H) / n)).max() < 4, name
    exact = m.covariance(NAMES, H).reshape(15, 15) / n  # a Poisson number of summits: mean products
    f = np.concatenate(columns, axis=1)
    for i in range(15):
        assert np.abs(z_of(f * f[:, [i]], exact[i])).max() < 4.5, i


def test_another_law_of_radii_fails_the_same_test():
    """Companion: one radius, radii that know nothing of the height, no bound."""
    m, (s, c) = model(largest=3.0), summits(500_000)
    n = SURFACE.n_asperities
    shuffled = np.random.default_rng(1).permutation(c)
    for wrong in (np.ones_like(c), np.minimum(shuffled, 3.0), c):
        assert np.abs(z_of(added("area", s, wrong, H, 1.0), m.mean("area", H) / n)).max() > 5


def test_third_cumulants_of_drawn_summits():
    """Of loads, whose cubes have a variance."""
    m, (s, c) = model(count="poisson"), summits(500_000)
    n, exact = SURFACE.n_asperities, m.cumulants("load", H)
    cubes = added("load", s, c, H, 1.0) ** 3
    assert np.abs(z_of(cubes, exact.skewness * exact.variance**1.5 / n)).max() < 4


def test_the_kurtosis_of_the_area_is_infinite_unless_radii_have_a_bound():
    m = model()
    assert np.all(np.isinf(m.cumulants("area", H).excess_kurtosis))
    assert np.all(np.isfinite(m.cumulants("load", H).excess_kurtosis))
    bounded = [model(largest).cumulants("area", H).excess_kurtosis for largest in (10.0, 1e3, 1e5)]
    rises = np.diff(bounded, axis=0)
    assert np.all(rises > 0)
    assert rises[1] == pytest.approx(rises[0], rel=0.2)  # like the logarithm of the bound
    combined = m.fluctuations(["load", "area"], H).turned(np.eye(6)[:, [0, 3]] @ np.array([[1.0, 1], [0, 1]]))
    assert np.isinf(combined.moment(4)).tolist() == [False, True]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_moments_by_curvatures_one_by_one(count):
    """Rules of four radii at each height against integrals over the curvature, each of one radius."""
    m = model(count=count, grading=Exponential(1.6))
    for name in ("load", "area"):
        one_by_one = over_radii(m, H, lambda one, name=name: one.mean(name, H))
        assert one_by_one == pytest.approx(m.mean(name, H), rel=1e-12)
    by_rule = m.fluctuations(["load", "area"], H)
    one_by_one = random_fluctuations(m, ["load", "area"], H, powers=False)
    np.testing.assert_allclose(one_by_one.products(), by_rule.products(), rtol=1e-12)
    np.testing.assert_allclose(one_by_one.moment(3), by_rule.moment(3), rtol=1e-11)


@pytest.mark.parametrize("name", NAMES)
def test_slopes_and_inverses(name):
    m, step = model(grading=Exponential(1.6)), 1e-4
    difference = (m.mean(name, H - step) - m.mean(name, H + step)) / (2 * step)
    assert m.slope(name, H) == pytest.approx(difference, rel=3e-7)
    assert m.separation_at(name, m.mean(name, H)) == pytest.approx(H, abs=1e-12)
    assert m.mean("pressure", H) * SURFACE.nominal_area == pytest.approx(m.mean("load", H), rel=1e-14)
    assert m.std(name, H) ** 2 == pytest.approx(m.cumulants(name, H).variance, rel=1e-14)


def test_large_alpha_is_the_gaussian_surface_with_independent_radii():
    wide = Model(SURFACE, heights=Nayak(1e9), curvature=RandomCurvature(1e9))
    gaussian = Model(SURFACE)
    for name, power in (("load", 0.5), ("area", 1), ("contacts", 0)):
        factor = float(RandomCurvature(1e9).mean(power, 0.0))
        assert wide.mean(name, H) == pytest.approx(factor * gaussian.mean(name, H), rel=1e-3)


HARDNESS = 2e7


def yielded(name, s, c, h, critical):
    """Sums under Kogut and Etsion's formulas, typed in for the tests; each summit yields at its own depth."""
    total = np.zeros((s.size, h.size))
    for k in range(s.size):
        law = laws_by_hand.KogutEtsion(critical=critical * c[k])
        total[k] = term_of(name, LoadingBranch(law), h, s[k], 1.0)
    unit = {"load": np.sqrt(c), "area": c, "contacts": np.ones_like(c)}[name]
    return unit[:, None] * total * analytic.quantity_of(name).scale(SURFACE)


@pytest.fixture(scope="module")
def plastic():
    law = KogutEtsion(hardness=HARDNESS, poisson=0.3)
    return model(law=law), law.on(SURFACE).critical


@pytest.mark.parametrize("name", ["load", "area"])
def test_summits_that_yield_each_at_its_own_depth(plastic, name):
    m, critical = plastic
    s, c = summits(40_000)
    assert 0.02 < critical < 0.5  # all pieces of the law count
    z = z_of(yielded(name, s, c, H, critical), m.mean(name, H) / SURFACE.n_asperities)
    assert np.abs(z).max() < 4
    wrong = z_of(yielded(name, s, np.ones_like(c), H, critical), m.mean(name, H) / SURFACE.n_asperities)
    assert np.abs(wrong).max() > 5


def test_summits_that_yield_have_variances_and_separations(plastic):
    m, critical = plastic
    m, h = replace(m, count="poisson"), np.array([1.0])
    s, c = summits(40_000)
    exact = m.cumulants("load", h)
    f = yielded("load", s, c, h, critical)
    assert np.abs(z_of(f**2, exact.variance / SURFACE.n_asperities)).max() < 4
    assert exact.mean == pytest.approx(m.mean("load", h), rel=1e-11)
    reduced = replace(m, law=KogutEtsion(critical=critical, poisson=0.3))  # of a summit of the radius R
    assert reduced.mean("load", h) == pytest.approx(m.mean("load", h), rel=1e-13)
    assert m.separation_at("load", exact.mean) == pytest.approx(h, abs=1e-10)
    step = 1e-4
    slope = (m.mean("load", h - step) - m.mean("load", h + step)) / (2 * step)
    assert m.slope("load", h) == pytest.approx(slope, rel=1e-6)
    shares = [float(m.share(piece, h)[0]) for piece in range(4)]
    assert sum(shares) == pytest.approx(1, rel=1e-11)
    touch = s > h
    assert z_of((s[touch] - h < critical * c[touch])[:, None], shares[0])[0] == pytest.approx(0, abs=4)


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match=r"give heights = Nayak\(alpha=2.0\)"):
        Model(SURFACE, curvature=RandomCurvature(ALPHA))
    with pytest.raises(ValueError, match="heights"):
        Model(SURFACE, heights=ExponentialHeights(), curvature=RandomCurvature(ALPHA))
    assert pytest.approx(8 / math.sqrt(3 * math.pi)) == MEAN_CURVATURE
