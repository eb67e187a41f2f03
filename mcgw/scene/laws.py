"""Gradings, height laws and contact laws: objects that Python gives, or made of the keys of their tables."""

import csv
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

import analytic
from analytic import Custom, Grading, HeightLaw, Homogeneous, Surface
from analytic.arrays import Array
from analytic.laws import ContactLaw, CustomLaw, Hertz, by_name
from mcgw.formats.named_files import open_npy, read_text
from mcgw.formats.units import signed
from mcgw.scene.section import Section, signature_of

OF_YIELD = ("hardness", "poisson")  # which tell beside an elastic law whether contacts yield
LISTS = ("file", "heights", "radii", "ratios", "resample")  # keys of listed summits
Listed = tuple[analytic.MeasuredHeights, Array, dict[str, float]]
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
_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "log_pdf")
_MOST_BYTES, _MOST_OF_MODULI = 2**28, 2**24
_SUMMITS: list[dict[str, tuple[str, float]]] = [{"height": ("m", 1.0)}, {"radius": ("m", 1.0)}]
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


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


def _law(section: Section, default: str, **others: Callable[..., Any]) -> Any:
    """Return a law that is given, or make the one whose word stands there, from those keys it takes.

    By what `others` make of files or names, or else by its class; mistakes are noted and give None.
    """
    key = "law" if "law" in section.rows else "name"
    law = section.values.get(key, None if key in section.table else default)
    if law is None:
        return None  # unknown, so that its keys cannot be checked
    if not isinstance(law, str):
        for name in section.values:
            if name not in (key, "negative", *OF_YIELD):
                section.fail(name, f"give it to the law, {type(law).__name__}, or leave it out")
        return law
    makes = LAWS[section.name] | others
    known = {word: signature_of(make).parameters for word, make in makes.items()} if section.values else {}
    for name in section.values:
        laws = [repr(word) for word, names in known.items() if name in names]
        if laws and repr(law) not in laws and name not in OF_YIELD:
            only = f"it is for {key} = {' or '.join(laws)} only; leave it out"
            section.problems.append(f"{section.path}{name}: unknown key; {only}")
    return section.make(makes[law], f'{key} = "{law}" needs it')


def grading_of(section: Section, surface: Surface | None, folder: Path) -> Grading:
    """Read the table [grading]; mistakes are noted and give a homogeneous one."""

    def table(file: str | None = None, s: Any = (), ratio: Any = ()) -> analytic.Table | None:
        if file is None:
            return analytic.Table(s, ratio)
        return read_grading(folder / file, surface) if surface else None

    default = "exponential" if "gamma" in section.table else "homogeneous"
    return _law(section, default, table=table) or Homogeneous()


def heights_of(section: Section, folder: Path) -> HeightLaw | None:
    """Read the table [heights]; mistakes are noted and give None."""

    def table(
        heights: Any = None, file: str | None = None, resample: bool = True, s: Any = (), share: Any = ()
    ) -> HeightLaw:
        sample = heights if file is None else read_heights(folder / file)
        if sample is None:
            return analytic.HeightTable(s, share)
        return analytic.HeightTable.of(sample) if resample else analytic.MeasuredHeights(sample)

    return _law(section, "gaussian", table=table, scipy=_of_scipy)  # type: ignore[no-any-return]


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
    """Read summits listed with their heights and radii; None if there are mistakes, which are noted.

    The law of their heights; radii, m or over that of the surface, shape (summits,); and what they tell of
    their surface: their number ``eta`` on it and, if radii are in m, sigma and radius.
    """

    def listed(
        file: Any = None, heights: Any = None, radii: Any = None, ratios: Any = None, resample: bool = False
    ) -> Listed:
        own = (heights, ratios if radii is None else radii)
        given = own if file is None else _columns(folder / file, _MOST_BYTES, *_SUMMITS)
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

    return section.make(listed)  # type: ignore[no-any-return]


def contact_law(section: Section) -> ContactLaw:
    """Read the law and its constants; mistakes are noted in the section and give Hertz's."""
    return _law(section, Hertz.name) or Hertz()


def evenly(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Return separations with even steps: 0.3, where these give 0.30000000000000004."""
    return tuple(float(f"{h:.15g}") for h in np.linspace(start, stop, num))


def _columns(path: Path, most: int, *axes: Mapping[str, tuple[str, float]]) -> list[Array]:
    """Return a column of a CSV file for each axis, by one of its names, over a size in the SI unit of it.

    Units may follow the names, ``z (um), E_star (GPa)``, or the numbers, ``61.2 GPa``; # begins a comment.
    Raises ValueError, as all here, if it cannot be read or is not such a table; no text of it is quoted.
    """
    lines = [line for line in read_text(path, most).splitlines() if line.strip() and line[0] != "#"]
    try:
        header, *rows = list(csv.reader(lines)) or [[]]
    except csv.Error as error:
        raise ValueError(f"{path}: is not a table: {error}") from None
    names, found = " and ".join(" or ".join(axis) for axis in axes), list[Array]()
    heads = [(k, match) for k, text in enumerate(header) if (match := _NAMED.fullmatch(text))]
    for axis in axes:
        own = [(k, match[2] or "", *axis[match[1]]) for k, match in heads if match[1] in axis]
        own = [each for each in own if not math.isnan(signed(f"1{each[1]}", each[2]))]
        if len(own) != 1:
            raise ValueError(
                f"{path}: the first line must name {names}, with commas, such as z (um),E_star (GPa)"
            )
        ((k, unit, si, size),) = own
        cells = [row[k] if len(row) == len(header) else "" for row in rows]
        in_unit, own_unit = (np.array([signed(cell + each, si) for cell in cells]) for each in (unit, ""))
        found.append(np.where(np.isfinite(in_unit), in_unit, own_unit) / size)
    for k in np.flatnonzero(~np.isfinite(found).all(axis=0))[:1]:
        raise ValueError(f"{path}: row {k + 1} below the header has no number as {names}")
    return found


def read_grading(path: Path, surface: Surface) -> analytic.Table:
    """Return a grading from a CSV file: heights ``s`` or ``z`` (m), and ``ratio`` or ``E_star`` (Pa)."""
    heights = {"s": ("1", 1.0), "z": ("m", surface.sigma)}
    moduli = {"ratio": ("1", 1.0), "E_star": ("Pa", surface.E_star)}
    s, ratio = _columns(path, _MOST_OF_MODULI, heights, moduli)
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
