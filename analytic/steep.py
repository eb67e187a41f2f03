"""How far heights count where a grading rises, or the density of the heights falls, as nobody knows."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from analytic.gradings import Exponential, Grading, Homogeneous
from analytic.tables import Table

_LOST = 40.0  # logarithm of the weight lost outside: 4e-18 of its largest value
_STEP = 1.25
_MOST = 400  # steps: 1e38 times as far
_POINTS = 65


def tame(grading: Grading) -> bool:
    """Whether it is known to rise no faster than ``exp(-s)``, of which the normal law makes nothing."""
    inner = getattr(grading, "grading", grading)
    return isinstance(inner, Homogeneous | Exponential | Table)


@dataclass(frozen=True)
class Weight:
    """What heights weigh in an integral: density, powers of the modulus and of the distance.

    Parameters
    ----------
    log_density : callable
        Logarithm of the density at an array of heights.
    grading : Grading
        E*(s)/E*.
    power : int
        Of the modulus.
    exponent : float, optional
        Of the distance from where the integral starts.
    """

    log_density: Callable[[Array], Array]
    grading: Grading
    power: int
    exponent: float = 0.0

    def reach(self, start: float, end: float, limit: float) -> float:
        """Height beyond which nothing is left: `end`, or as much farther from `start` as it takes.

        On either side, never beyond `limit`. A ValueError if the weight does not fall, or the modulus is then
        beyond double precision.
        """
        steepest = 700.0 - 25.0 * self.power  # leaves room for the power of the approach
        found = end
        for _ in range(_MOST):
            weight, modulus = self._along(start, found)
            if found == limit or not weight[-1] > weight.max() - _LOST:
                if found == end or modulus.max() < steepest:
                    return found
                break
            if modulus.max() > steepest:
                break
            found = start + _STEP * (found - start)
            found = min(found, limit) if start < limit else max(found, limit)
        raise ValueError(
            f"grading: up to s = {found:.4g} E*(s)/E* increases too steeply, or the tail of the heights is "
            "too heavy, for a mean and a variance in double precision; let the grading level off"
        )

    def _along(self, start: float, end: float) -> tuple[Array, Array]:
        """Logarithms of the weight and of the power of the modulus, from `start` to `end`."""
        length = abs(end - start)
        far = np.linspace(0, length, _POINTS)
        if length:
            far = np.sort(np.concatenate([far, np.geomspace(length / 1e4, length, _POINTS)]))
        s = start + np.sign(end - start) * far
        s[-1] = end
        with np.errstate(divide="ignore"):
            modulus = self.power * np.log(np.abs(self.grading(s)))
        return self.log_density(s) + modulus + self.exponent * np.log1p(far), modulus
