"""Bins in which the values of surfaces are counted, so that quantiles need no values.

Around the exact mean they are as wide as 1/128 of a scale, the largest power of two below the exact
standard deviation, and wider in proportion to the distance beyond that. Both ends of a bin are exact binary
numbers, so that a value falls into the same bin on every processor.
"""

from dataclasses import dataclass

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.intervals import moments
from mcgw.scene.scene import Scene

_BITS = 7  # of a distance that tell its bin: 128 bins for each doubling
_DOUBLINGS = 14  # of the distance; what lies beyond is in the last bin, and the extremes are known
_HALF = _DOUBLINGS << _BITS
NUMBER = 2 * _HALF
_FIRST = 1023 << _BITS  # these bits of the number 1
_OFF_TIES = 0.3  # no mean that people ask for lies half way between two centres


@dataclass(frozen=True)
class Bins:
    """Of each number that a surface has, in the order of `Scene.shapes`.

    Parameters
    ----------
    centre, scale : ndarray
        Where its bins are narrowest, and the power of two they are measured in; shape (columns,).
    """

    centre: Array
    scale: Array

    @classmethod
    def of(cls, scene: Scene) -> "Bins":
        """Those of a scene, from the exact mean and standard deviation of a surface."""
        known_already = _of_independent(scene)
        found = [known_already.get(name) or _mean_and_std(scene, name) for name in scene.shapes]
        mean, std = (np.concatenate([np.ravel(pair[i]) for pair in found]) for i in (0, 1))
        known = np.isfinite(std) & (std > 0) & np.isfinite(mean)
        scale = np.exp2(np.floor(np.log2(np.where(known, std, 1.0))))
        centre = np.floor(np.where(known, mean, 0.0) / scale + _OFF_TIES) * scale
        return cls(centre, scale)

    def counts(self, column: int, values: Array) -> Ints:
        """How many of some values of a column are in each of its bins."""
        z = (values - self.centre[column]) / self.scale[column]
        place = ((np.abs(z) + 1).view(np.int64) >> (52 - _BITS)) - _FIRST
        np.minimum(place, _HALF - 1, out=place)
        return np.bincount(np.where(z < 0, _HALF - 1 - place, _HALF + place), minlength=NUMBER)

    def ends(self, columns: Ints, bins: Ints, *, whole: bool) -> tuple[Array, Array]:
        """Between which values lies what is in some bins, one of each column; the outermost have no end.

        Parameters
        ----------
        columns, bins : ndarray
            Of the same shape.
        whole : bool
            Whether values are whole numbers: then both ends are such values.
        """
        above = bins >= _HALF
        place = np.where(above, bins - _HALF, _HALF - 1 - bins)
        near, far = _distance(place), np.where(place == _HALF - 1, np.inf, _distance(place + 1))
        low, high = np.where(above, near, -far), np.where(above, far, -near)
        low, high = (self.centre[columns] + self.scale[columns] * end for end in (low, high))
        if whole:  # an end of a bin belongs to it on the side of the centre
            low = np.where(above, np.ceil(low), np.floor(low) + 1)
            high = np.where(above, np.ceil(high) - 1, np.floor(high))
        return low, high


def _distance(place: Ints) -> Array:
    """Distance from the centre, in scales, at which a bin begins."""
    return np.asarray(np.ldexp(1 + (place & (1 << _BITS) - 1) / (1 << _BITS), place >> _BITS) - 1)


def _of_independent(scene: Scene) -> dict[str, tuple[Array, Array]]:
    """Exact mean and standard deviation of all quantities at once, of asperities that are independent."""
    if scene.interaction is not None:
        return {}
    names = scene.quantities
    mean, variance = moments(scene, names, (2,)) * scene.n_asperities
    scale = [quantity_of(name).scale(scene.surface) for name in names]
    pairs = zip(mean, np.sqrt(np.maximum(variance, 0.0)), scale, strict=True)
    return {name: (m * unit, std * unit) for name, (m, std, unit) in zip(names, pairs, strict=True)}


def _mean_and_std(scene: Scene, name: str) -> tuple[Array, Array]:
    """Exact, of what one surface has of a table."""
    h, theory = np.array(scene.separations), scene.theory
    if name != "tangential_load" or scene.tangential is None:
        return theory.mean(name, h), theory.std(name, h)
    pushed = scene.tangential
    apart = [
        theory.covariance(["load"], [*h, *(h + shift)])[0, :, 0] for shift in pushed.shifts(scene.surface)
    ]
    n = np.arange(len(h))
    variance = np.stack([c[n, n] + c[n + len(h), n + len(h)] - 2 * c[n, n + len(h)] for c in apart], axis=-1)
    return theory.tangential_load(h, pushed), pushed.friction * np.sqrt(np.maximum(variance, 0.0))
