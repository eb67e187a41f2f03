"""`Model` of individual summit radii, against a literal double sum over their heights and curvatures.

The density of the curvature at a height is typed in here (`analytic.curvature` says where it comes from), the
formulas of Hertz and of Kogut and Etsion as well. `test_summit_curvature` has drawn summits.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import log_ndtr

from analytic import (
    Exponential,
    JohnsonKendallRoberts,
    KogutEtsion,
    Model,
    Nayak,
    RandomCurvature,
    SpectralMoments,
    quantity_of,
)
from analytic.curvature import MEAN_CURVATURE
from analytic.laws import Coated

ALPHA = 5.0
MOMENTS = SpectralMoments(1e-12, 1e-3, ALPHA * 1e6)
SURFACE = MOMENTS.surface(1e-8, 1e9)
H = np.array([-1.0, 0.4, 1.5])
NAMES = ("load", "area", "stiffness", "contacts", "conductance")
GRADED = Exponential(1.6)


def model(largest=math.inf, **own):
    return Model(SURFACE, heights=Nayak(ALPHA), curvature=RandomCurvature(ALPHA, largest), **own)


def panels(marks, points):
    """Points and weights of Gauss's rule on each of the pieces, along the last axis."""
    x, w = np.polynomial.legendre.leggauss(points)
    a, b = marks[..., :-1, None], marks[..., 1:, None]
    shape = (*marks.shape[:-1], -1)
    return (a + (b - a) * (1 + x) / 2).reshape(shape), ((b - a) / 2 * w).reshape(shape)


def summits(h, yields=(), points=12):
    """Heights above h, radius ratios, probabilities; cut where ``s - h`` is `yields` times the ratio."""
    law = Nayak(ALPHA)
    v, dv = panels(np.linspace(0, math.sqrt(12 - h), 13), points)
    s = h + v * v
    rho = math.sqrt(1.5 / ALPHA)
    mu, var = math.sqrt(2) * rho * (law.mean + law.std * s)[:, None], 2 * (1 - rho**2)
    ends = [MEAN_CURVATURE * x / (s - h) for x in yields] + [np.full_like(s, MEAN_CURVATURE / 3)]
    grid = np.broadcast_to(np.linspace(0, math.sqrt(14), 13), (s.size, 13))
    marks = np.concatenate([grid, np.sqrt(np.clip(np.transpose(ends), 0, 14))], axis=1)
    # In the root of the curvature powers of radii are smooth.
    r, dr = panels(np.sort(marks, axis=1), points)
    g = r * r
    law_of_g = (
        2 * r * dr * g**3 * np.exp(g * g / 2 + log_ndtr((mu / (1 + var) - g) / math.sqrt(var / (1 + var))))
    )
    law_of_g *= (2 * v * dv * law.pdf(s) / law_of_g.sum(axis=1))[:, None]
    return np.broadcast_to(s[:, None], g.shape).ravel(), (MEAN_CURVATURE / g).ravel(), law_of_g.ravel()


def added(name, s, c, h, gamma=1.6):
    """What summits add at a separation: literally Hertz's formulas, each with its own radius, SI."""
    depth = np.maximum(s - h, 0.0) * SURFACE.sigma
    radius, touch = c * SURFACE.radius, s > h
    stiff = SURFACE.E_star * (gamma - (gamma - 1) * np.exp(-s))
    return {
        "load": 4 / 3 * stiff * np.sqrt(radius) * depth**1.5,
        "area": math.pi * radius * depth,
        "stiffness": 2 * stiff * np.sqrt(radius * depth),
        "contacts": 1.0 * touch,
        "conductance": 4 * np.sqrt(radius * depth),
    }[name]


def columns(largest):
    """For each separation: what all quantities add at all of them, and the probabilities above it."""
    for h in H:
        s, c, p = summits(h)
        c = np.minimum(c, largest)
        yield np.array([added(name, s, c, x) for name in NAMES for x in H]), p


@pytest.mark.parametrize("largest", [3.0, math.inf])
def test_means_covariances_and_third_cumulants_are_literal_sums(largest):
    """Of a Poisson number: mean products and cubes. Without a bound the cube of an area has no variance."""
    m = model(largest, grading=GRADED, count="poisson")
    n, found = SURFACE.n_asperities, m.covariance(NAMES, H).reshape(15, 15)
    lowest = np.tile(np.arange(3), len(NAMES))
    exact = [m.cumulants(name, H) for name in NAMES[:2]]
    fixed = replace(m, count="fixed").std("load", H) ** 2
    for k, (f, p) in enumerate(columns(largest)):
        products = n * (f * p) @ f.T
        here = np.maximum.outer(lowest, lowest) == k
        assert found[here] == pytest.approx(products[here], rel=1e-10)
        means, cubes = (n * (f**power @ p)[k::3] for power in (1, 3))
        assert [float(m.mean(name, H[k])) for name in NAMES] == pytest.approx(means, rel=1e-10)
        assert [x.skewness[k] * x.variance[k] ** 1.5 for x in exact] == pytest.approx(cubes[:2], rel=1e-10)
        assert fixed[k] == pytest.approx(exact[0].variance[k] - means[0] ** 2 / n, rel=1e-10)


