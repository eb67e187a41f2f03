"""How the composite modulus depends on height: E*(s)/E*, s in units of sigma."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold

_STEEPEST = 500.0  # whose exponential is a number, also times a large one


class Grading(Protocol):
    """E*(s)/E* as a function of the reduced height s."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Heights where the grading or one of its derivatives jumps."""

    @property
    def smooth(self) -> bool:
        """Whether it varies slowly, on the scale of one sigma, between them: a fixed rule resolves it."""

    def __call__(self, s: Array) -> Array:
        """E*(s)/E* at the heights `s`, in the shape of `s`."""


@dataclass(frozen=True)
class Homogeneous:
    """The same modulus at every height (Greenwood and Williamson).

    Examples
    --------
    >>> Homogeneous()(np.array([0.0, 2.0]))
    array([1., 1.])
    """

    breaks: tuple[float, ...] = ()
    smooth: bool = True
    zeros: ClassVar[tuple[float, ...]] = ()

    def __call__(self, s: Array) -> Array:
        """E*(s)/E* = 1."""
        return np.ones_like(s)


@dataclass(frozen=True)
class Exponential:
    """Exponential grading, Eq. (4) of the paper: ``gamma + (1 - gamma) exp(-s)``.

    Parameters
    ----------
    gamma : float
        Modulus of the highest asperities relative to that at the mean height. A factor: the paper's
        "exponent" is a slip.

    Raises
    ------
    ValueError
        If `gamma` is not finite.

    Examples
    --------
    >>> Exponential(2.0)(np.array([0.0, 30.0]))
    array([1., 2.])
    """

    breaks: ClassVar[tuple[float, ...]] = ()

    gamma: float
    smooth: bool = True

    def __post_init__(self) -> None:
        if not math.isfinite(self.gamma):
            raise ValueError(f"gamma = {self.gamma!r}: give a finite number (1 is homogeneous)")

    def __call__(self, s: Array) -> Array:
        """``gamma - (gamma - 1) exp(-s)``, Eq. (4)."""
        return self.gamma - (self.gamma - 1) * np.exp(-s)

    def ends(self, s: ArrayLike) -> tuple[Array, float]:
        """Moduli at a height and far above it, between which those of all higher ones lie."""
        return self(np.maximum(s, -_STEEPEST)), self.gamma

    @property
    def zero(self) -> float:
        """Height where the modulus vanishes (nan for gamma in [0, 1]); it is negative on one side."""
        if 0 <= self.gamma <= 1:
            return math.nan
        return -math.log(self.gamma / (self.gamma - 1))

    @property
    def zeros(self) -> tuple[float, ...]:
        """Heights where the modulus changes its sign."""
        return () if math.isnan(self.zero) else (self.zero,)


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
    def _interpolant(self) -> Any:
        from scipy.interpolate import PchipInterpolator  # a third of what the import of all else here takes

        return PchipInterpolator(self.s, self.ratio)

    def __call__(self, s: Array) -> Array:
        """Return the interpolant; outside the data the nearest value."""
        return np.asarray(self._interpolant(np.clip(s, self.s[0], self.s[-1])), dtype=np.float64)


@dataclass(frozen=True)
class Custom:
    """A grading given as any Python function of height.

    Parameters
    ----------
    function : callable
        Takes an array of reduced heights, returns E*(s)/E* in the same shape.
    breaks : tuple of float, optional
        Heights where it jumps or has a kink. Without them they are searched for, which takes time.
    smooth : bool, optional
        Whether it is smooth between them.
    checked : bool, optional
        Whether a scene refuses it if it is above 1000 or below 0.001 at all heights that touch, as moduli in
        pascals are.

    Examples
    --------
    >>> Custom(lambda s: np.where(s > 1, 1.5, 1.0), breaks=(1.0,))(np.array([0.0, 2.0]))
    array([1. , 1.5])
    """

    function: Callable[[Array], ArrayLike]
    breaks: tuple[float, ...] = ()
    smooth: bool = False
    checked: bool = True

    def __call__(self, s: Array) -> Array:
        """Values of the function; a ValueError where one is not finite, or for another shape."""
        with np.errstate(all="ignore"):  # what comes of it is checked below
            value = np.asarray(self.function(s), dtype=np.float64)
        if value.shape not in (s.shape, ()):
            raise ValueError(f"grading: gave shape {value.shape} for heights of shape {s.shape}")
        value = np.broadcast_to(value, s.shape)
        if not np.all(np.isfinite(value)):
            where = float(s[~np.isfinite(value)].flat[0])
            raise ValueError(f"grading: E*(s)/E* is not finite at s = {where:.6g}")
        return value


@dataclass(frozen=True)
class Clipped:
    """A grading whose negative moduli are replaced by zero.

    Parameters
    ----------
    grading : Grading
        What to clip.
    zeros : tuple of float, optional
        Heights where it changes sign; the exponential grading and series know theirs.
    """

    grading: Grading
    zeros: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if self.zeros is None:
            hold(self, zeros=getattr(self.grading, "zeros", None))

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those of the grading, and its zeros."""
        return tuple(sorted({*self.grading.breaks, *(self.zeros or ())}))

    @property
    def smooth(self) -> bool:
        """As the grading, where its zeros are known, or that it has none."""
        return self.grading.smooth and self.zeros is not None

    def __call__(self, s: Array) -> Array:
        """Return the positive part of the grading."""
        return np.maximum(self.grading(s), 0.0)
