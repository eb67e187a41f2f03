"""Monte Carlo against theory: where both meet."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from analytic import Fluctuations, quantity_of
from mcgw.ensemble.asperities_alone import asperities_alone
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import interval_column
from mcgw.ensemble.labelled import heading
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import SEPARATION, Column, Table, evenly, stacked
from mcgw.machine.notebook import plotted
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene
from mcgw.statistics.bounded import allowance, beyond, bounded_theory, farthest, told_apart

__all__ = ["FALSE_ALARM", "Comparison", "Curve", "Tested", "Verdict", "compare", "tested", "verdict"]

Array = NDArray[np.float64]

FALSE_ALARM = 1e-3
_MOST_SEPARATIONS = 48
_SKEW, _KURTOSIS = 0.1, 0.1  # so nearly Gaussian must a combination of means be to count
_SMALL, _THIRD = 0.2, 3.0  # standard errors that theory may be off by, and what it leaves out, at most
_COMING_AND_GOING = 20.0  # over a separation: a twentieth of the variance comes and goes
_INDEPENDENT = 1e-9  # variance of a combination that is not a rounding error


@dataclass(frozen=True)
class Curve:
    """One quantity over the separations, all arrays of shape (separations,) in SI units.

    Parameters
    ----------
    mean, low, high : ndarray
        Monte-Carlo mean and its 95 % interval, nan where there are too few contacts for one.
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
    """A chi-square test of all means at once, or of the farthest of them where that tells more.

    Parameters
    ----------
    chi_square : float
        Sum of squares of independent standard normal numbers if theory holds.
    degrees : int
        How many: independent combinations of the means that are Gaussian to within 0.1 in skewness
        and excess kurtosis.
    p : float
        Probability of so large a chi-square by chance; or of so far a mean.
    means, farthest : int, float
        How many means were looked at one by one, and by how many standard errors the farthest of them lies
        beyond what the scene's accuracy allows; 0 where chi-square decided.
    """

    chi_square: float
    degrees: int
    p: float
    means: int = 0
    farthest: float = 0.0

    @property
    def agrees(self) -> bool:
        """False in one of `1/FALSE_ALARM` ensembles that follow the theory."""
        return self.p > FALSE_ALARM

    @property
    def seen(self) -> str:
        """What p is of, in words."""
        if self.means:
            return (
                f"the farthest of {self.means} means is {self.farthest:.1f} standard errors beyond the "
                "accuracy asked for"
            )
        if not self.degrees:
            return "no mean is near enough to Gaussian to be tested"
        return f"chi-square {self.chi_square:.1f} for {self.degrees} degrees of freedom"


@dataclass(frozen=True)
class Tested:
    """What a verdict is on: means at some separations, arrays of shape (quantities, separations).

    Parameters
    ----------
    quantities : tuple of str
        Their names.
    separations : ndarray
        In order.
    mean, theory : ndarray
        Monte-Carlo and exact means, in SI units.
    residual : ndarray
        Their difference over the exact standard error, beyond what the scene's accuracy allows; 0 where
        nothing fluctuates.
    counts : ndarray of bool
        Whether the mean is Gaussian enough for that to be read as a normal number.
    verdict : Verdict
        On all of them.
    """

    quantities: tuple[str, ...]
    separations: Array
    mean: Array
    theory: Array
    residual: Array
    counts: NDArray[np.bool_]
    verdict: Verdict


@dataclass(frozen=True, repr=False)
class Comparison(Shown):
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

    def plot(self, ax: Any = None, *, quantity: str | None = None) -> Any:
        """Draw the theory of a quantity with the Monte-Carlo means on it.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where; default: new axes.
        quantity : str, optional
            One of the curves; default: the first.

        Returns
        -------
        matplotlib.axes.Axes
            With labels and a legend.
        """
        return plotted(self, ax, quantity=quantity or next(iter(self.curves)))

    def sheet(self) -> Sheet:
        """The verdict, and each quantity at the separation where it is farthest from theory."""
        worst = [int(np.argmax(np.abs(curve.residual))) for curve in self.curves.values()]
        tables = zip(self.tables().items(), worst, strict=True)
        farthest = {name: table.at([k]) for (name, table), k in tables}
        v = self.verdict
        seen = f"{v.seen}, p = {v.p:.3g}"
        word = "agree" if v.agrees else "DISAGREE"
        facts = [("all means", seen), ("elasticity", self.ensemble.scene.validity().brief)]
        table = stacked(farthest, "quantity", "farthest off")
        return Sheet(f"Monte Carlo and theory of this model {word}", facts, table)

    def tables(self) -> dict[str, Table]:
        """By quantity: mean, 95 % interval, standard deviation, theory and residual at every separation."""
        return {name: self._table(name) for name in self.curves}

    def _table(self, quantity: str) -> Table:
        c, unit = self.curves[quantity], quantity_of(quantity).unit
        columns = (
            Column("separation", self.ensemble.separations, SEPARATION, form="g"),
            Column("mean", c.mean, unit=unit),
            interval_column(c.low, c.high, unit),
            Column("std", self.ensemble.std(quantity), unit=unit, form=".3g"),
            Column("theory", c.theory, unit=unit),
            Column("residual", c.residual, form="+.2f"),
        )
        return Table(columns, heading(quantity))


