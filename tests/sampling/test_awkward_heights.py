"""Height laws with rounding noise, heavy tails, ends that separations pass, and layers that keep contact."""

import tracemalloc
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import scipy.stats
from oracles.scenes import scene_by
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ive

import analytic
import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
H = (0.0, 1.0, 2.5)


@pytest.mark.parametrize(
    "law", [scipy.stats.gamma(1000), scipy.stats.betaprime(3, 20)], ids=("gamma", "betaprime")
)
def test_means_and_surfaces_are_literal(law):
    """Theory against quadrature over the law itself, each surface against plain sums over its heights."""
    scene = scene_by(
        SURFACE, separations=H, heights=law, n_asperities=3000, n_surfaces=3, seed=1, quantities=["load"]
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


@pytest.mark.parametrize(
    "law",
    [
        scipy.stats.exponnorm(1.5),
        scipy.stats.invgauss(0.3),
        scipy.stats.f(10, 14),
        scipy.stats.moyal(),
        scipy.stats.norminvgauss(1.0, 0.5),
    ],
    ids=lambda law: law.dist.name,
)
def test_heights_of_all_shares_are_those_of_the_tail(law):
    """SciPy goes to 1e11 for the second, takes 1 - p of the third, and fails for the last at 1e-16."""
    heights = mcgw.ScipyHeights(law)
    shares = np.array([1 - 1e-9, 0.7, 0.5, 0.2, 1e-9, 1e-12, 1e-16, 1e-25, 1e-30])
    np.testing.assert_allclose(heights.sf(heights.isf(shares)), shares, rtol=1e-12)


@pytest.mark.parametrize("shape", [0.3, 1e4])
def test_laws_that_begin_flat_are_made_and_right_below_their_support(shape):
    """SciPy loses the rarest low heights of the inverse Gaussian: spans shrink there without end.

    Every height touches, and the mean is an integral over the whole law.
    """
    law = scipy.stats.invgauss(shape)
    mean, std = law.mean(), law.std()
    h = -mean / std - 0.22
    scene = scene_by(SURFACE, separations=[h], heights=law, grading=stiffer, n_asperities=300, seed=1)

    def under(x):
        s = (x - mean) / std
        return (s - h) ** 1.5 * stiffer(s) * law.pdf(x)

    cuts = [0.0, *law.ppf([1e-9, 1e-3, 0.3, 0.9]), *(mean + std * 3.0 ** np.arange(10))]
    whole = sum(quad(under, a, b, epsabs=0, limit=200)[0] for a, b in pairwise(cuts))
    scale = 4 / 3 * SURFACE.E_star * SURFACE.radius**0.5 * SURFACE.sigma**1.5
    assert scene.theory.mean("load", h) == pytest.approx(300 * scale * whole, rel=1e-9)
    literal = scene.modulus(s := mcgw.heights(scene, 0)) * np.maximum(s - h, 0) ** 1.5
    assert mcgw.simulate(scene, n_surfaces=1).load[0, 0] == pytest.approx(scale * literal.sum(), rel=1e-12)


def test_low_heights_that_scipy_loses_are_those_of_its_cdf():
    law = mcgw.ScipyHeights(scipy.stats.invgauss(0.3))
    shares = np.array([0.0, 1e-300, 1e-37, 1e-32, 1e-17, 0.3])
    np.testing.assert_allclose(law.cdf(found := law.ppf(shares)), shares, rtol=1e-6, atol=0)
    assert found[0] == law.support[0]


@pytest.mark.parametrize(("shape", "h", "digits"), [(5, 8, 1e-12), (20, 12, 1e-6)])
def test_tails_that_scipy_loses_altogether_are_those_of_the_density(shape, h, digits):
    """Rice: sf is 1 - cdf and isf infinite below 1e-16, but the density is good. Against quadrature."""
    law = scipy.stats.rice(shape)
    theory = scene_by(SURFACE, separations=0.0, heights=law, n_asperities=3000, seed=1).theory

    def mean(h):
        start = law.mean() + h * law.std()

        def under(x):
            density = x * np.exp(-((x - shape) ** 2) / 2) * ive(0, x * shape)
            return ((x - start) / law.std()) ** 1.5 * density

        ends = start + np.array([0.0, 0.5, 2.0, 6.0, 20.0])
        return sum(quad(under, a, b, epsabs=0, epsrel=1e-13)[0] for a, b in pairwise(ends))

    found = theory.mean("load", h) / theory.mean("load", 0.5)
    assert found == pytest.approx(mean(h) / mean(0.5), rel=digits)
    assert theory.mean("contacts", float(theory.separation_at("load", 1.0))) > 0


def stiffer(s):
    return 1 + 0.5 * np.tanh(s)


@pytest.mark.parametrize(("freedom", "unload_from"), [(3.5, None), (6.0, -1.0)])
def test_theory_of_heavy_tails_takes_little_memory(freedom, unload_from):
    scene = scene_by(
        SURFACE, separations=[0.0, 1.0], heights=scipy.stats.t(freedom), law=mcgw.KogutEtsion(critical=0.1),
        grading=stiffer, unload_from=unload_from, quantities=["area"], n_asperities=1000, seed=1,
    )  # fmt: skip
    tracemalloc.start()
    scene.theory.mean("area", 1.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2**26


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
    scene = scene_by(
        SURFACE, separations=[h], heights=law, law=mcgw.KogutEtsion(critical=critical), grading=modulus,
        unload_from=deepest, quantities=["contacts"], n_asperities=30, seed=1,
    )  # fmt: skip
    assert scene.theory.mean("contacts_unloading", h) == pytest.approx(30 * expected, rel=1e-9)
