"""Test whether means follow theory, all at once, and whether values of single surfaces do.

The theory for the test has a bound on radii that hardly any ensemble reaches.

Where each summit has a radius of its own, the fourth moment of the area is infinite, by the logarithm of the
flattest summit. Whether a mean is Gaussian cannot be told from the kurtosis of all summits then, but from
that of those an ensemble has. Left out are summits flatter than a bound, of which there is one in ten
thousand ensembles: means and variances change by less than a thousandth of their errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtrc

from analytic import Fluctuations, MeasuredHeights, Model, RandomCurvature, quantity_of
from analytic.arrays import Array, Marks
from analytic.curvature import MEAN_CURVATURE
from mcgw.ensemble.ensemble import Ensemble
from mcgw.formats.table import SEPARATION, Column, Table, evenly
from mcgw.scene.ensemble import promise_of
from mcgw.scene.scene import Scene

FALSE_ALARM = 1e-3
_MOST_SEPARATIONS = 48
_SKEW, _KURTOSIS = 0.1, 0.1  # allowed departure from a Gaussian of a combination of means
_SELDOM = 1e-4  # expected summits flatter than the bound, per ensemble
_LAWS, _FEW = 8, 3  # laws of values per quantity, at most; few where one takes 60 ms instead of 10
_PLACES = 1000  # values at which shares and probabilities are compared, of more surfaces some of theirs
_FLAT = 1e-3  # curvature down to which the share of flatter summits goes as its fourth power


@dataclass(frozen=True)
class Check:
    """One check, or several as one."""

    name: str  # what is checked
    seen: str
    p: float  # probability of what was seen, or worse, by chance if theory holds
    chi_square: float = 0.0  # of all means at once: sum of squares of independent standard normal numbers
    degrees: int = 0  # how many there are: combinations of means, nearly Gaussian (`_SKEW`, `_KURTOSIS`)

    @property
    def agrees(self) -> bool:
        """Whether theory stands; what follows it is rejected with probability `FALSE_ALARM`."""
        return self.p > FALSE_ALARM

    @property
    def word(self) -> str:
        """Whether Monte Carlo and theory agree."""
        return "agree" if self.agrees else "DISAGREE"

    @property
    def line(self) -> str:
        """One line: whether they agree, and how sure that is."""
        return f"Monte Carlo and theory {self.word}: {self.seen}, p = {self.p:.3g}"


def together(checks: Sequence[Check]) -> Check:
    """Take checks as one, whatever they have in common: the least p, times their number (Bonferroni)."""
    least = min(checks, key=lambda check: check.p)
    return replace(least, p=min(1.0, len(checks) * least.p))


@dataclass(frozen=True)
class Tested:
    """Data behind a verdict: means at some separations, arrays of shape (quantities, separations)."""

    quantities: tuple[str, ...]
    separations: Array  # in order
    mean: Array  # by Monte Carlo, in SI units
    theory: Array  # exactly
    residual: Array  # their difference over the exact standard error; 0 where nothing fluctuates
    counts: Marks  # whether the mean is Gaussian enough for that to be read as a normal number
    verdict: Check  # of all of them
    number: int = 0  # of the point of a sweep, the last axis fastest

    @property
    def row(self) -> int:
        """Number in `table` of the mean farthest off, among those that count."""
        return int(np.argmax(np.where(self.counts, np.abs(self.residual), -1.0)))

    def table(self, scene: Scene) -> Table:
        """Return a row for each quantity and separation."""
        names = np.repeat(self.quantities, len(self.separations)).tolist()
        columns = (
            Column("quantity", names),
            Column("unit", [scene.quantity(name).unit for name in names]),
            Column("separation", np.tile(self.separations, len(self.quantities)), SEPARATION, form="g"),
            Column("mean", self.mean.ravel()),
            Column("theory", self.theory.ravel()),
            Column("residual", self.residual.ravel(), form="+z.2f"),
            Column("p_of_point", [self.verdict.p] * len(names), form=".2g"),
        )
        return Table(columns)


def verdict(ensemble: Ensemble) -> Check:
    """Test all means at once, with their exact covariance.

    The means are turned to the principal axes of their exact correlation. Of these, those count
    along which the mean of all asperities is Gaussian, which its exact skewness and kurtosis tell:
    so the false-alarm rate is the stated one also where few asperities touch. Of asperities that press each
    other down the sums are tested, without the half-space.
    """
    return tested(ensemble, _MOST_SEPARATIONS).verdict


def tested(ensemble: Ensemble, most: int) -> Tested:
    """Hold the means of an ensemble to theory, as `verdict` does, at so many separations at most, evenly.

    Of asperities that press each other down, stiffness and conductance are left out where no values are kept:
    only their means in series with the half-space are then known.
    """
    scene, surfaces = ensemble.scene, ensemble.n_surfaces
    if scene.interaction is not None:
        from mcgw.ensemble.at_load import asperities_alone  # for those scenes alone

        return tested(asperities_alone(ensemble), most)
    h = np.unique(scene.separations)
    h = h[evenly(len(h), most)]
    parts = bounded_theory(scene, surfaces).fluctuations(scene.quantities, h)
    index = [scene.separations.index(x) for x in h]
    scale = np.repeat([quantity_of(q).scale(scene.surface) for q in scene.quantities], len(h))
    exact = scene.n_asperities * parts.mean
    means = np.concatenate([ensemble.mean(q)[index] for q in scene.quantities])
    asperities = float(scene.n_asperities) * surfaces

    unit = np.sqrt(parts.moment(2))  # of one asperity; then errors of the means
    with np.errstate(divide="ignore", invalid="ignore"):
        residual = np.where(unit > 0, (means / scale - exact) * surfaces / (unit * np.sqrt(asperities)), 0.0)
        counts = (unit > 0) & _gaussian(parts.take(np.arange(len(unit)), unit), asperities)
    parts = parts.take(counts, unit[counts])
    axes = parts.whitening(1e-9)  # least variance of a combination, above rounding errors
    axes = axes[:, _gaussian(parts.turned(axes), asperities)]
    chi_square, degrees = float(np.sum((residual[counts] @ axes) ** 2)), axes.shape[1]
    p = float(chdtrc(degrees, chi_square)) if degrees else 1.0
    seen = f"chi-square {chi_square:.1f} for {degrees} degrees of freedom"
    seen = seen if degrees else "no mean is close enough to Gaussian for a test"
    found = Check("means", seen, p, chi_square, degrees)
    shape = len(scene.quantities), len(h)
    means, exact, residual = (x.reshape(shape) for x in (means, exact * scale, residual))
    return Tested(scene.quantities, h, means, exact, residual, counts.reshape(shape), found)


def _gaussian(parts: Fluctuations, asperities: float) -> Marks:
    """Which terms (columns of unit variance) have a nearly Gaussian mean over so many asperities."""
    with np.errstate(over="ignore", invalid="ignore"):  # where nothing ever touches
        skew, kurtosis = np.abs(parts.moment(3)) / np.sqrt(asperities), parts.moment(4) / asperities
    return np.asarray((skew < _SKEW) & (kurtosis < _KURTOSIS))


def bounded_theory(scene: Scene, surfaces: int) -> Model:
    """Return the scene's own model, with a bound on the radii where there is none."""
    theory, law = scene.theory, scene.summits
    if not isinstance(law, RandomCurvature) or np.isfinite(law.largest):
        return theory
    flatter = float(law.cdf(_FLAT, max(scene.lowest, scene.least))) * max(scene.touching, 1.0) * surfaces
    flattest = _FLAT * min((_SELDOM / flatter) ** 0.25, 1.0)
    return replace(theory, curvature=RandomCurvature(law.alpha, MEAN_CURVATURE / flattest))


