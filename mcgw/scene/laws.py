"""Gradings, height laws and contact laws: objects that Python gives, or made of the keys of their tables."""

from collections.abc import Callable, Mapping
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

import numpy as np

import analytic
from analytic import Custom, Grading, HeightLaw, Homogeneous, Surface
from analytic.arrays import Array
from analytic.laws import ContactLaw, Hertz
from mcgw.scene.files_beside import read_grading, read_heights, read_summits
from mcgw.scene.section import Section

OF_YIELD = ("hardness", "poisson")  # which tell beside an elastic law whether contacts yield
LISTS = ("file", "heights", "radii", "ratios", "resample")  # keys of listed summits
Listed = tuple[analytic.MeasuredHeights, Array, dict[str, float]]
GRADINGS: dict[str, Any] = {  # laws by their words in a scene
    "homogeneous": analytic.Homogeneous,
    "exponential": analytic.Exponential,
    "table": analytic.Table,
    "series": analytic.PiecewiseSeries,
}
HEIGHTS: dict[str, Any] = {
    "gaussian": analytic.Gaussian,
    "exponential": analytic.ExponentialHeights,
    "weibull": analytic.Weibull,
    "nayak": analytic.Nayak,
    "table": analytic.HeightTable,
    "scipy": analytic.ScipyHeights,
}
_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "pdf")


# --- objects of Python, or None ---


def grading_given(given: Any) -> Grading | None:
    """Accept a grading, or any function of an array of heights."""
    if isinstance(given, type) or not callable(given):
        return None
    return given if hasattr(given, "breaks") and hasattr(given, "smooth") else Custom(given)


def heights_given(given: Any) -> HeightLaw | None:
    """Accept a height law, or a frozen distribution of scipy.stats."""
    if hasattr(given, "dist") and hasattr(given, "kwds"):
        return analytic.ScipyHeights(given)
    own = all(hasattr(given, name) for name in _LAW_OF_HEIGHTS) and not isinstance(given, type)
    return given if own else None


def instance_of(*kinds: type) -> Callable[[Any], Any]:
    """Return what accepts objects of these kinds."""
    return lambda given: given if isinstance(given, kinds) else None


# --- by keys ---


def _law(section: Section, key: str, law: Any, makes: Mapping[str, Callable[..., Any]]) -> Any:
    """Return a law that is given, or make the one whose word stands at `key`, from those keys it takes.

    Mistakes are noted in the section and give None.
    """
    if not isinstance(law, str):
        return law  # None: unknown, so that its keys cannot be checked
    known, given = signature(makes[law]).parameters, {}
    for name in section.rows:
        if own := known.get(name):
            if name in section:
                given[name] = section.read(name)
            elif own.default is Parameter.empty:
                section.problems.append(f'{section.path(name)}: missing; {key} = "{law}" needs it')
        elif name in section and name not in OF_YIELD:
            laws = [repr(word) for word, make in makes.items() if name in signature(make).parameters]
            only = f"it is for {key} = {' or '.join(laws)} only; leave it out"
            section.problems += [f"{section.path(name)}: unknown key; {only}"] if laws else []
    return section.made(makes[law], given)


def grading_of(section: Section, surface: Surface | None, folder: Path) -> Grading:
    """Read the table [grading]; mistakes are noted and give a homogeneous one."""

    def table(file: str | None = None, s: Any = (), ratio: Any = ()) -> analytic.Table | None:
        if file is None:
            return analytic.Table(s, ratio)
        return read_grading(folder / file, surface) if surface else None

    law = section.read("law", "exponential" if "gamma" in section else "homogeneous")
    return _law(section, "law", law, GRADINGS | {"table": table}) or Homogeneous()


def heights_of(section: Section, folder: Path) -> HeightLaw | None:
    """Read the table [heights]; mistakes are noted and give None."""

    def table(
        heights: Any = None, file: str | None = None, resample: bool = True, s: Any = (), share: Any = ()
    ) -> HeightLaw:
        sample = heights if file is None else read_heights(folder / file)
        if sample is None:
            return analytic.HeightTable(s, share)
        return analytic.HeightTable.of(sample) if resample else analytic.MeasuredHeights(sample)

    makes = HEIGHTS | {"table": table, "scipy": _of_scipy}
    made: HeightLaw | None = _law(section, "law", section.read("law"), makes)
    return made


def _of_scipy(name: str = "norm", shapes: Mapping[str, float] | None = None) -> HeightLaw:
    import scipy.stats  # takes half a second; other scenes do not need it

    distribution = getattr(scipy.stats, name, None)
    if not isinstance(distribution, scipy.stats.rv_continuous):
        raise ValueError('name: give a continuous distribution of scipy.stats, such as "gamma"')
    try:
        return analytic.ScipyHeights(distribution(**(shapes or {})))
    except (TypeError, ValueError) as error:
        wanted = distribution.shapes or "none"
        raise ValueError(f"shapes: give its shapes ({wanted}), such as {{a = 4.0}}; {error}") from None


def listed_summits(section: Section, folder: Path) -> Listed | None:
    """Read summits listed with their heights and radii; None if there are none, or mistakes, which are noted.

    The law of their heights; radii, m or over that of the surface, shape (summits,); and what they tell of
    their surface: their number ``eta`` on it and, if radii are in m, sigma and radius.
    """

    def listed(file: Any, heights: Any, radii: Any, ratios: Any, resample: Any) -> Listed:
        own = (heights, ratios if radii is None else radii)
        z, R = (np.asarray(x, np.float64) for x in (own if file is None else read_summits(folder / file)))
        if z.shape != R.shape:
            raise ValueError(f"there are {z.size} heights and {R.size} radii")
        for k in np.flatnonzero(~(np.isfinite(z) & np.isfinite(R) & (R > 0)))[:1]:
            has = f"summit {k + 1} has the height {z[k]:g} and the radius {R[k]:g}"
            raise ValueError(f"{has}; heights are finite, radii > 0")
        told = {"eta": float(len(z))}
        if file is not None or radii:
            told |= {"sigma": float(z.std()), "radius": float(1 / np.mean(1 / R))}
        return analytic.MeasuredHeights(z, resampled=bool(resample)), R, told

    given = section.read_all(LISTS)
    if (given["file"] is None) is (given["heights"] is None or given["radii"] is given["ratios"]):
        return None
    made: Listed | None = section.made(listed, given)
    return made


def contact_law(section: Section) -> ContactLaw:
    """Read the law and its constants; mistakes are noted in the section and give Hertz's."""
    law = section.read("name")
    if law == Hertz.name and {*section.table} <= {"name", *OF_YIELD}:
        return Hertz()
    if isinstance(law, ContactLaw):
        return law
    from analytic.laws import by_name  # which imports them all

    return _law(section, "name", law, {**by_name, "custom": _custom}) or Hertz()


def _custom(critical: float, limits: list[float], load: Any, area: Any, checked: bool = True) -> ContactLaw:
    """Explain what a contact law of a Python script becomes in a file."""
    from analytic.laws.custom import CustomLaw, RootSeries

    def series(key: str, pieces: Any) -> list[RootSeries]:
        found = [RootSeries(x["low"], x["high"], tuple(x["coefficients"])) for x in pieces]
        if wrong := [x for x in found if x.low != -x.high and not 0 < x.low < x.high]:
            raise ValueError(f"{key}: a piece reaches from {wrong[0].low:g} to {wrong[0].high:g}")
        return found

    return CustomLaw(series("load", load), series("area", area), limits, critical, checked)
