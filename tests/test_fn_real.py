"""F_n for powers n that are no half-integers, against closed forms at 40 digits."""

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from reference import F, F_star, error, graded, phi
from scipy.integrate import quad

import analytic
from analytic import Custom, Exponential, ExponentialHeights, MeasuredHeights, ScipyHeights, Weibull
from analytic.panels import panels

TOLERANCE = 1e-13
POWERS = (0.125, 0.25, 1 / 3, 0.625, 0.75, 1.3, 1.625, 1.75, 2.2, 5.3)
H = np.concatenate(
    [
        np.random.default_rng(20240604).uniform(-40, 1000, 15),
        np.random.default_rng(20240605).uniform(-40, 40, 15),
        [-40, -13, -1e-9, 0, 1e-9, 1, 13, 37, 1000],
    ]
)


def scaled(truth, h):
    return truth / phi(h) if h >= 0 else truth


@pytest.mark.parametrize("n", POWERS)
def test_homogeneous(n):
    values = analytic.fn_scaled(n, H)
    assert max(error(v, scaled(F(n, h), h)) for v, h in zip(values, H, strict=True)) < TOLERANCE


@pytest.mark.parametrize("gamma", [0.2, 2.0])
@pytest.mark.parametrize("n", POWERS[::3])
def test_exponential(n, gamma):
    values = analytic.fn_scaled(n, H, Exponential(gamma))
    assert max(error(v, scaled(F_star(n, h, gamma), h)) for v, h in zip(values, H, strict=True)) < TOLERANCE


@pytest.mark.parametrize(("n", "value"), [(1.625, 0.07501013481035919), (1.75, 0.07475377552208902)])
def test_loads_of_graded_half_spaces(n, value):
    assert float(analytic.fn(n, 1.0)) == pytest.approx(value, rel=TOLERANCE)


@pytest.mark.parametrize("gap", [1e-12, 1e-6, 0.3])
def test_a_break_close_above_the_separation(gap):
    """The range behind it begins where the power is steepest."""
    h, n = 0.4, 0.25
    grading = Custom(lambda s: np.where(s > h + gap, 2.0, 1.0), breaks=(h + gap,))
    gap = mp.mpf(h + gap) - mp.mpf(h)
    near = gap ** (mp.mpf(n) + 1) / (n + 1)  # of the homogeneous surface, next to h
    with mp.workdps(25):
        near = phi(h) * (
            near - h * gap ** (mp.mpf(n) + 2) / (n + 2) + (h * h - 1) * gap ** (mp.mpf(n) + 3) / (n + 3) / 2
        )
    if gap > 0.1:
        near = graded(n, h, lambda s: 1, high=mp.mpf(h) + gap)
    truth = 2 * F(n, h) - near
    assert error(float(analytic.fn(n, h, grading)), truth) < TOLERANCE


def test_one_rule_over_the_range_behind_a_break_would_not_do(monkeypatch):
    """That the test above can fail."""
    monkeypatch.setattr("analytic.panels._RATIO", 1e30)
    with pytest.raises(AssertionError):
        test_a_break_close_above_the_separation(1e-6)


def test_half_integers_take_the_rule_of_half_integers():
    h, one = np.array([[0.3]]), np.ones((1, 1))
    g = analytic.Homogeneous()
    for n in (0, 0.5, 1, 1.5, 2.5):
        near = panels(n + 1e-12, h, g, 0 * one, h, h + 2).item()  # with the other rule
        assert panels(n, h, g, 0 * one, h, h + 2).item() == pytest.approx(near, rel=1e-11)


@pytest.mark.parametrize("n", [0.25, 0.625, 1.75])
def test_exponential_heights_have_a_closed_form(n):
    """F_n(h) = Gamma(n+1) exp(-1-h), with the paper's grading as in test_heights_laws.py."""
    h = np.array([-1.0, -0.5, 0.0, 1.0, 5.0, 20.0, 200.0])
    for gamma in (0.2, 1.0, 2.0):
        found = analytic.fn(n, h, Exponential(gamma), heights=ExponentialHeights())
        truth = [
            float(
                mp.gamma(n + 1) * mp.exp(-x - 1) * (gamma - (gamma - 1) * mp.mpf(2) ** (-n - 1) * mp.exp(-x))
            )
            for x in map(mp.mpf, h)
        ]
        assert found == pytest.approx(truth, rel=1e-12)


@pytest.mark.parametrize("h", [-3.0, -0.9, 0.4])
@pytest.mark.parametrize(
    "law", [Weibull(2.0), ScipyHeights(scipy.stats.uniform())], ids=["weibull", "uniform"]
)
def test_other_height_laws_in_another_variable(law, h):
    """With s - h = v^4 the power 1.25 is v^5, and nothing is singular at the separation."""
    n, low = 1.25, max(h, law.support[0])

    def term(v):
        return 4 * v**3 * v**5 * float(law.density(np.array(h + v**4)))

    top = min(law.support[1], 20.0)
    truth = quad(term, (low - h) ** 0.25, (top - h) ** 0.25, epsabs=0, epsrel=1e-12, limit=400)[0]
    assert float(analytic.fn(n, h, heights=law)) == pytest.approx(truth, rel=1e-11)


def test_measured_heights_are_summed():
    heights = MeasuredHeights([-1.2, 0.1, 0.7, 2.0])
    s = np.array(heights.heights)
    truth = np.sum(np.where(s > 0.05, np.abs(s - 0.05) ** 1.7, 0.0)) / 4
    assert float(analytic.fn(1.7, 0.05, heights=heights)) == pytest.approx(truth, rel=1e-14)
