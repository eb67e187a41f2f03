"""A surface from numbers that instruments state: ISO 25178-2 of areas, ISO 21920-2 of profiles.

The surface is isotropic and Gaussian, so each number is a product of powers of its moments m0, m2 and m4.
"""

import math
import warnings
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from analytic import SpectralMoments
from mcgw.scene.kinds import argument
from mcgw.scene.section import SceneError
from mcgw.scene.surface import Spectral, SpectralSurface


class Row(NamedTuple):
    """A number that is ``factor * m0^a m2^b m4^c``, with a formula and where it comes from."""

    unit: str
    factor: float
    powers: tuple[float, float, float]
    source: str


NUMBERS = {
    "Sq": Row("m", 1.0, (0.5, 0, 0), "m0 = Sq^2: definition"),
    "Sdq": Row("1", math.sqrt(2), (0, 0.5, 0), "m2 = Sdq^2/2: both slopes of an isotropic surface"),
    "Spc": Row("1/m", 8 / (3 * math.sqrt(math.pi)), (0, 0, 0.5), "8 sqrt(m4)/(3 sqrt(pi)): Nayak 1971"),
    "Spd": Row("1/m^2", 1 / (6 * math.pi * math.sqrt(3)), (0, -1, 1), "m4/(6 pi sqrt(3) m2): Nayak 1971"),
    "Rq": Row("m", 1.0, (0.5, 0, 0), "m0 = Rq^2: definition"),
    "Rdq": Row("1", 1.0, (0, 0.5, 0), "m2 = Rdq^2: definition"),
    "Rpd": Row("1/m", 1 / (2 * math.pi), (0, -0.5, 0.5), "peaks, sqrt(m4/m2)/(2 pi): Rice 1945"),
    "RSm": Row("m", 2 * math.pi, (0.5, -0.5, 0), "2 pi sqrt(m0/m2), between upward crossings: Rice 1945"),
}
_CORRELATED = ("Sal", "short", "autocorrelation")
_GIVES = {"m0": "Sq or Rq (heights)", "m2": "Sdq or Rdq (slopes), or RSm", "m4": "Spc, Spd or Rpd (peaks)"}
# Of 15 drawn maps (hurst 0.8, 250 to 2500 summits, 10 pixels to the shortest wave), Wolf pruning at 5 % of
# Sz over all summits: Spd 0.70, 0.50, 0.31, 0.19, 0.07 and Spc 1.13, 1.20, 1.24, 1.29, 1.31 times, for
# alpha 2, 3, 5, 10 and 30.
_APART = 1.05  # ratio of a number to that of the surface from all of them
_DEFAULT_PRUNING = 0.05  # of Sz, ISO 25178-3


def _moments_of_correlation(sq: float, given: Mapping[str, float], kind: str) -> SpectralMoments:
    """Moments of ``Sq^2 exp(-t^2/l^2)``, or of ``Sq^2 exp(-t/l)`` without waves below ``short``.

    At the distance Sal the autocorrelation is 0.2 (ISO 25178-2), which gives l. The exponential one has the
    spectrum ``(1 + q^2 l^2)^(-3/2)``, whose integrals to the cutoff are those below; Sq is that of the rest.
    """
    if "Sal" not in given:
        raise ValueError('autocorrelation: needs Sal, the length at which it is 0.2, such as "12 um"')
    if kind == "gaussian":
        if "short" in given:
            raise ValueError("short: is for autocorrelation = exponential; a gaussian one needs no cutoff")
        length = given["Sal"] / math.sqrt(math.log(5))
        return SpectralMoments(sq**2, 2 * sq**2 / length**2, 12 * sq**2 / length**4)
    if kind != "exponential":
        raise ValueError(f"autocorrelation = {kind!r}: give gaussian or exponential")
    if "short" not in given:
        raise ValueError(
            "autocorrelation = exponential: slopes and curvatures of its short waves diverge; give short, "
            'the cutoff wavelength, such as "2 um", or Sdq and Spc in its place'
        )
    length = given["Sal"] / math.log(5)
    w = math.hypot(1, 2 * math.pi * length / given["short"])
    q2 = w + 1 / w - 2
    q4 = w**3 / 3 - 2 * w - 1 / w + 8 / 3
    kept = 1 - 1 / w
    m0, square = sq**2, length**2
    return SpectralMoments(m0, m0 * q2 / (2 * square * kept), 3 * m0 * q4 / (8 * square**2 * kept))


