"""Theory of asperities that press each other down: identities, values from elsewhere, literal Monte Carlo.

Statistical gates are |z| < 5 with fixed seeds: false alarms 6e-7 a number. Wrong versions are shown to fail.
"""

import math
from dataclasses import replace

import interacting_by_hand as hand
import mpmath
import numpy as np
import pytest
from conftest import SURFACE
from interacting_by_hand import drawn, interaction
from oracles import factor
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.stats import norm

import analytic
from analytic import InteractingModel, Model
from analytic.interaction import BOWL, LATTICE

QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance")
LOAD = factor(SURFACE, "load")
H = np.array([0.0, 0.8, 2.0])


def model_of(strength, n, at="nominal", **own):
    return InteractingModel(SURFACE, n_asperities=n, interaction=interaction(strength, SURFACE, n, at), **own)


def f(n, h):
    """F_n(h) of Gaussian heights by scipy."""
    return quad(lambda u: 2 * u ** (2 * n + 1) * norm.pdf(h + u * u), 0, 5, epsabs=0, epsrel=1e-13)[0]


def test_mean_sinking_of_a_square():
    """Integral of (1 - x)(1 - y)/r over the square, the distances of two of its points, in polar form."""

    def along(angle):
        end = 1 / mpmath.cos(angle)
        return mpmath.quad(lambda r: (1 - r * mpmath.cos(angle)) * (1 - r * mpmath.sin(angle)), [0, end])

    mean = 8 / mpmath.pi * mpmath.quad(along, [0, mpmath.pi / 4])
    assert pytest.approx(float(mean), rel=1e-14) == BOWL
    assert pytest.approx(0.9464020088186771, rel=1e-15) == BOWL
    assert pytest.approx(4 / math.pi * math.asinh(1), rel=1e-14) == hand.SINKING_OF_THE_CENTRE
    assert abs(BOWL / hand.SINKING_OF_THE_CENTRE - 1) > 0.15


def test_potential_of_a_square_lattice():
    """By zeta functions; and by sums over squares less their background, extrapolated twice."""
    beta = (mpmath.zeta(0.5, 0.25) - mpmath.zeta(0.5, 0.75)) / 2
    assert pytest.approx(float(-4 * mpmath.zeta(0.5) * beta), rel=1e-14) == LATTICE

    def left(n):
        i = np.arange(1, n + 1.0)
        quarter = 1 / np.hypot(
            i[:, None], np.arange(n + 1.0)
        )  # turned by right angles it fills the plane but the point
        return 8 * (n + 0.5) * math.asinh(1) - 4 * math.fsum(quarter.ravel().tolist())

    sums = np.array([left(n) for n in (200, 400, 800)])
    widths = 2 * np.array([200, 400, 800]) + 1.0
    fit = np.polynomial.polynomial.polyfit(1 / widths, sums, 2)  # charges' own shape: falls as 1/width
    assert fit[0] == pytest.approx(LATTICE, abs=1e-8)


@pytest.fixture
def poisson():
    """N = 3000, strength 3, h = 0.8: the case of the check values."""
    return model_of(3.0, 3000, count="poisson")


def test_check_values(poisson):
    """Values of a separate script (12 steps of Newton on 8000 surfaces, -0.102 +- 0.125)."""
    x0 = float(poisson.effective(0.8))
    assert x0 == pytest.approx(1.01848013262518, rel=1e-14)
    at_x0 = float(poisson.alone.mean("load", x0)) / LOAD
    assert at_x0 / 3000 == pytest.approx(0.0728267108750539, rel=1e-13)
    assert float(poisson.mean("load", 0.8)) / LOAD - at_x0 == pytest.approx(-0.120, abs=5e-4)
    assert float(poisson.std("load", 0.8) / LOAD) ** 2 == pytest.approx(123.75, abs=5e-3)


def test_mean_and_variance_of_the_load_by_the_formulas(poisson):
    """With F_n by scipy; F_{-1/2} too, whose integrand is finite in the root of the approach."""
    lam, n = 3 / 3000, 3000
    x0 = brentq(lambda x: x - 0.8 - 3 * f(1.5, x), 0.8, 3, xtol=1e-15)
    rate, v = 1 + lam * 1.5 * n * f(0.5, x0), n * f(3, x0)
    curved, together = 0.75 * n * f(-0.5, x0), -1.5 * n * f(2, x0)  # P''; Cov(P, P')
    bias = (curved * lam**2 * v / rate**2 / 2 + lam * together / rate) / rate
    assert float(poisson.mean("load", 0.8)) / LOAD == pytest.approx(n * f(1.5, x0) + bias, rel=1e-10)
    assert float(poisson.std("load", 0.8) / LOAD) ** 2 == pytest.approx(v / rate**2, rel=1e-12)


