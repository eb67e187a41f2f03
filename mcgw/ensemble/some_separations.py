"""An ensemble at some of its separations, for tables and figures of those that hold thousands of them."""

from dataclasses import dataclass, replace

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held
from mcgw.formats.table import evenly

MOST_SHOWN = 100  # separations in a table or figure beside theory


@dataclass(frozen=True)
class _Some(Held):
    """Results of surfaces at some of the separations.

    Parameters
    ----------
    whole : Held
        At all separations.
    which : ndarray of int
        Numbers of the separations.
    """

    whole: Held
    which: Ints

    def rows(self) -> int:
        """Number of surfaces there are."""
        return self.whole.rows()

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        mean, std = self.whole.mean_and_std(name)
        return mean[self.which], std[self.which]

    def total_number(self, name: str) -> Array:
        """Sum of whole numbers over all surfaces."""
        return self.whole.total_number(name)[self.which]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a table."""
        return self.whole.read(name, start, stop)[:, self.which]

    def covariance(self, name: str, other: str) -> Array:
        """Between all numbers of two tables (divisor M - 1)."""
        found = self.whole.covariance(name, other)
        across = found.ndim - self.whole.mean_and_std(other)[0].ndim
        return np.take(np.take(found, self.which, axis=0), self.which, axis=across)


def at_separations(ensemble: Ensemble, which: Ints) -> Ensemble:
    """Return the same surfaces at some of the separations.

    Parameters
    ----------
    ensemble : Ensemble
        Of any kind.
    which : ndarray of int
        Numbers of the separations.

    Returns
    -------
    Ensemble
        Its `surfaces_of` are those of the whole.
    """
    scene = replace(ensemble.scene, separations=tuple(ensemble.separations[which].tolist()))
    return replace(ensemble, scene=scene, sums=_Some(ensemble.sums, which), drawn_for=ensemble.surfaces_of)


def shown(ensemble: Ensemble) -> Ensemble:
    """Return it at 100 of its separations, evenly over their number, or as it is if there are fewer."""
    count = len(ensemble.scene.separations)
    if count <= MOST_SHOWN:
        return ensemble
    rising = np.argsort(ensemble.separations, kind="stable")
    return at_separations(ensemble, np.sort(rising[evenly(count, MOST_SHOWN)]))


def how_many(ensemble: Ensemble) -> str:
    """Say at how many separations tables and figures are; nothing if at all of them."""
    count = len(ensemble.scene.separations)
    return f"at {MOST_SHOWN} of {count} separations" if count > MOST_SHOWN else ""