def laws_of_values(ensemble: Ensemble) -> Check:
    """Test all surfaces against the exact laws of their quantities, all at once.

    A share of M surfaces is farther than D from its probability, at any value, with a probability of at most
    ``2 exp(-2 M D^2)``, for laws with jumps too (Massart, Annals of Probability 18 (1990) 1269). Of K laws
    the least probability counts K-fold (Bonferroni), however much they have in common.
    """
    found = distances(ensemble)
    distance, name, h = max(found)
    p = 2 * len(found) * float(np.exp(-2 * ensemble.n_surfaces * distance**2))
    most = f"differs by {distance:.3g}, the most of {len(found)}"
    seen = f"the distribution of {name} at d/sigma = {h:g} {most}"
    return Check("distributions of values", seen, min(p, 1.0))


def distances(ensemble: Ensemble) -> list[tuple[float, str, float]]:
    """Largest difference of the share of the surfaces up to a value and its probability, and of what law.

    Of each quantity at eight separations at most. Laws of listed summits have a step for each of them.
    """
    scene, one_radius = ensemble.scene, ensemble.scene.summits is None
    kept = scene.keep != "statistics" and promise_of(ensemble.sampler).one_by_one
    known = not isinstance(scene.heights, MeasuredHeights) and (scene.hertzian or one_radius)
    if not (kept and known):
        raise ValueError(
            "laws = True: needs kept values of surfaces, from an exact sampler; not "
            "for listed summits, nor for individual radii with a law other than Hertz's"
        )
    h, m = np.unique(scene.separations), ensemble.n_surfaces
    chosen = h[evenly(len(h), _LAWS if scene.hertzian and one_radius else _FEW)].tolist()
    found = []
    for name in scene.quantities:
        which = [scene.separations.index(x) for x in chosen]
        every = np.sort(ensemble.sums.read(name, 0, m)[:, which].astype(np.float64), axis=0)
        for at, values in zip(chosen, every.T, strict=True):
            # shares and probabilities jump where values repeat
            x, law = values[evenly(values.size, _PLACES)], scene.theory.distribution(name, at)
            below, upto = (np.searchsorted(values, x, side) / values.size for side in ("left", "right"))
            most = law.cdf(x)
            least = law.cdf(x - 1) if quantity_of(name).counts else most - np.where(x == 0, law.atom, 0.0)
            found.append((float(max((upto - most).max(), (least - below).max(), 0.0)), name, at))
    return found
