"""What a verdict says that it saw is what decided: chi-square, or the farthest mean where none is left."""

import numpy as np
import pytest
from scipy.special import chdtrc, ndtr

import mcgw
from mcgw.ensemble.ensemble import Ensemble
from mcgw.statistics.verdict import Verdict

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "3 mm^2", "78.6 GPa")
H = [0.0, 0.5, 1.0]


def compared(accuracy, wrong=1.0, separations=H):
    scene = mcgw.Scene(SURFACE, separations=separations, n_surfaces=4000, seed=3, accuracy=accuracy)
    drawn = mcgw.simulate(scene)
    other = scene.replace(E_star=wrong * SURFACE.E_star)
    return mcgw.compare(Ensemble(other, drawn.sampler, drawn.sums))


def beyond(comparison):
    """Standard errors by which each mean lies beyond the accuracy of its scene, by hand."""
    scene, found = comparison.ensemble.scene, []
    for name in scene.quantities:
        mean, theory = comparison.ensemble.mean(name), scene.theory.mean(name, scene.separations)
        stderr = scene.theory.std(name, scene.separations) / np.sqrt(comparison.ensemble.n_surfaces)
        found.append(np.maximum(np.abs(mean - theory) - scene.accuracy * np.abs(theory), 0) / stderr)
    return np.concatenate(found)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-2])
@pytest.mark.parametrize("wrong", [0.95, 1.0, 1.05])
def test_without_combinations_the_farthest_mean_is_told(accuracy, wrong):
    comparison = compared(accuracy, wrong)
    verdict, z = comparison.verdict, beyond(comparison)
    assert verdict.degrees == 0
    assert verdict.agrees == (wrong == 1)
    assert (verdict.means, verdict.farthest) == (12, pytest.approx(z.max(), abs=1e-6))
    assert verdict.p == pytest.approx(min(1, 4 * 12 * ndtr(-z.max())), rel=1e-4)
    said = f"the farthest of 12 means is {z.max():.1f} standard errors beyond the requested accuracy, p = "
    assert said in comparison.sheet().text()
    line = verdict.line
    assert f"{'agree' if wrong == 1 else 'DISAGREE'}: {said}" in line
    assert "chi-square" not in line


@pytest.mark.parametrize("wrong", [1.0, 1.01])
def test_at_the_last_digits_chi_square_is(wrong):
    verdict = compared(1e-13, wrong).verdict
    assert verdict.degrees > 3
    assert verdict.p == pytest.approx(chdtrc(verdict.degrees, verdict.chi_square), rel=1e-12)
    assert (verdict.means, verdict.farthest) == (0, 0.0)
    said = f"chi-square {verdict.chi_square:.1f} for {verdict.degrees} degrees of freedom"
    assert said in verdict.line
    assert verdict.agrees == (wrong == 1)


@pytest.mark.parametrize("accuracy", [1e-13, 1e-3])
def test_nothing_that_can_be_tested_is_said(accuracy):
    verdict = compared(accuracy, separations=[12.0]).verdict
    assert verdict == Verdict(0.0, 0, 1.0)
    assert "agree: no mean is close enough to Gaussian for a test, p = 1" in verdict.line
