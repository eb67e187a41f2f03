"""Uncertainty of the parameters of a surface, ``uncertainty`` under ``[surface]``."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, hold

_PARAMETERS = ("sigma", "radius", "eta", "m0", "m2", "m4", "E_star")
_LARGEST = 2.0  # standard error of a logarithm: a factor of 7
_NEGATIVE = -1e-3  # allowed negative eigenvalue, from rounding


@dataclass(frozen=True)
class Uncertainty:
    """Standard errors of the logarithms of a surface's parameters: small ones are shares of the values.

    None: it is known. With the `correlation` of those that are given, in this order, unless they are
    independent; ValueError if it is not square, symmetric and positive, with ones on its diagonal.
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
