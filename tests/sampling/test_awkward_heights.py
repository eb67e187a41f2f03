"""Height laws with rounding noise, heavy tails, ends that separations pass, and layers that keep contact."""

import tracemalloc
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import scipy.stats
from oracles.laws_of_one_depth import kogut_etsion
from oracles.scenes import scene_by
from scipy.integrate import quad
from scipy.optimize import brentq

import analytic
import mcgw
from analytic.law_rule import law_rule
from analytic.laws.regimes import crossings_of

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
H = (0.0, 1.0, 2.5)
NOISY = (
    scipy.stats.gamma(25), scipy.stats.gamma(1000), scipy.stats.chi2(60), scipy.stats.erlang(30),
    scipy.stats.f(10, 20), scipy.stats.betaprime(3, 20),
)  # fmt: skip


@pytest.mark.parametrize("law", NOISY, ids=lambda law: law.dist.name)
def test_means_and_surfaces_are_literal(law):
    """Theory against quadrature over the law itself, each surface against plain sums over its heights."""
    scene = mcgw.Scene(
        SURFACE,
        separations=H,
        heights=law,
        ensemble=mcgw.Sampling(n_asperities=3000),
        n_surfaces=3,
        seed=1,
        contact=mcgw.Contact(quantities=["load"]),
    )
    ensemble = mcgw.simulate(scene)
    heights = [mcgw.heights(scene, i) for i in range(3)]
    sums = np.array([[np.sum(np.maximum(s - h, 0) ** 1.5) for h in H] for s in heights])
    scale = ensemble.load[0, 0] / sums[0, 0]
    np.testing.assert_allclose(ensemble.load, scale * sums, rtol=1e-12)
    mean, std = law.mean(), law.std()
    integrals = [
        quad(lambda x, h=h: ((x - mean) / std - h) ** 1.5 * law.pdf(x), mean + h * std, np.inf, epsabs=0)[0]
        for h in H
    ]
    np.testing.assert_allclose(scene.theory.mean("load", H), 3000 * scale * np.array(integrals), rtol=1e-7)


@pytest.mark.parametrize(("a", "b"), [(3, 0.5), (0.5, 0.7)])
def test_where_the_density_is_infinite_at_its_upper_end(a, b):
    """Beta: F_n by mpmath, in a power of the distance from the end, as near as heights are told."""
    law = scipy.stats.beta(a, b)
    mean, std, heights = law.mean(), law.std(), mcgw.ScipyHeights(law)
    for n in (0, 1, 1.5):
        for h in (-0.5, 0.5 * heights.support[1]):

            def term(w, n=n, h=h):
                t = 1 - w ** (1 / mpmath.mpf(b))  # so that (1 - t)^(b - 1) dt is dw/b
                return max((t - mean) / std - h, 0) ** n * t ** (a - 1) / b

            known = mpmath.quad(term, [0, (1 - mpmath.mpf(mean + h * std)) ** b]) / mpmath.beta(a, b)
            rounding = 30 * np.finfo(float).eps ** b
            assert analytic.fn(n, h, heights=heights) == pytest.approx(float(known), rel=rounding)


def test_the_tail_of_f_is_that_of_its_sf():
    """The isf of SciPy takes 1 - p: off by a tenth at 1e-16, infinite beyond."""
    law = mcgw.ScipyHeights(scipy.stats.f(10, 20))
    shares = np.array([0.7, 0.2, 1e-9, 1e-16, 1e-30])
    np.testing.assert_allclose(law.sf(law.isf(shares)), shares, rtol=1e-12)


@pytest.mark.parametrize(
    "law",
    [scipy.stats.exponnorm(1.5), scipy.stats.invgauss(0.3), scipy.stats.f(10, 14), scipy.stats.moyal()],
    ids=lambda law: law.dist.name,
)
def test_tails_that_scipy_searches_one_by_one_are_found_at_once(law):
    """SciPy takes 5 ms for each height of the first, and goes to 1e11 for the second; low shares as well."""
    heights, calls = mcgw.ScipyHeights(law), []
    shares = np.concatenate([np.random.default_rng(1).random(2000), [1e-12, 1e-25, 0.5, 1 - 1e-9]])
    heights.isf(shares[:1])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heights.distribution.dist, "_sf", counting(heights.distribution.dist._sf, calls))
        s = heights.isf(shares)
    assert len(calls) < 50  # by halving, 100
    np.testing.assert_allclose(heights.sf(s), shares, rtol=1e-12)


