"""Plasticity index and the mean modulus of the contacts, against the paper's and the theory's figures."""

import mpmath as mp
import numpy as np
import pytest
from reference import F, F_power, F_star, error, graded

import analytic
from analytic import Clipped, Custom, Exponential

TOLERANCE = 2e-13  # a quotient of two integrals of 1e-13


@pytest.mark.parametrize("gamma", [0.2, 1.5, 2.0])
def test_mean_modulus(gamma):
    for h in (-2.0, 0.0, 3.0, 20.0):
        closed = {
            "number": F_star(0, h, gamma) / F(0, h),
            "area": F_star(1, h, gamma) / F(1, h),
            "load": F_power(1.5, 2, h, gamma) / F_star(1.5, h, gamma),
        }
        for weight, truth in closed.items():
            assert error(analytic.mean_modulus(h, Exponential(gamma), weight=weight), truth) < TOLERANCE


def test_mean_modulus_is_weighted_by_load_if_nothing_is_said():
    assert float(analytic.mean_modulus(0.0, Exponential(2.0))) == pytest.approx(1.727, abs=5e-4)
    assert float(analytic.mean_modulus(500.0, Exponential(2.0))) == pytest.approx(2, rel=1e-14)


def test_mean_modulus_of_a_grading_with_breaks():
    grading = Custom(lambda s: np.where(s > 0.7, 3.0, 1.0), breaks=(0.7,))
    step = lambda k: graded(1.5, 0, lambda s: 3**k if s > mp.mpf(0.7) else 1, breaks=[mp.mpf(0.7)])  # noqa: E731
    assert error(analytic.mean_modulus(0.0, grading), step(2) / step(1)) < TOLERANCE
    assert float(analytic.mean_modulus(-5.0, Clipped.of(Exponential(2.0)))) > 0


def test_unknown_weight():
    with pytest.raises(KeyError, match="volume"):
        analytic.mean_modulus(0.0, Exponential(2.0), weight="volume")


def test_index_of_the_papers_example():
    """Zircalloy 4, psi = 0.86: the paper's "2 psi = 1.8" is 1.72, and 1.704 at h = 4."""
    homogeneous = {"E_star": 0.86 * np.sqrt(2) * 1e9, "slope": 1.0, "hardness": 1e9}
    assert float(analytic.plasticity_index(1.0, **homogeneous)) == pytest.approx(0.86, rel=1e-15)
    assert float(analytic.plasticity_index(2.0, **homogeneous)) == pytest.approx(1.72, rel=1e-15)
    at_four = analytic.plasticity_index(Exponential(2.0)(np.array(4.0)), **homogeneous)
    assert float(at_four) == pytest.approx(1.704, abs=5e-4)


def test_index_keeps_the_shape():
    moduli = Exponential(2.0)(np.linspace(0, 4, 6).reshape(2, 3))
    psi = analytic.plasticity_index(moduli, E_star=1e11, slope=0.1, hardness=5e9)
    np.testing.assert_allclose(psi, moduli * 1e11 * 0.1 / (np.sqrt(2) * 5e9), rtol=1e-15)
