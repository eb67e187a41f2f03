"""How a scene is pushed sideways: the key ``tangential`` of the table [contact]."""

from typing import Any

from analytic.laws import Tangential
from mcgw.scene.section import Section

__all__ = ["tangential_table", "tangential_values"]


def tangential_values(section: Section) -> Tangential | None:
    """Read the key; mistakes are noted in the section. None where nothing is pushed."""
    given = section.take("tangential")
    if given is None or isinstance(given, Tangential):
        return given
    if not isinstance(given, dict):
        advice = "give {friction = 0.3, poisson = 0.3, displacements = [1e-8, 1e-7]} (m)"
        section.fail("tangential", given, advice)
        return None
    inner = Section("contact.tangential", given, section.problems)
    before = len(section.problems)
    friction, poisson = inner.number("friction"), inner.number("poisson", positive=False)
    displacements = inner.take("displacements")
    inner.finish()
    values = displacements if isinstance(displacements, list) else [displacements]
    if not all(isinstance(u, int | float) and not isinstance(u, bool) for u in values):
        inner.fail("displacements", displacements, "give a list of numbers >= 0, in m")
    if len(section.problems) > before:
        return None
    try:
        return Tangential(friction, poisson, values)
    except ValueError as error:
        section.problems.append(f"contact.tangential.{error}")
        return None


def tangential_table(tangential: Tangential) -> dict[str, Any]:
    """The key that gives it back."""
    return {
        "friction": tangential.friction,
        "poisson": tangential.poisson,
        "displacements": list(tangential.displacements),
    }
