"""Gradings, height laws and contact laws, read from the keys of their tables and written back."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, is_dataclass
from inspect import Parameter, signature
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
from mcgw.scene.kinds import Word
from mcgw.scene.section import SceneError, Section

OF_YIELD = ("hardness", "poisson")  # which tell beside an elastic law whether contacts yield
_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "pdf")


def _law(section: Section, key: str, law: str | None, makes: Mapping[str, Callable[..., Any]]) -> Any:
    """Make a law, whose name stands at `key`, from its keys: those arguments that are rows of the table.

    Mistakes are noted in the section and give None.
    """
    if law is None or law not in makes:
        return None  # unknown law: its keys cannot be checked
    known, given = signature(makes[law]).parameters, {}
    for name in section.rows:
        if own := known.get(name):
            if name in section:
                given[name] = section.read(name)
            elif own.default is Parameter.empty:
                section.note(f'{section.path(name)}: missing; {key} = "{law}" needs it')
        elif name in section and name not in OF_YIELD:
            laws = [repr(word) for word, make in makes.items() if name in signature(make).parameters]
            only = f"it is for {key} = {' or '.join(laws)} only; leave it out"
            section.problems += [f"{section.path(name)}: unknown key; {only}"] if laws else []
    return section.made(makes[law], given)


def written(part: Any, table: str) -> dict[str, Any]:
    """Return the keys of a table that are values of a part of a scene, without what is not asked for."""
    found = {}
    for key, row in KEYS[table].items():
        value = _plain(getattr(part, key, None))
        if value is not None and (value != row.default or isinstance(row.kind, Word)):
            found[key] = value
    return found


def _plain(value: Any) -> Any:
    """Return a value as TOML has it."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return float(value) if isinstance(value, float) else value


# --- gradings ---


def grading_of(section: Section, surface: Surface | None, folder: Path) -> Grading:
    """Read the table [grading]; mistakes are noted and give a homogeneous one."""

    def table(file: str | None = None, s: Any = (), ratio: Any = ()) -> Table | None:
        if file is None:
            return Table(s, ratio)
        return read_grading(folder / file, surface) if surface else None

    law = section.read("law", "exponential" if "gamma" in section else "homogeneous")
    return _law(section, "law", law, GRADINGS | {"table": table}) or Homogeneous()


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
    return {"law": law, **written(grading, "grading")}


# --- laws of heights ---


def heights_of(section: Section, folder: Path) -> HeightLaw | None:
    """Read the table [heights]; mistakes are noted and give None."""

    def table(
        heights: Any = None, file: str | None = None, resample: bool = True, s: Any = (), share: Any = ()
    ) -> HeightLaw:
        sample = heights if file is None else read_heights(folder / file)
        if sample is None:
            return HeightTable(s, share)
        return HeightTable.of(sample) if resample else MeasuredHeights(sample)

    made: HeightLaw | None = _law(
        section, "law", section.read("law"), HEIGHTS | {"table": table, "scipy": _of_scipy}
    )
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
        return {"law": law, **written(heights, "heights")}
    raise SceneError(
        [
            f"heights: {type(own).__name__} is a Python class that a file cannot store; give a distribution "
            "of scipy.stats, or its points as a HeightTable"
        ]
    )


# --- laws of contact ---


def contact_law(section: Section) -> ContactLaw:
    """Read the law and its constants; mistakes are noted in the section and give Hertz's."""
    law = section.read("name")
    if law == Hertz.name and {*section.table} <= {"name", *OF_YIELD}:
        return Hertz()
    from analytic.laws import by_name  # which imports them all

    return _law(section, "name", law, {**by_name, "custom": _custom}) or Hertz()


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