@pytest.mark.parametrize("shape", [0.3, 1e4])
def test_laws_that_begin_flat_are_made_and_right_below_their_support(shape):
    """SciPy loses the rarest low heights of the inverse Gaussian: spans shrink there without end.

    Every height touches, and the mean is an integral over the whole law.
    """
    law = scipy.stats.invgauss(shape)
    mean, std = law.mean(), law.std()
    h = -mean / std - 0.22
    scene = mcgw.Scene(
        SURFACE,
        separations=[h],
        heights=law,
        grading=stiffer,
        ensemble=mcgw.Sampling(n_asperities=300),
        seed=1,
    )

    def under(x):
        s = (x - mean) / std
        return (s - h) ** 1.5 * stiffer(s) * law.pdf(x)

    cuts = [0.0, *law.ppf([1e-9, 1e-3, 0.3, 0.9]), *(mean + std * 3.0 ** np.arange(10))]
    whole = sum(quad(under, a, b, epsabs=0, limit=200)[0] for a, b in pairwise(cuts))
    scale = 4 / 3 * SURFACE.E_star * SURFACE.radius**0.5 * SURFACE.sigma**1.5
    assert scene.theory.mean("load", h) == pytest.approx(300 * scale * whole, rel=1e-9)
    literal = scene.modulus(s := mcgw.heights(scene, 0)) * np.maximum(s - h, 0) ** 1.5
    assert mcgw.simulate(scene, n_surfaces=1).load[0, 0] == pytest.approx(scale * literal.sum(), rel=1e-12)


@pytest.mark.parametrize("law", [scipy.stats.invgauss(0.3), scipy.stats.invgamma(9), scipy.stats.lognorm(1)])
def test_pieces_of_a_law_that_begins_flat_end_whatever_its_ppf(law, monkeypatch):
    heights = mcgw.ScipyHeights(law)
    h, constant = np.array([heights.support[0] - 0.22]), analytic.Custom(np.ones_like)
    wanted = [p @ (s - h) ** n for s, p in [law_rule(heights, h, constant)] for n in (0.0, 1.0, 1.5)]
    monkeypatch.setattr(mcgw.ScipyHeights, "ppf", lambda self, p: np.full_like(p, self.support[0]))
    s, p = law_rule(heights, h, constant)
    assert s.size < 5000
    np.testing.assert_allclose(wanted, [p @ (s - h) ** n for n in (0.0, 1.0, 1.5)], rtol=1e-11)
    np.testing.assert_allclose(wanted[:2], [1.0, -h[0]], rtol=1e-11)


def test_low_heights_that_scipy_loses_are_those_of_its_cdf():
    law = mcgw.ScipyHeights(scipy.stats.invgauss(0.3))
    shares = np.array([0.0, 1e-300, 1e-37, 1e-32, 1e-17, 0.3])
    np.testing.assert_allclose(law.cdf(found := law.ppf(shares)), shares, rtol=1e-6, atol=0)
    assert found[0] == law.support[0]


def counting(function, calls):
    def counted(*args):
        calls.append(1)
        return function(*args)

    return counted


@pytest.mark.parametrize(
    ("shape", "h", "digits"), [(5, 1, 1e-12), (5, 8, 1e-12), (1, 9, 1e-11), (20, 12, 1e-6)]
)
def test_tails_that_scipy_loses_altogether_are_those_of_the_density(shape, h, digits):
    """Rice: sf is 1 - cdf and isf infinite below 1e-16, but the density is good. Against mpmath."""
    law = scipy.stats.rice(shape)
    theory = mcgw.Scene(
        SURFACE, separations=0.0, heights=law, ensemble=mcgw.Sampling(n_asperities=3000), seed=1
    ).theory

    def mean(h):
        with mpmath.workdps(25):
            start = mpmath.mpf(law.mean()) + h * mpmath.mpf(law.std())

            def under(x):
                density = x * mpmath.exp(-(x * x + shape * shape) / 2) * mpmath.besseli(0, x * shape)
                return ((x - start) / law.std()) ** 1.5 * density

            return float(mpmath.quad(under, [start, start + 0.5, start + 2, start + 6, start + 20]))

    found = theory.mean("load", h) / theory.mean("load", 0.5)
    assert found == pytest.approx(mean(h) / mean(0.5), rel=digits)
    assert theory.mean("contacts", float(theory.separation_at("load", 1.0))) > 0