STRENGTHS = {"body": 3.0, "mean-plane": -0.3}
GRADINGS = {
    "same": analytic.Homogeneous(),
    "exponential": analytic.Exponential(2.0),
    "own": analytic.Custom(lambda s: 1 + 0.3 * np.tanh(s)),
}


@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
@pytest.mark.parametrize("strength", STRENGTHS.values(), ids=STRENGTHS)
class TestIdentities:
    def test_balance(self, strength, grading):
        model = model_of(strength, 1000, grading=analytic.resolved(grading, -8, 9))
        x = model.effective(H)
        load = model.alone.mean("load", x) / (1000 * LOAD)
        np.testing.assert_allclose(x, H + strength * load, rtol=0, atol=1e-13)
        wrong = H - strength * load
        assert (np.abs(x - wrong) > 1e-3).all()

    def test_variances_are_divided_by_the_square_of_the_rate(self, strength, grading):
        model = model_of(strength, 1000, grading=analytic.resolved(grading, -8, 9))
        x = model.effective(H)
        rate = 1 + strength * model.alone.slope("load", x) / (1000 * LOAD)
        alone = model.alone.cumulants("load", x).variance
        np.testing.assert_allclose(model.std("load", H) ** 2, alone / rate**2, rtol=1e-12)
        np.testing.assert_allclose(
            model.std("effective_separation", H),
            np.abs(strength) / 1000 / LOAD * model.std("load", H),
            rtol=1e-12,
        )

    def test_compliances_add(self, strength, grading):
        """Of a surface so large that it does not fluctuate; and the stiffness is the slope of the load."""
        n = 1e16
        model = model_of(strength, n, grading=analytic.resolved(grading, -8, 9))
        x, sunk = model.effective(H), model.compliance * SURFACE.sigma
        stiffness = model.mean("stiffness", H)
        apart = 1 / model.alone.mean("stiffness", x)
        np.testing.assert_allclose(1 / stiffness - apart, sunk, rtol=1e-12 * (apart / abs(sunk)).max())
        assert (np.abs(sunk) / apart > 5e-3).all()  # without it, 1/K would be off by so much
        step = 1e-3
        loads = [model.mean("load", H + k * step) for k in (-2, -1, 1, 2)]
        slope = -(loads[0] - 8 * loads[1] + 8 * loads[2] - loads[3]) / (12 * step * SURFACE.sigma)
        np.testing.assert_allclose(stiffness, slope, rtol=1e-9)

    def test_at_a_given_load_only_the_separation_differs(self, strength, grading):
        model = model_of(strength, 1e16, grading=analytic.resolved(grading, -8, 9))
        loads = model.alone.mean("load", H)
        h = model.separation_at("load", loads)
        shift = strength * loads / (1e16 * LOAD)
        np.testing.assert_allclose(h, H - shift, rtol=0, atol=1e-13)
        for name in ("load", "area", "contacts", "conductance"):
            np.testing.assert_allclose(model.mean(name, h), model.alone.mean(name, H), rtol=1e-12)
        assert (np.abs(model.mean("area", H) / model.alone.mean("area", H) - 1) > 1e-3).all()


NAYAK = analytic.SpectralMoments(1e-12, 1e-3, 5e6)
LISTED = np.random.default_rng(3).normal(size=60)
CROSSED = {
    "Nayak's heights": {"heights": analytic.Nayak(5.0)},
    "own radii": {"heights": analytic.Nayak(5.0), "curvature": analytic.RandomCurvature(5.0)},
    "Kogut and Etsion": {"law": analytic.KogutEtsion(critical=0.5)},
    "measured heights": {"heights": analytic.MeasuredHeights(LISTED)},
    "exponential heights": {"heights": analytic.ExponentialHeights(), "count": "poisson"},
}


@pytest.mark.parametrize("own", CROSSED.values(), ids=CROSSED)
@pytest.mark.parametrize("strength", STRENGTHS.values(), ids=STRENGTHS)
def test_every_asperity_can_be_pressed_down(strength, own):
    """Balance, variance and compliances from the model of the same asperities alone."""
    surface = NAYAK.surface(1e-8, 1e9) if "curvature" in own else SURFACE
    model = InteractingModel(
        surface, n_asperities=2000, interaction=interaction(strength, surface, 2000), **own
    )
    h = np.array([0.1, 1.13] if model.curvature is None else [0.1])  # radii of their own take long
    x, alone, c = model.effective(h), model.alone, model.compliance
    np.testing.assert_allclose(x, h + c * alone.mean("load", x), rtol=0, atol=1e-13)
    rate = 1 + c * alone.slope("load", x)
    np.testing.assert_allclose(model.std("load", h), alone.std("load", x) / rate, rtol=1e-12)
    effective = InteractingModel.of(alone, interaction(strength, surface, 2000, "effective"))
    np.testing.assert_array_equal(effective.mean("load", h), alone.mean("load", h))
    np.testing.assert_allclose(
        effective.mean("nominal_separation", h), h - c * alone.mean("load", h), rtol=0, atol=1e-13
    )


