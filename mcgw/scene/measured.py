"""Measurements of the surface behind a scene.

The table ``[fitted]``, from the fit of a map or profiles, and the uncertainty of the parameters,
``uncertainty`` under ``[surface]``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic import SpectralMoments, Surface
from analytic.arrays import Array, hold

_SHOWN = 3  # cautions


@dataclass(frozen=True)
class Fitted:
    """What a fit knew of a surface besides its summits: by it `Scene.validity` tells whether it fits.

    Parameters
    ----------
    m0, m2, m4 : float
        Spectral moments, m^2, 1, 1/m^2: means over all directions.
    skewness, kurtosis : float
        Of all heights: 0 and 3 of Gaussian ones.
    independent : float
        How many independent heights would tell m0 as well: few where long waves are.
    agreement : float or None
        Largest ratio, at least 1, between what moments and counted summits say of eta, R or sigma; of
        profiles between the peaks that are counted and those that follow from the moments. None: summits
        were too few to be counted.
    lay : float or None
        Mean square slope across the lay over that along it, at least 1; None: nobody saw it.
    area : float or None
        That was looked at, m^2; None: along lines only.
    cautions : tuple of str
        Warnings of `mcgw.fit`, the most serious first.
    """

    m0: float
    m2: float
    m4: float
    skewness: float
    kurtosis: float
    independent: float
    agreement: float | None = None
    lay: float | None = None
    area: float | None = None
    cautions: tuple[str, ...] = ()

    @property
    def moments(self) -> SpectralMoments:
        """m0, m2 and m4."""
        return SpectralMoments(self.m0, self.m2, self.m4)

    def off(self, surface: Surface) -> float:
        """Largest ratio, at least 1, of eta, R and sigma of a surface to those from the moments."""
        m = self.moments
        pairs = ((surface.eta, m.eta), (surface.radius, m.radius), (surface.sigma, m.sigma))
        return max(max(a, b) / min(a, b) if min(a, b) > 0 else math.inf for a, b in pairs)

    @property
    def gravest(self) -> list[str]:
        """The cautions to display, at most three."""
        shown, more = [f"fit: {line}" for line in self.cautions[:_SHOWN]], len(self.cautions) - _SHOWN
        if more > 0:
            shown[-1] += f" (and {more} more under [fitted] in the scene)"
        return shown

    def lines(self) -> tuple[str, str]:
        """Lines about the spectrum and other properties of the map."""
        lay = "" if self.lay is None else f", lay {self.lay:.3g}"
        apart = "" if self.agreement is None else f", estimates differ by a factor of {self.agreement:.3g}"
        return (
            f"alpha = {self.moments.alpha:.4g}, rms slope {math.sqrt(2 * self.m2):.3g}{lay}",
            f"skewness {self.skewness:.2f}, kurtosis {self.kurtosis:.2f}{apart}",
        )


_PARAMETERS = ("sigma", "radius", "eta", "m0", "m2", "m4", "E_star")
_LARGEST = 2.0  # standard error of a logarithm: a factor of 7
_NEGATIVE = -1e-3  # allowed negative eigenvalue, from rounding


@dataclass(frozen=True)
class Uncertainty:
    """Standard errors of the logarithms of a surface's parameters: small ones are shares of the values.

    Parameters
    ----------
    sigma, radius, eta, m0, m2, m4, E_star : float, optional
        Of each; None: it is known.
    correlation : sequence of sequence of float, optional
        Of the logarithms of those that are given, in the order above; None: they are independent.

    Raises
    ------
    ValueError
        If there is no parameter, or the correlation is none: not square, symmetric and positive, with ones
        on its diagonal.
    """

    sigma: float | None = None
    radius: float | None = None
    eta: float | None = None
    m0: float | None = None
    m2: float | None = None
    m4: float | None = None
    E_star: float | None = None
    correlation: Sequence[Sequence[float]] | None = None

    def __post_init__(self) -> None:
        n = len(self.names)
        if not n:
            raise ValueError(f"sigma: does not name a parameter; give one of {', '.join(_PARAMETERS)}")
        if self.correlation is None:
            return
        hold(self, correlation=tuple(map(tuple, self.correlation)))
        if [len(row) for row in self.correlation] != [n] * n:
            raise ValueError(f"correlation: give {n} rows of {n} numbers, for {', '.join(self.names)}")
        matrix = np.array(self.correlation)
        if not (np.allclose(matrix, matrix.T, atol=1e-6) and np.allclose(np.diag(matrix), 1, atol=1e-6)):
            raise ValueError("correlation: must be symmetric, with ones on its diagonal")
        if np.linalg.eigvalsh(matrix)[0] < _NEGATIVE:
            raise ValueError("correlation: impossible, because an eigenvalue is negative")

    @classmethod
    def correlated(cls, names: Sequence[str], errors: Sequence[float], covariance: Array) -> "Uncertainty":
        """With the correlation of a covariance, whatever its variances, to four digits."""
        deviation = np.sqrt(np.diag(covariance))
        rows = np.round(covariance / np.outer(deviation, deviation), 4).tolist()
        found = {name: min(float(x), _LARGEST) for name, x in zip(names, errors, strict=True)}
        return cls(**found, correlation=rows)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that are uncertain."""
        return tuple(name for name in _PARAMETERS if getattr(self, name) is not None)

    @property
    def covariance(self) -> Array:
        """Of the logarithms, shape (parameters, parameters)."""
        errors = np.array([getattr(self, name) for name in self.names])
        matrix = np.eye(errors.size) if self.correlation is None else np.array(self.correlation)
        return np.asarray(matrix * np.outer(errors, errors))