def compare(ensemble: Ensemble) -> Comparison:
    """As `mcgw.compare`, of an ensemble."""
    if not promise_of(ensemble.sampler).real_surfaces:
        raise ValueError("a stratified file holds means, not an ensemble; compare takes another sampler")
    scene = ensemble.scene
    curves = {}
    for name in scene.quantities:
        variance = scene.theory.cumulants(name, scene.separations).variance
        low, high = ensemble.interval(name)
        stderr = np.sqrt(variance / ensemble.n_surfaces)
        curves[name] = Curve(
            ensemble.mean(name), low, high, scene.theory.mean(name, scene.separations), stderr
        )
    return Comparison(ensemble, curves, verdict(ensemble))


def verdict(ensemble: Ensemble) -> Verdict:
    """Test all means at once, with their exact covariance.

    The means are turned to the principal axes of their exact correlation. Of these, those count
    along which the mean of all asperities is Gaussian, which its exact skewness and kurtosis tell:
    so the false-alarm rate is the stated one also where few asperities touch. Of asperities that press each
    other down the sums are tested, without the half-space; where each surface finds its own balance, those
    means that theory knows well enough. Of a scene that asks for less than the last digits, what is beyond
    its accuracy counts, of the means one by one and of their combinations in which it cannot be seen.
    """
    scene = ensemble.scene
    if scene.interaction is not None and not scene.interaction.nominal:
        return verdict(asperities_alone(ensemble))
    return tested(scene, ensemble.n_surfaces, ensemble.mean, _MOST_SEPARATIONS).verdict


def tested(scene: Scene, surfaces: int, mean: Callable[[str], Array], most: int) -> Tested:
    """Means over so many surfaces against theory, as `verdict` does, at the given number of separations.

    Parameters
    ----------
    scene : Scene
        Whose asperities do not press each other down, or find a balance on each surface.
    surfaces : int
        How many there are.
    mean : callable
        Means of a quantity in SI units, shape (separations,), by its name.
    most : int
        Separations to take, evenly.
    """
    h = np.unique(scene.separations)
    h = h[evenly(len(h), most)]
    parts = bounded_theory(scene, surfaces).fluctuations(scene.quantities, h)
    index = [scene.separations.index(x) for x in h]
    scale = np.repeat([quantity_of(q).scale(scene.surface) for q in scene.quantities], len(h))
    exact = scene.n_asperities * parts.mean
    means = np.concatenate([mean(q)[index] for q in scene.quantities])
    difference = means / scale - exact
    asperities = float(scene.n_asperities) * surfaces

    variance = parts.moment(2)
    varies = np.flatnonzero(variance > 0)
    unit = np.sqrt(variance[varies])
    parts = parts.take(varies, unit)
    errors = np.sqrt(surfaces / scene.n_asperities) / unit
    z = difference[varies] * errors
    usable = _gaussian(parts, asperities) & (_left_out(scene, h)[varies] * errors < _SMALL)
    allowed = allowance(scene, exact[varies], 1 / errors)
    residual, counts = np.zeros(len(means)), np.zeros(len(means), dtype=np.bool_)
    residual[varies], counts[varies] = beyond(z, allowed), usable
    parts, z, allowed = parts.take(usable), beyond(z, allowed)[usable], allowed[usable]
    axes = parts.whitening(max(_resolved(scene, h), told_apart(allowed)))
    axes = axes[:, _gaussian(parts.turned(axes), asperities)]
    chi_square = float(np.sum((z @ axes) ** 2))
    degrees = axes.shape[1]
    p = float(chdtrc(degrees, chi_square)) if degrees else 1.0
    found = Verdict(chi_square, degrees, p)
    if not scene.exact:
        alone = farthest(z)
        told = (z.size, float(np.abs(z).max(initial=0.0))) if alone < p or not degrees else (0, 0.0)
        found = Verdict(chi_square, degrees, min(1.0, 2 * min(p, alone)), *told)
    shape = len(scene.quantities), len(h)
    return Tested(
        quantities=scene.quantities,
        separations=h,
        mean=means.reshape(shape),
        theory=(exact * scale).reshape(shape),
        residual=residual.reshape(shape),
        counts=counts.reshape(shape),
        verdict=found,
    )


def _resolved(scene: Scene, h: Array) -> float:
    """Variance of a combination from which theory knows it.

    Where each surface has a separation of its own, single asperities come and go between it and that of the
    mean surface. Theory is linear in what surfaces differ by, and knows nothing of that.
    """
    if scene.interaction is None:
        return _INDEPENDENT
    widest = float(np.max(scene.theory.std("effective_separation", h)))
    return min(max(_INDEPENDENT, _COMING_AND_GOING * widest), 0.5)


def _left_out(scene: Scene, h: Array) -> Array:
    """What theory may be off by for each quantity and separation, over its scale: nothing, where it is exact.

    Of means that it knows to second order, the third: as the second is to the mean, so it is to the second.
    """
    if scene.interaction is None:
        return np.zeros(len(scene.quantities) * len(h))
    found, theory = [], cast(Any, scene.theory)
    for name in scene.quantities:
        mean, first = theory.mean(name, h), theory.balanced(name, h)
        with np.errstate(divide="ignore", invalid="ignore"):
            third = np.nan_to_num(_THIRD * (mean - first) ** 2 / np.abs(mean), nan=np.inf)
        found.append(third / quantity_of(name).scale(scene.surface))
    return np.concatenate(found)


def _gaussian(parts: Fluctuations, asperities: float) -> NDArray[np.bool_]:
    """Which terms (columns of unit variance) have a nearly Gaussian mean over so many asperities."""
    with np.errstate(over="ignore", invalid="ignore"):  # where nothing ever touches
        third, fourth = parts.moment(3), parts.moment(4)
    skew = np.abs(third) / np.sqrt(asperities)
    return np.asarray((skew < _SKEW) & (fourth / asperities < _KURTOSIS))
