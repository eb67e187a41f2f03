"""Correlations for the conductance of a joint by its spots, from the roughness of the whole surface."""

import math

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array


def mean_absolute_slope(m2: float) -> float:
    """Return the mean absolute slope of the profiles of a Gaussian surface, ``sqrt(2 m2/pi)``.

    Parameters
    ----------
    m2 : float
        Mean square slope of a profile; of a pair of surfaces the sum of both.

    Examples
    --------
    >>> round(mean_absolute_slope(0.01), 6)
    0.079788
    """
    return math.sqrt(2 * m2 / math.pi)


def cooper_mikic_yovanovich(
    pressure: ArrayLike, *, hardness: float, rms: float, slope: float, conductivity: float
) -> Array:
    """Return the contact conductance of yielding spots, ``1.25 k (m/sigma) (P/H)^0.95``.

    Parameters
    ----------
    pressure : array_like
        Nominal pressure P, Pa.
    hardness : float
        Hardness H of the softer body, Pa.
    rms : float
        Root mean square height of both surfaces together, sigma = sqrt(m0), m.
    slope : float
        Mean absolute slope m of both together: `mean_absolute_slope`.
    conductivity : float
        k of both bodies in series, ``2/(1/k1 + 1/k2)``, W/(m K).

    Returns
    -------
    ndarray
        Of the spots alone, W/(m^2 K), in the shape of `pressure`. It follows the theory below within 1.5 %
        for P/H from 1e-6 to 0.023.

    Notes
    -----
    Source: M. G. Cooper, B. B. Mikic, M. M. Yovanovich, Int. J. Heat Mass Transfer 12 (1969) 279; in this
    form M. M. Yovanovich, AIAA paper 82-0083 (1982) [mem: constants recalled; compared with the theory
    that they fit, ``h = k (m/sigma) exp(-y^2)/(2 sqrt(2 pi) (1 - sqrt(P/H))^1.5)``, ``erfc(y) = 2 P/H``].

    Examples
    --------
    Aluminium on aluminium at 1 MPa:

    >>> joint = {"rms": 1e-6, "slope": 0.1, "conductivity": 150.0}
    >>> float(cooper_mikic_yovanovich(1e6, hardness=1e9, **joint).round(1))
    26485.1
    """
    relative = np.asarray(pressure, dtype=np.float64) / hardness
    return np.asarray(1.25 * conductivity * slope / rms * relative**0.95)


def mikic_elastic(
    pressure: ArrayLike, *, E_star: float, rms: float, slope: float, conductivity: float
) -> Array:
    """Return the contact conductance of elastic spots, ``1.55 k (m/sigma) (P sqrt(2)/(E* m))^0.94``.

    Parameters
    ----------
    pressure : array_like
        Nominal pressure P, Pa.
    E_star : float
        Composite modulus E*, Pa.
    rms, slope, conductivity : float
        As for `cooper_mikic_yovanovich`.

    Returns
    -------
    ndarray
        Of the spots alone, W/(m^2 K), in the shape of `pressure`. It follows the theory below within 3 % for
        P/H_e from 3e-6 to 0.023.

    Notes
    -----
    Source: B. B. Mikic, Int. J. Heat Mass Transfer 17 (1974) 205 [mem: constants recalled; compared with
    the theory that they fit, ``h = k (m/sigma) exp(-y^2)/(4 sqrt(pi) (1 - sqrt(A))^1.5)``, the real over
    the nominal area being ``A = erfc(y)/4 = P/H_e`` with ``H_e = E* m/sqrt(2)``].

    Examples
    --------
    >>> joint = {"rms": 1e-6, "slope": 0.1, "conductivity": 150.0}
    >>> float(mikic_elastic(1e6, E_star=80e9, **joint).round(1))
    6902.4
    """
    relative = np.asarray(pressure, dtype=np.float64) * math.sqrt(2) / (E_star * slope)
    return np.asarray(1.55 * conductivity * slope / rms * relative**0.94)