def moments_from(
    numbers: Mapping[str, float | str], pruning: float = _DEFAULT_PRUNING
) -> tuple[SpectralMoments, list[str]]:
    """Return the moments of a surface with these numbers, and what is doubtful about them.

    They are given by their names, keys of `NUMBERS`; or Sq with Sal, ``autocorrelation`` and ``short``. Peaks
    below the share `pruning` of Sz were not counted for Spd and Spc. ValueError if a number is unknown, wrong
    or missing, or no isotropic surface has them all.
    """
    known = (*NUMBERS, *_CORRELATED)
    for key in numbers:
        if key not in known:
            raise ValueError(f"{key}: is not a number that tells of summits; give some of {', '.join(known)}")
    if not 0 <= pruning < 1:
        raise ValueError(f"pruning = {pruning!r}: give a share of Sz from 0 (all peaks) to below 1")
    given = {key: argument(key, numbers[key], row.unit) for key, row in NUMBERS.items() if key in numbers}
    if any(key in numbers for key in _CORRELATED):
        if set(given) != {"Sq"}:
            raise ValueError("Sal, autocorrelation: go with Sq alone, since they tell m2 and m4")
        lengths = {key: argument(key, numbers[key], "m") for key in ("Sal", "short") if key in numbers}
        kind = str(numbers.get("autocorrelation", "gaussian"))
        return _moments_of_correlation(given["Sq"], lengths, kind), []
    powers = np.array([NUMBERS[key].powers for key in given]).reshape(-1, 3)
    determined = np.linalg.pinv(powers) @ powers if len(powers) else np.zeros((3, 3))
    if missing := [name for k, name in enumerate(_GIVES) if determined[k, k] < 1 - 1e-9]:
        told = " and ".join(_GIVES[name] for name in missing)
        raise ValueError(f"{', '.join(given) or 'no number'}: does not tell {', '.join(missing)}; add {told}")
    logs = np.array([math.log(value / NUMBERS[key].factor) for key, value in given.items()])
    found = np.linalg.lstsq(powers, logs, rcond=None)[0]
    moments = SpectralMoments(*np.exp(found).tolist())
    doubts, off = [], powers @ found - logs
    if np.abs(off).max() >= math.log(_APART):
        factors = (f"{key} by a factor of {x:.3g}" for key, x in zip(given, np.exp(off), strict=True))
        doubts.append(f"the numbers disagree; the surface that suits all best has {', '.join(factors)}")
    if pruned := [key for key in ("Spd", "Spc") if key in given and pruning > 0]:
        doubts.append(
            f"{', '.join(pruned)}: the formula is for all summits; without those below "
            f"{100 * pruning:g} % of Sz an instrument states others: at 5 % Spd is 0.7 to 0.07 and Spc 1.1 "
            "to 1.3 times that of all, for alpha from 2 to 30; give pruning = 0 if none were left out"
        )
    if moments.alpha < 1.5:
        raise ValueError(
            f"{', '.join(given)}: alpha = m0 m4/m2^2 = {moments.alpha:.4g}, and an isotropic Gaussian "
            "surface has at least 1.5; all numbers must be of one map with one cutoff"
        )
    return moments, doubts


def surface_from(
    *,
    nominal_area: float | str,
    E_star: float | str,
    pruning: float = _DEFAULT_PRUNING,
    **numbers: float | str,
) -> Spectral:
    """Make an isotropic Gaussian surface from numbers of ISO 25178-2 or of profiles.

    Parameters
    ----------
    nominal_area : float or str
        m^2; or text such as "1 cm^2".
    E_star : float or str
        Composite modulus, Pa; or text such as "78.6 GPa".
    pruning : float, optional
        Share of Sz below which peaks did not count for Spd and Spc; 0: all counted.
    **numbers
        Sq (m), Sdq, Spc (1/m), Spd (1/m^2); of profiles Rq (m), Rdq, Rpd (peaks per length, 1/m), RSm (m);
        in SI units, or as text. Or Sq with Sal (m) and ``autocorrelation="gaussian"``, or ``"exponential"``
        with ``short``, the shortest wavelength (m).

    Returns
    -------
    Spectral
        The surface of a `mcgw.Scene`, as from `mcgw.SpectralSurface`.

    Raises
    ------
    SceneError
        If a number is unknown or wrong, or together they do not tell m0, m2 and m4.

    Warns
    -----
    UserWarning
        If the numbers disagree, or the peaks of Spd and Spc may have been pruned.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.surface_from(
    ...     Sq="0.8 um", Sdq=0.12, Spc="0.043/um", pruning=0, nominal_area="1 mm^2", E_star="100 GPa"
    ... )
    >>> round(surface.moments.alpha, 2)
    10.08
    """
    try:
        moments, doubts = moments_from(numbers, pruning)
    except ValueError as error:
        raise SceneError(getattr(error, "problems", [str(error)])) from None
    for line in doubts:
        warnings.warn(line, UserWarning, stacklevel=2)
    return SpectralSurface(moments.m0, moments.m2, moments.m4, nominal_area, E_star)
