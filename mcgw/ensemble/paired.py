"""Ensembles, or points of a sweep, over the same surfaces: ratios and differences of means, and slopes."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import CONFIDENCE
from mcgw.ensemble.pooled import PointResults, Pooled
from mcgw.formats.table import SEPARATION, Column, Drawn, Table
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import with_sampling

_PAIRED = ("surface", "separations", "heights", "n_asperities", "count", "seed")


@dataclass(frozen=True, repr=False)
class Paired(Drawn):
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

    def sheet(self) -> Table:
        """Ratios at some separations."""
        title = f"Ratio of the mean {self.quantity} over the same surfaces"
        return self.table().rows().under(title)

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


@dataclass(frozen=True)
class Difference:
    """Difference of two means over the same surfaces; arrays over the separations.

    Parameters
    ----------
    value, stderr : ndarray
        In SI units, and its standard error; nan for a single surface.
    gain : ndarray
        Variance of the difference of two independent ensembles of this size, divided by that of the pair.
    """

    value: Array
    stderr: Array
    gain: Array


@dataclass(frozen=True, repr=False)
class Slopes(Drawn):
    """Change of a mean with a key, between neighbouring points of a sweep.

    Parameters
    ----------
    quantity, key : str
        What changes, and the key with which it changes.
    axis : int
        Dimension of the arrays along which the key changes.
    at : ndarray
        Middle between two values of the key, shape (pairs,).
    value, stderr : ndarray
        Difference of the means over that of the key in SI units, and its standard error over the surfaces:
        shape of the sweep and separations, one less along the key.
    theory : ndarray
        The same difference of the exact means.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1], n_surfaces=200, seed=1)
    >>> sweep = mcgw.sweep(scene, {"grading.gamma": [1.0, 1.5, 2.0]})
    >>> slopes = sweep.slopes("load", "grading.gamma")
    >>> slopes.at
    array([1.25, 1.75])
    >>> bool((abs(slopes.value - slopes.theory) < 5 * slopes.stderr).all())
    True
    """

    quantity: str
    key: str
    axis: int
    at: Array
    value: Array
    stderr: Array
    theory: Array

    def sheet(self) -> Table:
        """Display slopes at the first separation, for some values of the key."""
        flat = [
            np.moveaxis(x, self.axis, 0).reshape(len(self.at), -1)[:, 0]
            for x in (self.value, self.stderr, self.theory)
        ]
        columns = (
            Column("at", self.at, self.key, form="g"),
            Column("slope", flat[0], unit="1"),
            Column("stderr", flat[1], unit="1", form=".1g"),
            Column("theory", flat[2], unit="1"),
        )
        title = f"Change of the mean {self.quantity} with {self.key}"
        return Table(columns, title).rows()


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
    first, second = (PointResults(pooled, np.array([k]), one) for k in (0, 1))
    return ratio_of(quantity, first, second, numerator.separations)


def ratio_of(quantity: str, first: PointResults, second: PointResults, separations: Array) -> Paired:
    """Return the ratio of two means, first over second, over the surfaces that both share.

    The error is that of ``b - r a``, one combination: what both share cancels before it is rounded.
    """
    b, a = (each.mean_and_std(quantity)[0] for each in (first, second))
    ratio = b / np.where(a == 0, np.nan, a)  # without a contact there is none
    between = difference_of(quantity, first, second, 1.0, ratio)
    return Paired(quantity, separations, ratio, between.stderr / np.abs(a), between.gain)


def difference_of(
    quantity: str, first: PointResults, second: PointResults, x: float | Array, y: float | Array
) -> Difference:
    """Return `x` times the first mean less `y` times the second, over the surfaces that both share.

    Its variance is that of one combination of scenes: nothing cancels.
    """
    pooled, (one, v), (other, w) = first.pooled, first.of(quantity), second.of(quantity)
    scenes, unit = np.union1d(one, other), np.ones(pooled.means[quantity].shape[1:])
    (b, d), (a, c) = (each.mean_and_std(quantity) for each in (first, second))
    weights = np.zeros((len(scenes), *unit.shape))
    weights[np.searchsorted(scenes, one)] += np.multiply.outer(v, x * unit)
    weights[np.searchsorted(scenes, other)] -= np.multiply.outer(w, y * unit)
    together = np.maximum(pooled.variance(quantity, scenes, weights), 0.0)  # apart from rounding
    with np.errstate(divide="ignore", invalid="ignore"):
        gain = ((x * d) ** 2 + (y * c) ** 2) / together
    return Difference(x * b - y * a, np.sqrt(together / pooled.n), gain)


def _same_asperities(one: Ensemble, other: Ensemble) -> bool:
    """Whether the surfaces are the same, where contact laws put edges between cells."""
    scenes = [with_sampling(e.surfaces_of.drawn_by(e.sampler), n_surfaces=1) for e in (one, other)]
    if scenes[0] == scenes[1] or all(s.hertzian for s in scenes):
        return True
    from mcgw.sampling.asperities import same_heights  # compiled loops, which few pairs need

    return same_heights(*scenes)
