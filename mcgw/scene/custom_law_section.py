"""The keys of ``[contact] law = "custom"``: what a contact law of a Python script has become in a file."""

from typing import Any

from analytic.laws.custom import CustomLaw, RootSeries
from mcgw.scene.section import Section

__all__ = ["custom_law", "custom_table"]

_PARTS = ("low", "high", "coefficients")
_FORMULA = "give a list of {low, high, coefficients}, one for each piece, as mcgw writes them"


def custom_law(section: Section) -> CustomLaw | None:
    """Read the series of a law; mistakes are noted in the section, and give None."""
    before = len(section.problems)
    critical, limits = section.number("critical"), section.take("limits")
    if not _are_numbers(limits):
        section.fail("limits", limits, "give a list of numbers > 0 that increase")
    formulas = {key: _series(section, key) for key in ("load", "area")}
    if len(section.problems) > before:
        return None
    try:
        return CustomLaw(formulas["load"], formulas["area"], limits, critical)
    except ValueError as error:
        section.problems.append(f"contact.{error}")
        return None


def _series(section: Section, key: str) -> list[RootSeries]:
    given = section.take(key)
    if not (isinstance(given, list) and all(map(_is_series, given))):
        section.fail(key, given, _FORMULA)
        return []
    return [RootSeries(float(x["low"]), float(x["high"]), tuple(x["coefficients"])) for x in given]


def _is_series(value: Any) -> bool:
    return (
        isinstance(value, dict)
        and set(value) == set(_PARTS)
        and _are_numbers([value["low"], value["high"]])
        and _are_numbers(value["coefficients"])
        and len(value["coefficients"]) > 0
        and value["high"] > 0
        and (value["low"] == -value["high"] or 0 < value["low"] < value["high"])
    )


def _are_numbers(value: Any) -> bool:
    return isinstance(value, list) and all(
        isinstance(x, int | float) and not isinstance(x, bool) and abs(x) <= 1e300 for x in value
    )


def custom_table(law: Any) -> dict[str, Any]:
    """The keys that give the law back, whose formulas are series."""
    return {
        "law": law.name,
        "critical": law.critical,
        "limits": list(law.beginnings),
        "load": [_table(formula) for formula in law.load_of],
        "area": [_table(formula) for formula in law.area_of],
    }


def _table(series: Any) -> dict[str, Any]:
    return {"low": series.low, "high": series.high, "coefficients": list(series.coefficients)}