def test_adhesive_asperities_are_pressed_up_too():
    """Loads that pull sink the plane the other way; given are what asperities feel."""
    law = analytic.JohnsonKendallRoberts(pull_off=0.5)
    alone = Model(SURFACE, law=law, n_asperities=2000)
    model = InteractingModel.of(alone, interaction(3.0, SURFACE, 2000, "effective"))
    h = np.array([-1.0, 1.0])  # pressed, and pulled
    loads = alone.mean("load", h)
    assert loads[0] > 0 > loads[1]
    np.testing.assert_allclose(
        model.mean("nominal_separation", h), h - 3 * loads / (2000 * LOAD), rtol=0, atol=1e-13
    )


@pytest.mark.parametrize(("crowding", "fold"), [(0.05, -3.3), (0.116, -1.6)])
def test_the_mean_plane_has_no_balance_below_its_fold(crowding, fold):
    """Where strength times slope is 1; at these eta R sigma it lies at an x told elsewhere, to two digits."""
    surface = replace(SURFACE, eta=crowding / (SURFACE.radius * SURFACE.sigma))
    model = InteractingModel(surface, interaction=analytic.Interaction("mean-plane", at="nominal"))
    strength = hand.LATTICE / math.pi * 4 / 3 * math.sqrt(crowding)
    x = brentq(lambda x: strength * 1.5 * f(0.5, x) - 1, -4, 0)
    assert x == pytest.approx(fold, abs=0.1)
    h = x + strength * f(1.5, x)
    assert x < float(model.effective(h + 1e-4)) < x + 0.05
    with pytest.raises(ValueError, match=r"no balance at d/sigma = .* give higher separations"):
        model.effective(h - 1e-4)


# Monte Carlo of small surfaces, whose mean load is eight of its standard errors below the naive one.

N, M, TOUCHING = 100, 22_000, 75
GRADED = analytic.Exponential(2.0)


def literal_means(strength, h, *, series=True, seed=11):
    """Mean of every quantity over many surfaces, and its standard error."""
    s, e = drawn(N, M, GRADED, seed, TOUCHING)
    c = strength / N
    x = hand.balances(s, e, h, c)
    sums = hand.sums_at(s, e, x)
    if series:
        sums["stiffness"] = sums["stiffness"] / (1 + 1.5 * c * sums["stiffness"])
    sums["effective_separation"] = x
    return {name: (v.mean(), v.std() / math.sqrt(M)) for name, v in sums.items()}


def scores(means, model, h):
    scale = {name: factor(SURFACE, name) for name in QUANTITIES} | {"effective_separation": 1.0}
    return {
        name: (mean - float(model.mean(name, h)) / scale[name]) / error
        for name, (mean, error) in means.items()
    }


@pytest.mark.parametrize(("strength", "h"), [(3.0, 0.8), (-0.3, 0.3)])
def test_means_of_finite_surfaces(strength, h):
    z = scores(literal_means(strength, h), model_of(strength, N, grading=GRADED), h)
    assert max(map(abs, z.values())) < 5, z


def test_the_load_without_its_bias_fails():
    """The balance of the means is not the mean of the balances."""
    mean, error = literal_means(3.0, 0.8)["load"]
    model = model_of(3.0, N, grading=GRADED)
    naive = float(model.alone.mean("load", model.effective(0.8))) / LOAD
    assert (naive - mean) / error > 5
    assert (naive - float(model.mean("load", 0.8)) / LOAD) / error > 7


WRONG = {
    "sinking of the centre": {"strength": 3.0 * hand.SINKING_OF_THE_CENTRE / hand.MEAN_SINKING},
    "the other sign": {"strength": -0.3},
    "a half-space graded as its asperities": {"strength": 3.0 / 1.5},
    "half-space not in series": {"strength": 3.0, "series": False},
}


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_wrong_versions_fail(wrong):
    right = 0.3 if wrong["strength"] < 0 else 3.0
    z = scores(literal_means(h=0.8, **wrong), model_of(right, N, grading=GRADED), 0.8)
    assert max(map(abs, z.values())) > 5, z
