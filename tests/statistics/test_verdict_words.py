"""What a verdict says that it saw."""

import pytest
from oracles.inside import Verdict
from scipy.special import chdtrc

import mcgw
from mcgw import Ensemble

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "3 mm^2", "78.6 GPa")


def verdict_on(wrong=1.0, separations=(0.0, 0.5, 1.0)):
    drawn = mcgw.simulate(mcgw.Scene(SURFACE, separations=separations, n_surfaces=4000, seed=3))
    other = drawn.scene.replace(E_star=wrong * SURFACE.E_star)
    return mcgw.compare(Ensemble(other, drawn.sampler, drawn.sums)).verdict


@pytest.mark.parametrize("wrong", [1.0, 1.01])
def test_chi_square_is_told(wrong):
    verdict = verdict_on(wrong)
    assert verdict.degrees > 3
    assert verdict.p == pytest.approx(chdtrc(verdict.degrees, verdict.chi_square), rel=1e-12)
    assert f"chi-square {verdict.chi_square:.1f} for {verdict.degrees} degrees of freedom" in verdict.line
    assert verdict.agrees == (wrong == 1)


def test_nothing_that_can_be_tested_is_said():
    verdict = verdict_on(separations=[12.0])
    assert verdict == Verdict(0.0, 0, 1.0)
    assert "agree: no mean is close enough to Gaussian for a test, p = 1" in verdict.line
