"""Gradings, height laws and contact laws, read from the keys of their tables and written back."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, asdict, fields
from pathlib import Path
from typing import Any

from analytic import (
    Custom,
    Gaussian,
    Grading,
    HeightLaw,
    HeightTable,
    Homogeneous,
    MeasuredHeights,
    ScipyHeights,
    Surface,
    Table,
)
from analytic.laws import ContactLaw, Hertz
from mcgw.scene.files_beside import read_grading, read_heights
from mcgw.scene.keys import GRADINGS, HEIGHTS, KEYS
from mcgw.scene.section import SceneError, Section

_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "pdf")


def _made(section: Section, law: str | None, make: Callable[..., Any] | None) -> Any:
    """Make a law from its keys; mistakes are noted in the section and give None."""
    if law is None or make is None:
        section.known(*section.table)  # unknown law: its keys cannot be checked
        return None
    names, before = [row.name for row in section.rows.values() if law in row.laws], len(section.problems)
    given = {name: value for name, value in section.read_all(names).items() if value is not None}
    if len(section.problems) > before:
        return None
    try:
        return make(**given)
    except (TypeError, ValueError) as error:
        return section.refuse(str(error), names)


def _table(table: str, law: str, part: Any) -> dict[str, Any]:
    """Keys that describe a part."""
    rows = {key: row for key, row in KEYS[table].items() if law in row.laws}
    found = {key: getattr(part, key, None) for key in rows}
    return {"law": law} | {
        key: _plain(value)
        for key, value in found.items()
        if value is not None and not (isinstance(value, bool) and value is rows[key].default)
    }


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return value if isinstance(value, str | bool) else float(value)


# --- gradings ---


def grading_of(section: Section, surface: Surface | None, folder: Path) -> Grading:
    """Read the table [grading]; mistakes are noted and give a homogeneous one."""

    def table(file: str | None = None, s: Any = (), ratio: Any = ()) -> Table | None:
        try:
            if file is None:
                return Table(s, ratio)
            return read_grading(folder / file, surface) if surface else None
        except ValueError as error:
            advice = f"give a CSV file, or lists s and ratio; {error}"
            raise ValueError(advice if file is None else f"file: {advice}") from None

    law = section.read("law", "exponential" if "gamma" in section else "homogeneous")
    return _made(section, law, table if law == "table" else GRADINGS.get(law)) or Homogeneous()


def grading_given(section: Section, given: Any) -> Grading:
    """Accept a grading, or any function of an array of heights."""
    if isinstance(given, type) or not callable(given):
        advice = "give mcgw.Exponential(gamma), mcgw.Table(s, ratio), or a function of an array of heights"
        section.fail("grading", given, advice)
        return Homogeneous()
    if hasattr(given, "breaks") and hasattr(given, "smooth"):
        return given  # type: ignore[no-any-return]
    return Custom(given)


def grading_table(grading: Grading) -> dict[str, Any]:
    """Write the table [grading] of a grading that is data; it reads back the same."""
    (law,) = [name for name, kind in GRADINGS.items() if isinstance(grading, kind)]
    return _table("grading", law, grading)


# --- laws of heights ---


def heights_of(section: Section, folder: Path) -> HeightLaw | None:
    """Read the table [heights]; mistakes are noted and give None."""

    def table(
        heights: Any = None, file: str | None = None, resample: bool = True, s: Any = (), share: Any = ()
    ) -> HeightLaw:
        try:
            sample = heights if file is None else read_heights(folder / file)
            if sample is None:
                return HeightTable(s, share)
            return HeightTable.of(sample) if resample else MeasuredHeights(sample)
        except ValueError as error:
            key = "s" if heights is file is None else "heights" if file is None else "file"
            advice = "give heights (a list), a file of them, or points s and share"
            raise ValueError(f"{key}: {advice}; {error}") from None

    law = section.read("law")
    made: HeightLaw | None = _made(section, law, (HEIGHTS | {"table": table, "scipy": _of_scipy}).get(law))
    return made


def _of_scipy(name: str = "norm", shapes: Mapping[str, float] | None = None) -> HeightLaw:
    import scipy.stats  # takes half a second; other scenes do not need it

    distribution = getattr(scipy.stats, name, None)
    if not isinstance(distribution, scipy.stats.rv_continuous):
        raise ValueError('name: give a continuous distribution of scipy.stats, such as "gamma"')
    try:
        return ScipyHeights(distribution(**(shapes or {})))
    except (TypeError, ValueError) as error:
        wanted = distribution.shapes or "none"
        raise ValueError(f"shapes: give its shapes ({wanted}), such as {{a = 4.0}}; {error}") from None


def heights_given(section: Section, given: Any) -> HeightLaw:
    """Accept a height law, or a frozen distribution of scipy.stats."""
    if hasattr(given, "dist") and hasattr(given, "kwds"):
        try:
            return ScipyHeights(given)
        except (TypeError, ValueError) as error:
            section.fail("heights", given, f"give a frozen continuous distribution of scipy.stats; {error}")
            return Gaussian()
    if all(hasattr(given, name) for name in _LAW_OF_HEIGHTS) and not isinstance(given, type):
        return given  # type: ignore[no-any-return]
    advice = (
        "give mcgw.Weibull(shape), mcgw.Nayak(alpha), mcgw.HeightTable.of(heights), or a frozen distribution "
        "of scipy.stats, such as scipy.stats.lognorm(0.3)"
    )
    section.fail("heights", given, advice)
    return Gaussian()


def heights_table(heights: HeightLaw, file: str | None = None) -> dict[str, Any]:
    """Write the table [heights] of a height law; measured heights by the name of their file.

    Raises
    ------
    SceneError
        If the law is a class of the user.
    """
    if type(heights) is MeasuredHeights:
        held = {"heights": list(heights.heights)} if file is None else {"file": file}
        return {"law": "table", **held, "resample": False}
    own = heights
    if type(heights) is ScipyHeights:
        import scipy.stats  # as above

        own = getattr(heights.distribution, "dist", own)
        name = getattr(own, "name", None)
        if name and type(own) is type(getattr(scipy.stats, name, None)):
            return {"law": "scipy", "name": name, "shapes": heights.shapes}
    elif type(heights) in HEIGHTS.values():  # a subclass may do more
        (law,) = [name for name, kind in HEIGHTS.items() if type(heights) is kind]
        return _table("heights", law, heights)
    raise SceneError(
        [
            f"heights: {type(own).__name__} is a Python class that a file cannot store; give a distribution "
            "of scipy.stats, or its points as a HeightTable"
        ]
    )


# --- laws of contact ---


def contact_law(section: Section) -> ContactLaw:
    """Read the law and its constants; mistakes are noted in the section and give Hertz's."""
    if section.table.get("name", Hertz.name) == Hertz.name:
        section.known("name")
        return Hertz()
    law = section.read("name")
    if law is None:
        section.known(*section.table)  # unknown law: its constants cannot be checked
        return Hertz()
    names, needed, make = _constants_of(law)
    before = len(section.problems)
    section.known(*names)
    for name in needed:
        if name not in section:
            section.problems.append(f'{section.path(name)}: missing; name = "{law}" needs it')
    constants = section.read_all(name for name in names if name in section)
    if len(section.problems) == before:
        try:
            return make(**constants)
        except ValueError as error:
            section.refuse(str(error), names)
    return Hertz()