def stiffer(s):
    return 1 + 0.5 * np.tanh(s)


@pytest.mark.parametrize("freedom", [3.5, 6.0])
@pytest.mark.parametrize("unload_from", [None, -1.0])
def test_theory_takes_little_memory_and_is_right(freedom, unload_from):
    heights, critical = scipy.stats.t(freedom), 0.1
    law = mcgw.KogutEtsion(critical=critical)
    scene = mcgw.Scene(
        SURFACE,
        separations=[0.0, 1.0],
        grading=stiffer,
        heights=heights,
        law=law,
        contact=mcgw.Contact(unload_from=unload_from, quantities=["area"]),
        ensemble=mcgw.Sampling(n_asperities=1000),
        seed=1,
    )
    tracemalloc.start()
    found = scene.theory.mean("area", 1.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2**26

    std = heights.std()

    def term(s):
        return kogut_etsion(s - 1.0, stiffer(s), critical)[1] * std * heights.pdf(std * s)

    ends = np.array([1.0, 1.2, 1.4, 2.0, 4.0, 7.0, 12.0, 30.0, 1e3, 1e5, 1e8])
    # Where a piece begins there is a small jump: the quadrature is told where.
    s = np.linspace(1, 40, 400_001)
    u = (s - 1.0) * stiffer(s) ** 2 / critical
    ends = np.unique([*ends, *(s[np.searchsorted(u, limit)] for limit in (1, 6, 110))])
    pieces = [quad(term, a, b, epsabs=0, limit=200)[0] for a, b in pairwise(ends)]
    scale = 1000 * np.pi * SURFACE.radius * SURFACE.sigma
    assert found == pytest.approx(scale * sum(pieces), rel=1e-5)


FEW = {"n_asperities": 500, "n_surfaces": 4, "seed": 3, "quantities": ["load", "area"]}


def stiffening(s):
    return 1 + 0.3 * np.tanh(s)


def test_a_function_is_resolved_down_to_where_the_way_back_begins():
    """On the surface's own heights: elastic spots lose nothing on the way back."""
    law = mcgw.KogutEtsion(critical=1e3)
    scene = scene_by(SURFACE, separations=[0.5, 2.0], grading=stiffening, law=law, unload_from=-1.0, **FEW)
    ensemble = mcgw.simulate(scene)
    np.testing.assert_allclose(ensemble["load_unloading"], ensemble.load, rtol=1e-12)
    assert mcgw.scene_from(mcgw.scene_text(ensemble.scene)) == ensemble.scene


@pytest.mark.parametrize("peak", np.linspace(0.9, 1.6, 57))
def test_a_narrow_interval_is_found_wherever_its_peak_lies(peak):
    """Between two heights looked at, on one of them, and where one stretch ends and the next begins."""
    level, half = 0.99, np.sqrt(0.01 / 30)
    found = crossings_of(
        lambda s, _: s - (1 - 30 * (s - peak) ** 2), analytic.Custom(lambda s: 1 + 0 * s), np.array([level]),
        0.0, 3.0,
    )  # fmt: skip
    np.testing.assert_allclose(found.height, [peak - half, peak + half], rtol=1e-12)


def test_contacts_on_the_way_back_where_a_soft_layer_keeps_them():
    """Against the residual penetration of Etsion, Kligerman and Kadin, and the law of SciPy itself."""
    deepest, h, critical, law = -5.81, -3.3948, 0.2025, scipy.stats.lognorm(0.25)

    def modulus(s):
        return 1 + 2.469 * np.tanh(s - 1.469) ** 2

    def excess(s):
        ratio = (s - deepest) / (critical / modulus(s) ** 2)
        return s - h - (s - deepest) * (1 - ratio**-0.28) * (1 - ratio**-0.69)

    ends = [law.mean() + law.std() * brentq(excess, *x) for x in ((0.8, 1.3), (1.6, 2.3), (8, 11))]
    expected = law.cdf(ends[1]) - law.cdf(ends[0]) + law.sf(ends[2])
    scene = mcgw.Scene(
        SURFACE,
        separations=[h],
        grading=modulus,
        heights=law,
        law=mcgw.KogutEtsion(critical=critical),
        contact=mcgw.Contact(unload_from=deepest, quantities=["contacts"]),
        ensemble=mcgw.Sampling(n_asperities=30),
        seed=1,
    )
    assert scene.theory.mean("contacts_unloading", h) == pytest.approx(30 * expected, rel=1e-9)
