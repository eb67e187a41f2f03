"""Bridges over the jumps of fitted laws: the law with them is continuous, and so are its slopes."""

from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from analytic.laws.derivative import derivative
from analytic.laws.elastic_plastic import ElasticPlastic, Formula

__all__ = ["BRIDGE", "Bridgeable"]

Array = NDArray[np.float64]

BRIDGE = 1.5  # a bridge ends at this multiple of the penetration of its jump


@dataclass(frozen=True)
class Bridgeable(ElasticPlastic):
    """A law whose fits jump, published so, or joined by cubic Hermite pieces.

    The bridge over a jump at x_j runs from x_j, so that what is elastic stays Hertz's, to 1.5 x_j. There
    load and area are the cubics in the penetration which take over value and slope of the fits at both
    ends; both rise all the way. After the idea of Brake (2012), whose own formulas are not these.

    Parameters
    ----------
    bridge : {None, "hermite"}, optional
        Whether fits are joined.
    """

    _: KW_ONLY
    bridge: Literal["hermite"] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.bridge not in (None, "hermite"):
            raise ValueError(f"bridge = {self.bridge!r}: give 'hermite', or leave it out")

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin: of bridges and fits in turn."""
        if self.bridge is None:
            return self.starts
        return tuple(x for start in self.starts for x in (start, BRIDGE * start))

    def _of(self, fit: Formula, power: float, piece: int, x: Any, e: Array) -> Any:
        e = np.where(np.asarray(e) > 0, e, 1.0)
        if self.bridge is None:
            return fit(piece, x, e)
        after = (piece + 1) // 2
        if piece % 2 == 0:
            return fit(after, x, e)
        start = self.starts[after - 1]
        left = _end(fit, power, after - 1, start, e)
        right = _end(fit, power, after, BRIDGE * start, e)
        return _hermite(left, right, x) / x**power


def _end(fit: Formula, power: float, index: int, x: float, e: Array) -> tuple[float, Array, Array]:
    """Penetration, value and slope at an end of a bridge, of Hertz's or a fit."""

    def value(x: Any) -> Any:
        return x**power * (fit(index, x, e) if index else 1.0)

    return x, np.asarray(value(x)), derivative(value, np.array(x))


def _hermite(left: tuple[float, Array, Array], right: tuple[float, Array, Array], x: Any) -> Any:
    """The cubic with these values and slopes at both ends."""
    width, rise = right[0] - left[0], right[1] - left[1]
    t = (x - left[0]) / width
    start, end = width * left[2] - rise, rise - width * right[2]
    return left[1] + t * rise + t * (1 - t) * ((1 - t) * start + t * end)