def test_the_kurtosis_of_the_area_is_infinite_unless_radii_have_a_bound():
    m = model()
    assert np.all(np.isinf(m.cumulants("area", H).excess_kurtosis))
    assert np.all(np.isfinite(m.cumulants("load", H).excess_kurtosis))
    h = H[1:2]
    bounded = [model(largest).cumulants("area", h).excess_kurtosis for largest in (10.0, 1e3, 1e5)]
    rises = np.diff(bounded, axis=0)
    assert np.all(rises > 0)
    assert rises[1] == pytest.approx(rises[0], rel=0.2)  # like the logarithm of the bound


@pytest.mark.parametrize("name", ["load", "area"])
def test_slopes_and_inverses(name):
    m, step = model(grading=GRADED), 1e-4
    difference = (m.mean(name, H - step) - m.mean(name, H + step)) / (2 * step)
    assert m.slope(name, H) == pytest.approx(difference, rel=1e-6)
    assert m.separation_at(name, m.mean(name, H[1:])) == pytest.approx(H[1:], abs=1e-12)


# Summits that yield, each at its own depth

LAW = KogutEtsion(hardness=2e7, poisson=0.3)
CRITICAL = LAW.on(SURFACE).critical


def yielded(name, s, c, h):
    """Kogut and Etsion's formulas: what summits add over what one of unit depth and the radius R does."""
    x = (s - h) / (CRITICAL * c)
    power, formulas = {
        "load": (1.5, (x**1.5, 1.03 * x**1.425, 1.40 * x**1.263, 3 / 0.577 * x)),
        "area": (1.0, (x, 0.93 * x**1.136, 0.94 * x**1.146, 2 * x)),
    }[name]
    unit = c ** (0.5 if name == "load" else 1.0) * (CRITICAL * c) ** power
    return unit * np.select([x < 1, x < 6, x < 110], formulas[:3], formulas[3])


def test_summits_that_yield_each_at_its_own_depth():
    """Means; and products under the law bound to the radius R beforehand, by its critical penetration."""
    assert 0.02 < CRITICAL < 0.5  # all pieces of the law count
    s, c, p = summits(1.0, CRITICAL * np.array([1, 6, 110]))
    f = np.array([yielded(name, s, c, 1.0) * quantity_of(name).scale(SURFACE) for name in ("load", "area")])
    mean = float(model(law=LAW).mean("load", 1.0))
    assert mean == pytest.approx(SURFACE.n_asperities * (f[0] @ p), rel=1e-9)
    m = model(law=KogutEtsion(critical=CRITICAL, poisson=0.3), count="poisson")
    found = m.covariance(["load", "area"], [1.0])[:, 0, :, 0]
    np.testing.assert_allclose(found, SURFACE.n_asperities * (f * p) @ f.T, rtol=1e-9)


@pytest.mark.parametrize("name", ["load", "area"])
def test_means_of_summits_on_the_way_back_each_from_its_own_depth(name):
    """Etsion, Kligerman and Kadin's formulas from h = 0.5; sums are not cut where contact is lost."""
    s, c, p = summits(0.5, CRITICAL * np.array([1, 6, 110]))
    deepest, delta = s - 0.5, s - 1.0
    x = np.maximum(deepest / (CRITICAL * c), 1.0)
    left = deepest * (1 - x**-0.28) * (1 - x**-0.69)
    share = np.maximum(delta - left, 0) / (deepest - left)
    power = share ** (1.5 * x**-0.0331 if name == "load" else x**-0.12)
    known = SURFACE.n_asperities * quantity_of(name).scale(SURFACE) * (p @ (yielded(name, s, c, 0.5) * power))
    found = model(law=LAW, unload_from=0.5).mean(f"{name}_unloading", 1.0)
    assert float(found) == pytest.approx(known, rel=1e-4)


def test_contacts_that_stick_are_those_of_summits_below_the_separation_too():
    """Pulled by up to D c^(1/3), each by its own: a sum that is not cut where the last of them breaks off."""
    s, c, p = summits(0.2, points=24)
    held = np.sum(p[s - 1.0 > -0.5 * c ** (1 / 3)])
    m = model(law=JohnsonKendallRoberts(pull_off=0.5), unload_from=0.2)
    mean = float(m.mean("contacts_unloading", 1.0))
    assert mean == pytest.approx(SURFACE.n_asperities * held, rel=2e-2)
    variance = mean * (1 - mean / SURFACE.n_asperities)
    assert float(m.std("contacts_unloading", 1.0)) ** 2 == pytest.approx(variance, rel=1e-6)


def test_shares_of_summits_that_yield():
    """The kinks of a share take more points than the means do: by 12 of them it is off by 4e-8."""
    s, c, p = summits(1.0, CRITICAL * np.array([1, 6, 110]), points=32)
    reached = np.searchsorted([1, 6, 110], (s - 1.0) / (CRITICAL * c))
    shares = [float(model(law=LAW).share(piece, 1.0)) for piece in range(4)]
    assert shares == pytest.approx(np.bincount(reached, p, 4) / p.sum(), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("law", [KogutEtsion(critical=0.05), Coated(ratio=3.0, reduced_thickness=0.5)])
def test_separations_do_not_matter_to_each_other(law):
    m, h = model(largest=8.0, grading=GRADED, law=law, unload_from=-0.5), np.array([-0.3, 0.11, 2.6])
    for ask in (m.mean, m.std):
        np.testing.assert_allclose(ask("load", h), [float(ask("load", x)) for x in h], rtol=1e-9)
    # On the way back radii are told apart by whether they still touch: 64 of them see that to 1e-6.
    alone = [float(m.mean("load_unloading", x)) for x in h]
    np.testing.assert_allclose(m.mean("load_unloading", h), alone, rtol=5e-6)
