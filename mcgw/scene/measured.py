"""What is known of a measured surface besides its summits: errors, what a fit saw, and one of two bodies."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic import Nayak, SpectralMoments, Surface
from analytic.arrays import Array, hold
from mcgw.scene.kinds import List, Number, Plain
from mcgw.scene.section import key

MOMENTS, SUMMITS = ("m0", "m2", "m4"), ("sigma", "radius", "eta")  # either describes summits of a surface
NO_SPECTRUM = "has no spectrum; give m0, m2, m4 under [surface], or a scene written by mcgw fit"
KNOWN = 'give relative standard errors, such as {sigma = "20 %", radius = "15 %"}'
_PARAMETERS = (*SUMMITS, *MOMENTS, "E_star")
_LARGEST = 2.0  # standard error of a logarithm: a factor of 7
_NEGATIVE = -1e-3  # allowed negative eigenvalue, from rounding
_SHOWN = 3  # cautions
_ERROR = Number("1", high=_LARGEST, advice=KNOWN)
_ROWS = List(List(Number(low=-1.0, high=1.0)), advice="give rows of numbers from -1 to 1")
_RATIO = Number(low=1, advice="give the larger over the smaller, a number >= 1")
_CAUTIONS = List(Plain(), 0, advice="give a list of texts")


@dataclass(frozen=True)
class Uncertainty:
    """Standard errors of the logarithms of a surface's parameters: small ones are shares of the values.

    None: it is known. With the `correlation` of those that are given, in this order, unless they are
    independent; ValueError if it is not square, symmetric and positive, with ones on its diagonal.
    """

    sigma: float | None = key(_ERROR)
    radius: float | None = key(_ERROR)
    eta: float | None = key(_ERROR)
    m0: float | None = key(_ERROR, excludes=SUMMITS)
    m2: float | None = key(_ERROR, excludes=SUMMITS)
    m4: float | None = key(_ERROR, excludes=SUMMITS)
    E_star: float | None = key(_ERROR)
    correlation: Sequence[Sequence[float]] | None = key(_ROWS)

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


@dataclass(frozen=True)
class Fitted:
    """What a fit knew of a surface besides its summits: by it `Scene.validity` tells whether it fits.

    Parameters
    ----------
    m0, m2, m4 : float
        Spectral moments, m^2, 1, 1/m^2: means over all directions.
    skewness, kurtosis : float
        Skewness and kurtosis of all heights: 0 and 3 of Gaussian ones.
    independent : float
        How many independent heights would tell m0 as well: few where long waves are.
    agreement : float or None
        Largest ratio, at least 1, between what moments and counted summits say of eta, R or sigma; of
        profiles between the peaks that are counted and those that follow from the moments. None: summits
        were too few to be counted.
    lay : float or None
        Mean square slope across the lay over that along it, at least 1; None: nobody saw it.
    area : float or None
        Area of the map, m^2; None: along lines only.
    cautions : tuple of str
        Warnings of `mcgw.fit`, the most serious first.
    """

    m0: float = key(Number("m^2"), "1e-12", required=True)
    m2: float = key(Number("1"), "1e-3", required=True)
    m4: float = key(Number("1/m^2"), "5e6", required=True)
    skewness: float = key(Number(low=-math.inf), "-0.1", required=True)
    kurtosis: float = key(Number(), "3.0", required=True)
    independent: float = key(Number(), "800.0", required=True)
    agreement: float | None = key(_RATIO, "1.02")
    lay: float | None = key(_RATIO, "1.1")
    area: float | None = key(Number("m^2"), "1e-6")
    cautions: tuple[str, ...] = key(_CAUTIONS, '["lay: mean square slopes 2 : 1"]', ())

    @property
    def moments(self) -> SpectralMoments:
        """m0, m2 and m4."""
        return SpectralMoments(self.m0, self.m2, self.m4)

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


@dataclass(frozen=True)
class RoughBody:
    """One of two rough bodies, or both as one; None or empty: unknown."""

    moments: SpectralMoments
    E_star: float | None = None  # composite modulus of this body alone on a rigid plane, E/(1 - nu^2), Pa
    hardness: float | None = None  # Pa
    conductivities: tuple[float, ...] = ()  # thermal, of the body, or of both of a pair, W/(m K)

    def beside(self, other: "RoughBody") -> "RoughBody":
        """Return both as one on a rigid plane: the gap between two independent isotropic Gaussian surfaces.

        Its hardness is that of the softer body. What is not known of both is unknown.
        """
        a, b = self.moments, other.moments
        moduli, hardness = (self.E_star, other.E_star), (self.hardness, other.hardness)
        known = self.conductivities and other.conductivities
        return RoughBody(
            SpectralMoments(a.m0 + b.m0, a.m2 + b.m2, a.m4 + b.m4),
            None if None in moduli else 1 / sum(1 / E for E in moduli if E),
            None if None in hardness else min(x for x in hardness if x),
            self.conductivities + other.conductivities if known else (),
        )


def moments_of(surface: Surface, heights: Any, fitted: Fitted | None) -> SpectralMoments | None:
    """Return the moments of the fitted map, or of Nayak's heights; None without either."""
    if fitted is not None:
        return fitted.moments
    return SpectralMoments.with_alpha(heights.alpha, surface) if isinstance(heights, Nayak) else None


def body_of(scene: Any) -> RoughBody:
    """Return the body of a scene on a rigid plane; ValueError without a spectrum, or if it is a pair."""
    moments, pair = moments_of(scene.surface, scene.heights, scene.fitted), scene.joint.conductivities or ()
    if moments is None:
        raise ValueError(NO_SPECTRUM)
    if len(set(pair)) > 1:
        cure = "a body has equal ones, as [150.0, 150.0]"
        raise ValueError(f"joint.conductivities = {list(pair)}: those of a pair; {cure}")
    hardness = scene.contact.hardness or getattr(scene.contact.law, "hardness", None)
    return RoughBody(moments, scene.surface.E_star, hardness, tuple(pair[:1]))
