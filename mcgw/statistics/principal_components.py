"""Independent combinations of everything that is asked: the principal axes of its exact correlation.

Sums of one surface at several separations share their asperities. Turned to these axes they are
uncorrelated, of mean 0 and variance 1, with known third and fourth cumulants: a test needs no more.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Quantity, quantity_of
from analytic.arrays import Array
from mcgw.scene.scene import Scene
from mcgw.statistics.verdict import allowance, bounded_theory, told_apart

_TOUCHING = 100  # asperities expected in contact, so that a single surface is nearly Gaussian
_INDEPENDENT = 1e-6  # variance of a combination that is more than a difference of nearly equal columns
_MOST_KURTOSIS = 0.5  # of a combination over surfaces


@dataclass(frozen=True)
class PrincipalComponents:
    """Axes and the exact distribution along them.

    Parameters
    ----------
    columns : tuple of (str, int)
        Quantity and number of the separation of what is combined.
    mean, std : ndarray
        Exact, of each column.
    axes : ndarray
        Shape (columns, axes).
    skewness, kurtosis : ndarray
        Exact third and fourth cumulant along each axis.
    """

    columns: tuple[tuple[str, int], ...]
    mean: Array
    std: Array
    axes: Array
    skewness: Array
    kurtosis: Array

    @classmethod
    def of(
        cls, scene: Scene, quantities: tuple[str, ...] = (), *, surfaces: int = 1
    ) -> "PrincipalComponents":
        """The axes of a scene: of those separations where single surfaces are nearly Gaussian.

        Of all its quantities, unless some are named; and of those combinations in which means over so many
        surfaces do not show how accurate values are.
        """
        n, h, quantities = scene.n_asperities, np.array(scene.separations), quantities or scene.quantities
        parts = bounded_theory(scene, scene.n_surfaces).fluctuations(quantities, h)
        variance = parts.moment(2)
        share = np.concatenate([_share(scene, quantity_of(name), h) for name in quantities])
        touching = n * np.minimum(share, 1 - share + (scene.count == "poisson"))
        chosen = np.flatnonzero((touching > _TOUCHING) & (variance > 0))
        unit = np.sqrt(variance[chosen])
        allowed = allowance(scene, n * parts.mean[chosen], np.sqrt(n / surfaces) * unit)
        axes = parts.take(chosen, unit).whitening(max(_INDEPENDENT, told_apart(allowed)))
        along = parts.take(chosen, unit).turned(axes)
        third, fourth = along.moment(3), along.moment(4) - 3 * (scene.count == "fixed")
        good = np.abs(fourth) / n < _MOST_KURTOSIS
        columns = tuple((quantities[c // len(h)], c % len(h)) for c in chosen.tolist())
        scale = np.array([quantity_of(name).scale(scene.surface) for name, _ in columns])
        return cls(
            columns,
            n * scale * parts.mean[chosen],
            np.sqrt(n) * scale * unit,
            axes[:, good],
            third[good] / np.sqrt(n),
            fourth[good] / n,
        )

    def turn(self, sums: Mapping[str, NDArray[Any]]) -> Array:
        """Every surface along the axes, shape (surfaces, axes)."""
        if not self.columns:
            return np.empty((len(next(iter(sums.values()))), 0))
        values = np.stack([sums[name][:, k] for name, k in self.columns], axis=1).astype(np.float64)
        return np.asarray((values - self.mean) / self.std @ self.axes)


def _share(scene: Scene, q: Quantity, h: Array) -> Array:
    """Share of the asperities that add to a quantity."""
    if q.base == "yielded":
        return scene.theory.mean("yielded", h) / scene.n_asperities
    if q.unloading and not scene.law.elastic:
        return scene.theory.mean("contacts_unloading", h) / scene.n_asperities
    return scene.heights.sf(h)
