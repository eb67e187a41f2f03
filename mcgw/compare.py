"""Monte Carlo against theory: where both meet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

import analytic
from mcgw.ensemble import Ensemble

__all__ = ["FALSE_ALARM", "Comparison", "Curve", "Verdict", "compare", "theory", "verdict"]

Array = NDArray[np.float64]

FALSE_ALARM = 1e-3
_MOST_SEPARATIONS = 48
_SKEW, _KURTOSIS = 0.1, 0.1  # so nearly Gaussian must a combination of means be to count
_INDEPENDENT = 1e-9  # variance of a combination that is no rounding error


@dataclass(frozen=True)
class Curve:
    """One quantity over the separations, all arrays of shape (separations,) in SI units.

    Parameters
    ----------
    mean, low, high : ndarray
        Monte-Carlo mean and its 95 % interval.
    theory, stderr : ndarray
        Exact mean, and the exact standard error of the Monte-Carlo mean.
    """

    mean: Array
    low: Array
    high: Array
    theory: Array
    stderr: Array

    @property
    def residual(self) -> Array:
        """(mean - theory)/stderr; 0 where neither fluctuates."""
        difference = self.mean - self.theory
        return np.divide(difference, self.stderr, out=np.zeros_like(difference), where=self.stderr > 0)


@dataclass(frozen=True)
class Verdict:
    """A chi-square test of all means at once.

    Parameters
    ----------
    chi_square : float
        Sum of squares of independent standard normal numbers if theory holds.
    degrees : int
        How many: independent combinations of the means that are Gaussian to within 0.1 in skewness
        and excess kurtosis.
    p : float
        Probability of so large a chi-square by chance.
    """

    chi_square: float
    degrees: int
    p: float

    @property
    def agrees(self) -> bool:
        """False in one of `1/FALSE_ALARM` ensembles that follow the theory."""
        return self.p > FALSE_ALARM


@dataclass(frozen=True)
class Comparison:
    """A comparison of an ensemble with theory.

    Parameters
    ----------
    ensemble : Ensemble
        What was compared.
    curves : dict of str to Curve
        By quantity.
    verdict : Verdict
        Over all quantities and separations.
    """

    ensemble: Ensemble
    curves: dict[str, Curve]
    verdict: Verdict


def theory(ensemble: Ensemble, quantity: str) -> Array:
    """Exact mean of a quantity for the ensemble's number of asperities, shape (separations,)."""
    scene = ensemble.scene
    per_asperity = analytic.mean(scene.surface, quantity, scene.separations, scene.modulus, law=scene.heights)
    return per_asperity / scene.surface.n_asperities * scene.n_asperities


def compare(ensemble: Ensemble) -> Comparison:
    """Compare the means of an ensemble with theory.

    Parameters
    ----------
    ensemble : Ensemble
        Of independent surfaces.

    Returns
    -------
    Comparison
        Curves and verdict.

    Raises
    ------
    ValueError
        If the surfaces are stratified: their fluctuations are not those of an ensemble.
    """
    if ensemble.sampler == "stratified":
        raise ValueError("a stratified file holds means, not an ensemble; compare takes another sampler")
    scene = ensemble.scene
    curves = {}
    for name in scene.quantities:
        exact = analytic.cumulants(
            scene.surface,
            name,
            scene.separations,
            scene.modulus,
            n_asperities=scene.n_asperities,
            count=scene.count,
            law=scene.heights,
        )
        low, high = ensemble.interval(name)
        stderr = np.sqrt(exact.variance / ensemble.n_surfaces)
        curves[name] = Curve(ensemble.mean(name), low, high, theory(ensemble, name), stderr)
    return Comparison(ensemble, curves, verdict(ensemble))


def verdict(ensemble: Ensemble) -> Verdict:
    """Test all means at once, with their exact covariance.

    The means are turned to the principal axes of their exact correlation. Of these, those count
    along which the mean of all asperities is Gaussian, which its exact skewness and kurtosis tell:
    so the false-alarm rate is the stated one also where few asperities touch.
    """
    scene = ensemble.scene
    h = _chosen(np.unique(scene.separations))
    rule = analytic.HeightRule.over(h, scene.modulus, scene.heights)
    terms = rule.terms(scene.quantities, h, scene.modulus)
    deviation, below = rule.fluctuations(terms, scene.count)
    variance = rule.probabilities @ deviation**2 + rule.below * below**2
    index = [scene.separations.index(x) for x in h]
    difference = np.concatenate([_difference(ensemble, name)[index] for name in scene.quantities])

    varies = variance > 0
    unit = np.sqrt(variance[varies])
    deviation, below = deviation[:, varies] / unit, below[varies] / unit
    z = difference[varies] / unit * np.sqrt(ensemble.n_surfaces / scene.n_asperities)
    asperities = float(scene.n_asperities) * ensemble.n_surfaces

    usable = _gaussian(rule, deviation, below, asperities)
    deviation, below, z = deviation[:, usable], below[usable], z[usable]
    axes = rule.whitening(deviation, below, _INDEPENDENT)
    axes = axes[:, _gaussian(rule, deviation @ axes, below @ axes, asperities)]
    chi_square = float(np.sum((z @ axes) ** 2))
    degrees = axes.shape[1]
    return Verdict(chi_square, degrees, float(chi2.sf(chi_square, degrees)) if degrees else 1.0)


def _difference(ensemble: Ensemble, quantity: str) -> Array:
    """Mean less theory, relative to what one asperity contributes at unit approach."""
    scale = analytic.QUANTITIES[quantity].scale(ensemble.scene.surface)
    return (ensemble.mean(quantity) - theory(ensemble, quantity)) / scale


def _gaussian(
    rule: analytic.HeightRule, deviation: Array, below: Array, asperities: float
) -> NDArray[np.bool_]:
    """Which terms (columns of unit variance) have a nearly Gaussian mean over so many asperities."""
    with np.errstate(over="ignore", invalid="ignore"):  # where nothing ever touches
        third = rule.probabilities @ deviation**3 + rule.below * below**3
        fourth = rule.probabilities @ deviation**4 + rule.below * below**4
    skew = np.abs(third) / np.sqrt(asperities)
    return np.asarray((skew < _SKEW) & (fourth / asperities < _KURTOSIS))


def _chosen(separations: Array) -> Array:
    """Some of many separations, evenly."""
    step = -(-len(separations) // _MOST_SEPARATIONS)
    return separations[::step]