def _constants_of(law: str) -> tuple[Sequence[str], Sequence[str], Callable[..., ContactLaw]]:
    """Constants of a law, those that are required, and the function that makes it."""
    if law == "custom":
        names = ("critical", "limits", "load", "area")
        return (*names, "checked"), names, _custom
    from analytic.laws import by_name

    known = fields(by_name[law])  # type: ignore[arg-type]
    return [f.name for f in known], [f.name for f in known if f.default is MISSING], by_name[law]


def contact_law_table(law: ContactLaw) -> dict[str, Any]:
    """Keys that describe a law other than Hertz's."""
    if law.name != "custom":
        return {"name": law.name, **law.given()}
    custom: Any = law
    series = {
        key: [{**asdict(x), "coefficients": list(x.coefficients)} for x in formulas]
        for key, formulas in (("load", custom.load_of), ("area", custom.area_of))
    }
    unchecked = {} if custom.checked else {"checked": False}
    return {
        "name": law.name,
        "critical": custom.critical,
        "limits": list(custom.beginnings),
        **series,
        **unchecked,
    }


def _custom(critical: float, limits: list[float], load: Any, area: Any, checked: bool = True) -> ContactLaw:
    """Explain what a contact law of a Python script becomes in a file."""
    from analytic.laws.custom import CustomLaw, RootSeries

    def series(key: str, pieces: Any) -> list[RootSeries]:
        found = [RootSeries(x["low"], x["high"], tuple(x["coefficients"])) for x in pieces]
        if wrong := [x for x in found if x.low != -x.high and not 0 < x.low < x.high]:
            raise ValueError(f"{key}: a piece reaches from {wrong[0].low:g} to {wrong[0].high:g}")
        return found

    return CustomLaw(series("load", load), series("area", area), limits, critical, checked)
