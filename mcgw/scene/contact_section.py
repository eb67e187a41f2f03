"""The table [contact] of a scene: law, separations, history and quantities."""

import math
from typing import Any

import numpy as np

from analytic import QUANTITIES, UNLOADING, HeightLaw
from mcgw.scene.film_section import conducting_film
from mcgw.scene.law_section import contact_law
from mcgw.scene.section import Section
from mcgw.scene.summits_section import datum_shift
from mcgw.scene.tangential_section import tangential_values

__all__ = ["contact_values"]

_MOST_SEPARATIONS = 100_000


def contact_values(section: Section, heights: HeightLaw) -> dict[str, Any]:
    """Read the table for summits of these heights; mistakes are noted in the section."""
    shift = datum_shift(section, heights)
    separations = tuple(h - shift for h in _separations(section))
    unload_from = _unload_from(section, separations)
    film = conducting_film(section)
    names = _quantities(section)
    if film is not None and "conductance_si" not in names:
        names = (*names, "conductance_si")
    return {
        "separations": separations,
        "law": contact_law(section),
        "unload_from": unload_from,
        "film": film,
        "tangential": tangential_values(section),
        "quantities": _with_unloading(names, unload_from),
    }


def _separations(section: Section) -> tuple[float, ...]:
    """A list, one number, or {start, stop, num}."""
    given = section.take("separations")
    advice = "give a list of finite numbers d/sigma, or {start = 0.0, stop = 4.0, num = 41}"
    if given is None:
        section.problems.append(f"contact.separations: missing; {advice}")
        return (0.0,)
    if isinstance(given, dict):
        inner = Section("contact.separations", given, section.problems)
        start = inner.number("start", positive=False)
        stop = inner.number("stop", positive=False)
        num = inner.whole("num", least=1)
        inner.finish()
        if num is None or math.isnan(start + stop):
            return (0.0,)
        if num > _MOST_SEPARATIONS:
            inner.fail("num", num, f"give at most {_MOST_SEPARATIONS} separations")
            return (0.0,)
        return tuple(np.linspace(start, stop, num).tolist())
    values = given if isinstance(given, list) else [given]
    if not all(isinstance(h, int | float) and not isinstance(h, bool) and abs(h) <= 1e6 for h in values):
        section.fail("separations", given, advice)
        return (0.0,)
    if len(values) > _MOST_SEPARATIONS:
        section.fail("separations", given, f"give at most {_MOST_SEPARATIONS} of them, not {len(values)}")
        return (0.0,)
    return tuple(float(h) for h in values)


def _unload_from(section: Section, separations: tuple[float, ...]) -> float | None:
    """The lowest separation reached before, a number or "loop"; None if none was."""
    if "unload_from" not in section:
        section.known("unload_from")
        return None
    if section.table["unload_from"] == "loop":
        section.known("unload_from")
        return min(separations, default=0.0)
    return section.number("unload_from", positive=False)


def _with_unloading(names: tuple[str, ...], unload_from: float | None) -> tuple[str, ...]:
    """Each quantity, and where the surface goes back, each on the way back."""
    if unload_from is None:
        return names
    back = tuple(q.name for name in names for q in UNLOADING.values() if q.unloading == name)
    return (*names, *(name for name in back if name not in names))


def _quantities(section: Section) -> tuple[str, ...]:
    """A list of names."""
    quantities = section.take("quantities")
    if quantities is None:
        quantities = ["load", "area", "stiffness", "contacts"]
    if not (isinstance(quantities, list) and all(isinstance(q, str) for q in quantities)):
        section.fail("quantities", quantities, f"give a list of {', '.join(QUANTITIES)}")
        quantities = ["load"]
    return tuple(quantities)
