"""Gap conductance of a gas: check values of Yovanovich's integral, limits, and whose heights count."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import analytic
from analytic.joint import Gas, Joint, air, gap_integral

SURFACE = analytic.Surface(sigma=0.9e-6, radius=1e-5, eta=1e10, nominal_area=1e-4, E_star=1e11)


@pytest.mark.parametrize(("y", "m", "value"), [
    (3, 0.1, 0.37663374387822), (2, 1, 0.357567566339058), (4, 0.01, 0.269913675556762),
    (0, 0.3, 0.618189222135803),
])  # fmt: skip
def test_check_values(y, m, value):
    assert float(gap_integral(y, m)) == pytest.approx(value, rel=1e-13)


def test_limits_and_many_distances():
    """Far apart two walls at a distance; many are interpolated to as many digits."""
    assert float(gap_integral(1e6, 0.5)) == pytest.approx(1 / (1e6 + 0.5), rel=1e-11)
    many = np.linspace(-2.0, 14.0, 9001)
    few = many[::900]
    np.testing.assert_allclose(gap_integral(many, 0.1)[::900], gap_integral(few, 0.1), rtol=1e-13)
    literal = quad(lambda x: math.exp(-((few[5] - x) ** 2) / 2) / (x + 0.1), 0, 20, points=(0.1, few[5]))[0]
    assert float(gap_integral(few[5], 0.1)) == pytest.approx(literal / math.sqrt(2 * math.pi), rel=1e-9)


def test_the_rms_is_that_of_the_surface():
    """By Nayak's heights, or given: both tell alpha and the offset; that of the summits is another one."""
    heights = analytic.Nayak(5.0)
    known = Joint("air").gap(SURFACE, heights)
    given = Joint("air", rms=SURFACE.sigma / heights.std).gap(SURFACE, analytic.Gaussian())
    assert given.rise == pytest.approx(known.rise, rel=1e-12)
    assert float(given(2.0)) == pytest.approx(float(known(2.0)), rel=1e-12)
    wrong = air().conductivity / SURFACE.sigma * gap_integral(2.0, air().jump / SURFACE.sigma)
    assert abs(float(wrong) / float(known(2.0)) - 1) > 0.1
    assert float(Joint("vacuum").gap(SURFACE, heights)(2.0)) == 0.0
    assert Joint({"conductivity": 0.15, "jump": 1e-6}).held == Gas(0.15, 1e-6)


@pytest.mark.parametrize(("joint", "line"), [
    (lambda: Joint("steam"), "gas = 'steam': give"),
    (lambda: Joint("vacuum", temperature=300.0), "temperature = 300.0: it goes with"),
    (lambda: Joint("air").gap(SURFACE, analytic.Gaussian()), "rms: give the root mean square height"),
    (lambda: Joint("air", rms=1e-7).gap(SURFACE, analytic.Gaussian()), "rms = 1e-07: give more than sigma"),
    (lambda: Joint("air", rms=1e-6).gap(SURFACE, analytic.Nayak(5.0)), "rms = 1e-06: the heights tell it"),
    (lambda: Gas(0.0, 1.0), "gas.conductivity = 0.0: give"),
])  # fmt: skip
def test_mistakes(joint, line):
    with pytest.raises(ValueError, match=line):
        joint()
