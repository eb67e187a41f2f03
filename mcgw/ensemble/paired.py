"""Two ensembles of the same surfaces, compared surface by surface."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.special import ndtri

from analytic.arrays import Array, Ints
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import CONFIDENCE
from mcgw.ensemble.pooled import Pooled
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import SEPARATION, Column, Table
from mcgw.machine.terminal import plotted
from mcgw.scene.arguments import check_object

Some = tuple[Ints, Array]  # numbers of pooled scenes, and their weights
_PAIRED = ("surface", "separations", "heights", "n_asperities", "count", "seed")


@dataclass(frozen=True, repr=False)
class Paired(Shown):
    """Ratio of two means over the same surfaces; arrays over the separations.

    Parameters
    ----------
    quantity : str
        Name of the quantity.
    separations : ndarray
        Reduced separations d/sigma.
    ratio, stderr : ndarray
        Ratio of the means and its standard error; nan where the denominator has no contact.
    gain : ndarray
        Variance of the ratio of two independent ensembles of this size, divided by that of the pair.
    """

    quantity: str
    separations: Array
    ratio: Array
    stderr: Array
    gain: Array

    def interval(self, level: float = CONFIDENCE) -> tuple[Array, Array]:
        """Return both ends of a confidence interval of the ratio, by the normal law of many surfaces.

        Raises
        ------
        ValueError
            If `level` is not between 0 and 1.
        """
        if not 0 < level < 1:
            raise ValueError(f"level = {level!r}: give a number between 0 and 1, such as 0.95")
        half = ndtri((1 + level) / 2) * self.stderr
        return self.ratio - half, self.ratio + half

    @property
    def ratio_low(self) -> Array:
        """Lower end of the 95 % interval."""
        return self.interval()[0]

    @property
    def ratio_high(self) -> Array:
        """Upper end of the 95 % interval."""
        return self.interval()[1]

    def plot(self, ax: Any = None) -> Any:
        """Draw the ratio with its 95 % interval; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Sheet:
        """Ratios at some separations."""
        title = f"Ratio of the mean {self.quantity} over the same surfaces"
        return Sheet(title, table=self.table().rows())

    def table(self) -> Table:
        """Ratio, standard error and gain at every separation."""
        return Table(
            (
                Column("separation", self.separations, SEPARATION, form="g"),
                Column("ratio", self.ratio, unit="1"),
                Column("stderr", self.stderr, unit="1", form=".2g"),
                Column("variance_gain", self.gain, "variance, independent/paired", form=".3g"),
            )
        )


def paired_ratio(numerator: Ensemble, denominator: Ensemble, quantity: str) -> Paired:
    """Return the ratio of two means over the same surfaces: Eqs. (12) and (15) of the paper by Monte Carlo.

    Parameters
    ----------
    numerator, denominator : Ensemble
        Of the same surfaces: simulated with the same seed, number of asperities, separations and cells.
    quantity : str
        One they share.

    Returns
    -------
    Paired
        The standard error is that of ``b - r a`` over the surfaces (delta method): fluctuations that both
        share cancel.

    Raises
    ------
    ValueError
        If the two differ in anything but grading, contact law and quantities, or were drawn in other cells;
        the line says in what.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1)
    >>> two = (mcgw.simulate(scene, grading=mcgw.Exponential(gamma)) for gamma in (2.0, 1.0))
    >>> mcgw.paired_ratio(*two, "load").ratio.shape
    (3,)
    """
    for ensemble in (numerator, denominator):
        check_object("paired_ratio", ensemble, Ensemble)
    differ = [name for name in _PAIRED if getattr(numerator.scene, name) != getattr(denominator.scene, name)]
    differ += [
        name for name in ("n_surfaces", "sampler") if getattr(numerator, name) != getattr(denominator, name)
    ]
    if not differ and not _same_asperities(numerator, denominator):
        differ = ["law, and hence in asperities (mcgw.sweep gives the same surfaces several laws)"]
    if differ:
        raise ValueError(
            f"a paired ratio needs two ensembles of the same surfaces; these differ in {', '.join(differ)}"
        )
    pooled, one = Pooled.of([{quantity: e.values(quantity)} for e in (numerator, denominator)]), np.ones(1)
    both = (np.array([0]), one), (np.array([1]), one)
    return ratio_of(pooled, quantity, *both, numerator.separations)


class Pair(NamedTuple):
    """Two means, and the variance of a combination of them over shared and over different surfaces.

    Parameters
    ----------
    one, other : ndarray
        Means.
    together, apart : ndarray
        Variances.
    """

    one: Array
    other: Array
    together: Array
    apart: Array

    @classmethod
    def of(
        cls, pooled: Pooled, quantity: str, first: Some, second: Some, x: float | Array, y: float | Array
    ) -> "Pair":
        """`x` times the first less `y` times the second, as one combination of scenes: nothing cancels."""
        (one, v), (other, w) = first, second
        a, b = pooled.mean(quantity, one, v), pooled.mean(quantity, other, w)
        scenes = np.union1d(one, other)
        weights = np.zeros((len(scenes), *a.shape))
        weights[np.searchsorted(scenes, one)] += np.multiply.outer(v, x * np.ones(a.shape))
        weights[np.searchsorted(scenes, other)] -= np.multiply.outer(w, y * np.ones(a.shape))
        together = np.maximum(pooled.variance(quantity, scenes, weights), 0.0)  # apart from rounding
        variances = pooled.variance(quantity, one, v), pooled.variance(quantity, other, w)
        return cls(a, b, together, x**2 * variances[0] + y**2 * variances[1])


def ratio_of(pooled: Pooled, quantity: str, first: Some, second: Some, separations: Array) -> Paired:
    """Return the ratio of two means, first over second, over the surfaces that both share.

    The error is that of ``b - r a``, one combination: what both share cancels before it is rounded.
    """
    b, a = pooled.mean(quantity, *first), pooled.mean(quantity, *second)
    with np.errstate(divide="ignore", invalid="ignore"):  # without a contact there is no ratio
        ratio = b / np.where(a == 0, np.nan, a)
        pair = Pair.of(pooled, quantity, first, second, 1.0, ratio)
        error = np.sqrt(pair.together / pooled.n) / np.abs(a)
        return Paired(quantity, separations, ratio, error, pair.apart / pair.together)


def _same_asperities(one: Ensemble, other: Ensemble) -> bool:
    """Whether the surfaces are the same, where contact laws put edges between cells."""
    scenes = [e.surfaces_of.drawn_by(e.sampler).with_surfaces(1) for e in (one, other)]
    if scenes[0] == scenes[1] or all(s.hertzian for s in scenes):
        return True
    from mcgw.sampling.asperities import same_heights  # compiled loops, which few pairs need

    return same_heights(*scenes)
