"""Gradings, height laws and contact laws: objects that Python gives, or made of the keys of their tables."""

import csv
import math
import re
from collections.abc import Callable, Mapping
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

import numpy as np

import analytic
from analytic import Custom, Grading, HeightLaw, Homogeneous, Surface
from analytic.arrays import Array
from analytic.laws import ContactLaw, Hertz
from mcgw.formats.named_files import open_npy, read_text
from mcgw.formats.units import signed
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


_MOST_BYTES, _MOST_OF_MODULI = 2**28, 2**24
_MODULI = {"s": "1", "z": "m", "ratio": "1", "E_star": "Pa"}  # columns and their units
_SUMMITS = {"height": "m", "radius": "m"}
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


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
    return _law(section, "law", section.read("law"), makes)  # type: ignore[no-any-return]


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
        if z.size and (file is not None or radii):
            told |= {"sigma": float(z.std()), "radius": float(1 / np.mean(1 / R))}
        return analytic.MeasuredHeights(z, resampled=bool(resample)), R, told

    given = section.read_all(LISTS)
    if (given["file"] is None) is (given["heights"] is None or given["radii"] is given["ratios"]):
        return None
    return section.made(listed, given)  # type: ignore[no-any-return]


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
        try:
            found = [RootSeries(**piece) for piece in pieces]
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from None
        if (first := found[0].edges)[0] != -first[-1]:
            raise ValueError(
                f"{key}: the first piece reaches from {first[0]:g} to {first[-1]:g}, not around 0"
            )
        return found

    return CustomLaw(series("load", load), series("area", area), limits, critical, checked)


# --- files beside a scene: moduli against height, heights, summits with radii ---


def _columns(path: Path, most: int, units: Mapping[str, str]) -> dict[str, list[float]]:
    """Return columns of a CSV file by name, in SI; nan where there is no number, empty those of other names.

    Units may follow the names, ``z (um), E_star (GPa)``, or the numbers, ``61.2 GPa``; # begins a comment.
    """
    lines = [line for line in read_text(path, most).splitlines() if line.strip() and line[0] != "#"]
    try:
        header, *rows = list(csv.reader(lines)) or [[]]
    except csv.Error as error:
        raise ValueError(f"{path}: is not a table: {error}") from None
    found: dict[str, list[float]] = {}
    for k, text in enumerate(header):
        match = _NAMED.fullmatch(text)
        name, unit = (match[1], match[2] or "") if match else (text, "")
        known = name in units and not math.isnan(signed(f"1{unit}", units[name]))
        cells = [row[k] if len(row) == len(header) else "" for row in rows if known]
        found[name if known else text] = [_number(cell, unit, units[name]) for cell in cells]
    return found


def _number(text: str, unit: str, si: str) -> float:
    """Return a number in its own unit or in that of its column; nan if it is none."""
    value = signed(f"{text}{unit}", si)
    value = value if math.isfinite(value) else signed(text, si)
    return value if math.isfinite(value) else math.nan


def read_grading(path: Path, surface: Surface) -> analytic.Table:
    """Return a grading from a CSV file: heights ``s`` or ``z`` (m), and ``ratio`` or ``E_star`` (Pa).

    Raises ValueError, as all here, if it cannot be read or is not such a table; no text of it is quoted.
    """
    found = _columns(path, _MOST_OF_MODULI, _MODULI)
    axes = {"s": 1.0, "z": surface.sigma}, {"ratio": 1.0, "E_star": surface.E_star}
    named = [[np.array(found[name]) / size for name, size in axis.items() if name in found] for axis in axes]
    if len(found) != 2 or not all(named):
        first = "s or z, a comma, and ratio or E_star, such as z (um),E_star (GPa)"
        raise ValueError(f"{path}: the first line must be {first}")
    (s,), (ratio,) = named
    if np.isnan([s, ratio]).any():
        raise ValueError(f"{path}: every line below the header must be two numbers, separated by a comma")
    order = np.argsort(s, kind="stable")
    try:
        return analytic.Table(s[order].tolist(), ratio[order].tolist())
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def read_heights(path: Path) -> Array:
    """Heights from ``.npy`` or text with one a line (# begins a comment), in any unit; at most 256 MB."""
    if path.suffix == ".npy":
        array = open_npy(path)
        if array.nbytes > _MOST_BYTES:
            raise ValueError(f"{path}: longer than {_MOST_BYTES} bytes; give fewer heights")
        return np.asarray(array, dtype=np.float64).ravel()
    lines = read_text(path, _MOST_BYTES).splitlines()
    try:
        return np.loadtxt(lines, dtype=np.float64, delimiter=",", ndmin=1).ravel()
    except ValueError:
        raise ValueError(
            f"{path}: give one height per line, or the same number on each line, separated by commas"
        ) from None


def read_summits(path: Path) -> tuple[list[float], ...]:
    """Return the columns height and radius, m, of a CSV file."""
    found = _columns(path, _MOST_BYTES, _SUMMITS)
    if missing := [name for name in _SUMMITS if name not in found]:
        raise ValueError(f"{path}: has no column {' and no column '.join(missing)}")
    columns = tuple(found[name] for name in _SUMMITS)
    for k in np.flatnonzero(np.isnan(columns).any(axis=0))[:1]:
        raise ValueError(f"{path}: summit {k + 1} has no number as {' or '.join(_SUMMITS)}")
    return columns
