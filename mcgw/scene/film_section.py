"""What the spots of a scene conduct through: keys of the table [contact]."""

from typing import Any

from analytic.laws import Film
from mcgw.formats.units import quantity
from mcgw.scene.section import Section

__all__ = ["conducting_film", "film_table"]


def conducting_film(section: Section) -> Film | None:
    """Read the resistances; mistakes are noted in the section. None where nobody asks for conductances."""
    given = section.table.get("film")  # from Python; a file has the keys below
    if isinstance(given, Film):
        return given
    if given is not None:
        section.fail("film", given, "give resistivity and film_resistance; in Python mcgw.Film of them")
        section.known("film")
    section.known("resistivity", "conductivities", "film_resistance")
    if "resistivity" in section and "conductivities" in section:
        section.fail("resistivity", section.table["resistivity"], "give it, or conductivities, not both")
        return None
    if "resistivity" not in section and "conductivities" not in section:
        if "film_resistance" in section:
            advice = "give resistivity in ohm m, or conductivities = [k1, k2] in W/(m K), too"
            section.fail("film_resistance", section.table["film_resistance"], advice)
        return None
    before = len(section.problems)
    resistivity = section.number("resistivity") if "resistivity" in section else _of_conductivities(section)
    film = section.number("film_resistance", 0.0, positive=False) if "film_resistance" in section else 0.0
    if film < 0:
        section.fail("film_resistance", film, "give a finite number >= 0, in ohm m^2 or m^2 K/W")
    return Film(resistivity, film) if len(section.problems) == before else None


def _of_conductivities(section: Section) -> float:
    """Sum of the resistivities of two bodies whose conductivities are given."""
    given = section.take("conductivities")
    try:
        first, second = (quantity(k, "1", "conductivities") for k in given)
        if not (first > 0 and second > 0):
            raise ValueError
        return 1 / first + 1 / second
    except (TypeError, ValueError):
        section.fail(
            "conductivities", given, "give two numbers > 0 in W/(m K) or 1/(ohm m), as [150.0, 16.0]"
        )
        return 1.0


def film_table(film: Film) -> dict[str, Any]:
    """The keys that give the film back."""
    return {"resistivity": film.resistivity, "film_resistance": film.film_resistance}
