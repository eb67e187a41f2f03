"""Gradings, height laws and contact laws: objects that Python gives, or made of the keys of their tables."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

import analytic
from analytic import Custom, Grading, HeightLaw, Surface
from analytic.arrays import Array
from analytic.laws import CustomLaw, Hertz, by_name
from mcgw.formats.named_files import columns_of, numbers_of
from mcgw.scene.section import Section, signature_of

OF_YIELD = ("hardness", "poisson")  # which tell beside an elastic law whether contacts yield
LAWS: dict[str, dict[str, Any]] = {  # by their words in the tables of a scene
    "grading": {
        "homogeneous": analytic.Homogeneous,
        "exponential": analytic.Exponential,
        "table": analytic.Table,
        "series": analytic.PiecewiseSeries,
    },
    "heights": {
        "gaussian": analytic.Gaussian,
        "exponential": analytic.ExponentialHeights,
        "weibull": analytic.Weibull,
        "nayak": analytic.Nayak,
        "table": analytic.HeightTable,
        "scipy": analytic.ScipyHeights,
    },
    "contact.law": {**by_name, "custom": CustomLaw},
}
DEFAULTS: dict[str, Any] = {
    "grading": analytic.Homogeneous(),
    "heights": analytic.Gaussian(),
    "contact.law": Hertz(),
}
_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "log_pdf")
_MOST_BYTES, _MOST_OF_MODULI = 2**28, 2**24
_SUMMITS: list[dict[str, tuple[str, float]]] = [{"height": ("m", 1.0)}, {"radius": ("m", 1.0)}]


@dataclass(frozen=True)
class Graded:
    """Moduli against height, with what happens where they are negative.

    Parameters
    ----------
    law : Grading or callable
        As `mcgw.Scene` takes it alone.
    negative : {"error", "clip", "allow"}, optional
        What to do if it makes the modulus of a contacting asperity negative: refuse the scene, set the
        modulus to zero, or take it as it is.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1 um", "10 um", "300/mm^2", "1 cm^2", "80 GPa")
    >>> softer = mcgw.Graded(mcgw.Exponential(-0.5), negative="clip")
    >>> mcgw.Scene(surface, separations=0.0, grading=softer).negative
    'clip'
    """

    law: analytic.Grading | Callable[[Any], Any] | None
    negative: Literal["error", "clip", "allow"] = "error"


def grading_given(given: Any) -> Grading | None:
    """Accept a grading, or any function of an array of heights."""
    if isinstance(given, type) or not callable(given):
        return None
    return given if hasattr(given, "breaks") and hasattr(given, "smooth") else Custom(given)


def heights_given(given: Any) -> HeightLaw | None:
    """Accept a height law, or a frozen distribution of scipy.stats."""
    if hasattr(given, "dist"):
        return analytic.ScipyHeights(given)
    own = all(hasattr(given, name) for name in _LAW_OF_HEIGHTS) and not isinstance(given, type)
    return given if own else None


def law_of(section: Section, **beside: Any) -> Any:
    """Return a law that is given, or make the one whose word stands there, from those keys it takes.

    And from what there is `beside`, as the folder of its files; mistakes are noted and give None.
    """
    if not section.table:
        return DEFAULTS[section.name]
    key = "law" if "law" in section.rows else "name"
    default = "exponential" if "gamma" in section.values else section.rows[key].default
    law = section.values.get(key, None if key in section.table else default)
    if law is None:
        return None  # unknown, so that its keys cannot be checked
    if not isinstance(law, str):
        for name in section.values:
            if name not in (key, "negative", *OF_YIELD):
                section.fail(name, f"give it to the law, {type(law).__name__}, or leave it out")
        return law
    makes = LAWS[section.name] | _OF_KEYS[section.name]
    known = {word: signature_of(make).parameters for word, make in makes.items()} if section.values else {}
    for name in section.values:
        laws = [repr(word) for word, names in known.items() if name in names]
        if laws and repr(law) not in laws and name not in OF_YIELD:
            only = f"it is for {key} = {' or '.join(laws)} only; leave it out"
            section.problems.append(f"{section.path}{name}: unknown key; {only}")
    return section.make(makes[law], f'{key} = "{law}" needs it', **beside)


def table_of_moduli(
    folder: Path, surface: Surface | None, file: str | None = None, s: Any = (), ratio: Any = ()
) -> analytic.Table | None:
    """Make a grading of points, or of a CSV file: ``s`` or ``z`` (m), and ``ratio`` or ``E_star`` (Pa)."""
    if file is None:
        return analytic.Table(s, ratio)
    if surface is None:
        return None
    heights = {"s": ("1", 1.0), "z": ("m", surface.sigma)}
    moduli = {"ratio": ("1", 1.0), "E_star": ("Pa", surface.E_star)}
    s, ratio = columns_of(folder / file, _MOST_OF_MODULI, heights, moduli)
    order = np.argsort(s, kind="stable")
    try:
        return analytic.Table(s[order].tolist(), ratio[order].tolist())
    except ValueError as error:
        raise ValueError(f"{folder / file}: {error}") from None


def table_of_heights(
    folder: Path, heights: Any = None, file: Any = None, resample: bool = True, s: Any = (), share: Any = ()
) -> HeightLaw:
    """Make a height law of measured heights, of their file, or of points of the distribution."""
    sample = heights if file is None else numbers_of(folder / file, _MOST_BYTES)
    if sample is None:
        return analytic.HeightTable(s, share)
    return analytic.HeightTable.of(sample) if resample else analytic.MeasuredHeights(sample)


def scipy_heights(name: str = "norm", shapes: Mapping[str, float] | None = None) -> HeightLaw:
    """Make a height law of a distribution of scipy.stats."""
    import scipy.stats  # takes half a second; other scenes do not need it

    distribution = getattr(scipy.stats, name, None)
    if not isinstance(distribution, scipy.stats.rv_continuous):
        raise ValueError('name: give a continuous distribution of scipy.stats, such as "gamma"')
    try:
        return analytic.ScipyHeights(distribution(**(shapes or {})))
    except (TypeError, ValueError) as error:
        wanted = distribution.shapes or "none"
        raise ValueError(f"shapes: give its shapes ({wanted}), such as {{a = 4.0}}; {error}") from None


def listed_summits(
    folder: Path,
    file: Any = None,
    heights: Any = None,
    radii: Any = None,
    ratios: Any = None,
    resample: bool = False,
) -> tuple[analytic.MeasuredHeights, Array, dict[str, float]]:
    """Read summits that are listed with their radii, m or over that of the surface.

    With what they tell of their surface: their number ``eta`` on it and, of radii in m, sigma and radius.
    """
    own = (heights, ratios if radii is None else radii)
    given = own if file is None else columns_of(folder / file, _MOST_BYTES, *_SUMMITS)
    z, R = (np.asarray(x, np.float64) for x in given)
    if z.shape != R.shape:
        raise ValueError(f"there are {z.size} heights and {R.size} radii")
    for k in np.flatnonzero(~(np.isfinite(z) & np.isfinite(R) & (R > 0)))[:1]:
        has = f"summit {k + 1} has the height {z[k]:g} and the radius {R[k]:g}"
        raise ValueError(f"{has}; heights are finite, radii > 0")
    told = {"eta": float(len(z))}
    if z.size and ratios is None:
        told |= {"sigma": float(z.std()), "radius": float(1 / np.mean(1 / R))}
    return analytic.MeasuredHeights(z, resampled=resample), R, told


# Laws that are made of other keys than their class is.
_OF_KEYS: dict[str, dict[str, Callable[..., Any]]] = {
    "grading": {"table": table_of_moduli},
    "heights": {"table": table_of_heights, "scipy": scipy_heights},
    "contact.law": {},
}


def evenly(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Return separations with even steps: 0.3, where these give 0.30000000000000004."""
    return tuple(float(f"{h:.15g}") for h in np.linspace(start, stop, num))
