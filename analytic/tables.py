"""A measured grading: points of E*(s)/E* against height."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from analytic.arrays import Array, hold

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


@dataclass(frozen=True)
class Table:
    """A measured grading: monotone interpolation (PCHIP), clamped outside the data.

    Parameters
    ----------
    s : sequence of float
        Reduced heights z/sigma, increasing.
    ratio : sequence of float
        E*(s)/E* at these heights.

    Raises
    ------
    ValueError
        If there are fewer than two points, if they are not finite, or not increasing in `s`.

    Examples
    --------
    >>> import numpy as np
    >>> Table([0.0, 1.0, 2.0], [1.0, 1.5, 3.0])(np.array([-1.0, 1.0, 9.0]))
    array([1. , 1.5, 3. ])
    """

    s: tuple[float, ...]
    ratio: tuple[float, ...]
    smooth: bool = True

    def __init__(self, s: Sequence[float], ratio: Sequence[float]) -> None:
        hold(self, s=tuple(map(float, s)), ratio=tuple(map(float, ratio)))
        if len(self.s) != len(self.ratio) or len(self.s) < 2:
            raise ValueError(
                f"table: give two or more points, as many s as ratio, not {len(self.s)} and {len(self.ratio)}"
            )
        if not np.all(np.isfinite([self.s, self.ratio])):
            raise ValueError("table: every height and modulus must be finite")
        if not np.all(np.diff(self.s) > 0):
            raise ValueError("table: the heights must increase from row to row")

    @property
    def breaks(self) -> tuple[float, ...]:
        """The knots: the interpolant has one continuous derivative there."""
        return self.s

    @cached_property
    def _interpolant(self) -> "PchipInterpolator":
        from scipy.interpolate import PchipInterpolator  # a third of what the import of all else here takes

        return PchipInterpolator(self.s, self.ratio)

    def __call__(self, s: Array) -> Array:
        """Return the interpolant; outside the data the nearest value."""
        return np.asarray(self._interpolant(np.clip(s, self.s[0], self.s[-1])), dtype=np.float64)
