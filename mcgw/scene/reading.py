"""The values of a scene out of its tables, which are those of a file or hold the objects of Python."""

import secrets
from collections.abc import Callable, Mapping
from dataclasses import asdict, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analytic import UNLOADING, Gaussian, HeightLaw, MeasuredRadii, Nayak, RandomCurvature, Surface
from analytic.laws import ContactLaw, Film, Hertz
from analytic.laws.law import check_poisson
from mcgw.scene.arguments import as_seed, as_toml
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import KEYS, TABLES
from mcgw.scene.laws import contact_law, grading_given, grading_of, heights_given, heights_of
from mcgw.scene.radii import LISTS, Spectral, curvature_of, datum_shift, listed_of
from mcgw.scene.rough_bodies import with_bodies
from mcgw.scene.section import SceneError, Section
from mcgw.scene.surface import read_surface
from mcgw.scene.values import MOMENTS, rows_of

Values = dict[str, Any]
Summits = tuple[Surface | None, HeightLaw | None, RandomCurvature | MeasuredRadii | None]

_OF_SURFACE = tuple(row.name for row in rows_of("surface"))
# Where arguments of `Scene` stand in a file. Others are whole tables or several keys: objects.
_PLACES = {key: table for table in ("", "contact", "ensemble") for key in KEYS[table]}
_PLACES |= {"negative": "grading", "curvature": "summits", **dict.fromkeys(_OF_SURFACE, "surface")}
_OBJECTS = ("law", "curvature")  # which may be words, too
_OF_YIELD = ("hardness", "poisson")
_QUANTITIES = ("load", "area", "stiffness", "contacts")
# Keys of [ensemble] that are no values of a scene as they are read.
_DERIVED = ("max_surfaces", "n_surfaces", "n_asperities", "seed", "left_out")


def of_arguments(**given: Any) -> Values:
    """Read the arguments of `mcgw.Scene` (None: left out) as its file would be read.

    Raises
    ------
    SceneError
        With one line for each mistake.
    """
    document: dict[str, Any] = {}
    objects: dict[str, Any] = {}
    for name, value in given.items():
        value = as_seed(value) if name == "seed" else value
        plain = as_toml(value)
        if value is None:
            continue
        if name == "law" and isinstance(plain, dict):
            document.setdefault("contact", {}).update(plain)
        elif name in TABLES and TABLES[name].make:
            document[name] = _keys_of(name, value, plain)
        elif name in _PLACES and (name not in _OBJECTS or isinstance(plain, str)):
            table = document.setdefault(_PLACES[name], {}) if _PLACES[name] else document
            table[name] = value if isinstance(value, LeftOut) else plain
        else:
            objects[name] = value
    return of_tables(document, objects, Path(), None)


def _keys_of(name: str, value: Any, plain: Any) -> Any:
    """The keys of an object that stands for a whole table; a word is its first key."""
    if is_dataclass(value) and not isinstance(value, type):
        return {key: as_toml(each) for key, each in asdict(value).items() if each is not None}
    return {next(iter(KEYS[name])): plain} if isinstance(plain, str) else plain


def of_tables(
    document: Mapping[str, Any], objects: Values, folder: Path, seed: Callable[[], int | None] | None
) -> Values:
    """Read the tables of a file, those beside it in `folder`; or the `objects` that Python gives for some.

    Where nothing gives a seed, `seed` is asked first.

    Raises
    ------
    SceneError
        With one line for each mistake.
    """
    document = with_bodies(document, folder, lambda tables, near: of_tables(tables, {}, near, None))
    problems: list[str] = []
    top = Section("", document, problems, KEYS[""])
    python = "surface" in objects
    of = {
        name: top.section(name, KEYS[name], table.advice if python else "")
        for name, table in TABLES.items()
        if name
    }
    surface, heights, curvature = _surface_and_summits(top, of, objects, folder)
    if "grading" in objects:
        grading = grading_given(top, objects["grading"])
    else:
        grading = grading_of(of["grading"], surface, folder)
    values = {
        "title": top.read("title"),
        "surface": surface,
        "grading": grading,
        "negative": of["grading"].read("negative"),
        "heights": heights,
        "curvature": curvature,
        **_contact(of["contact"], objects, heights),
        **{name: _made(top, of[name], table.make) for name, table in TABLES.items() if table.make},
        **of["surface"].read_all(_OF_SURFACE),
        **_ensemble(of["ensemble"], surface, seed),
    }
    uncertain = values["uncertainty"]
    if uncertain and set(MOMENTS) & set(uncertain.names) and not isinstance(heights, Nayak | None):
        advice = 'm0, m2 and m4 need heights.law = "nayak"; otherwise give sigma, radius and eta'
        of["surface"].fail("uncertainty", of["surface"].table["uncertainty"], advice)
    for name, section in (("", top), *of.items()):
        if not python or TABLES[name].make:  # a file or a dict, where more may be wrong than values
            section.finish()
    if python:
        of["contact"].note_unknown()  # of a law that is given by its keys
    if problems:
        raise SceneError(problems)
    return values


def _surface_and_summits(top: Section, of: Mapping[str, Section], objects: Values, folder: Path) -> Summits:
    """A surface, the law of its heights, and that of its radii where summits have their own."""
    summits, radii = of["summits"], objects.get("curvature")
    if any(key in summits for key in LISTS):
        listed = listed_of(summits, folder)
        return _with_listed(of, None if listed is None else read_surface(of["surface"], listed), listed)
    read = objects["surface"] if "surface" in objects else read_surface(of["surface"])
    surface, default = (read.surface, "random") if isinstance(read, Spectral) else (read, "mean")
    if "surface" in objects and not isinstance(surface, Surface):
        top.fail("surface", surface, "give mcgw.Surface(sigma, radius, eta, nominal_area, E_star)")
        surface = None
    heights: HeightLaw | None
    if "heights" in objects:
        heights = heights_given(top, objects["heights"])
    elif isinstance(radii, MeasuredRadii):
        heights = radii.heights
    elif isinstance(read, Spectral) and not of["heights"].table:
        heights = read.heights
    else:
        heights = heights_of(of["heights"], folder)
    if isinstance(radii, RandomCurvature | MeasuredRadii):
        return surface, heights, radii
    if radii is not None:
        summits.fail("curvature", radii, 'give "random", "mean", or mcgw.MeasuredRadii(heights, ratios)')
    return surface, heights, curvature_of(summits, heights, surface, default)


def _with_listed(of: Mapping[str, Section], surface: Any, listed: Any) -> Summits:
    """The same with summits that are given one by one, which tell what the surface leaves out."""
    heights = of["heights"]
    heights.known(*heights.table)
    if heights.table:
        heights.problems.append("heights: [summits] already gives the heights; leave [heights] out")
    if surface is None:
        of["surface"].known(*KEYS["surface"])  # what it lacks, nobody can say
        return None, Gaussian(), None
    return surface, *listed.laws(surface)


def _contact(section: Section, objects: Values, heights: HeightLaw | None) -> Values:
    shift, given = datum_shift(section, heights), section.read("separations")
    if isinstance(given, dict):
        even = np.linspace(given["start"], given["stop"], given["num"])
        given = [float(f"{h:.15g}") for h in even]  # 0.3, where even steps give 0.30000000000000004
    listed = [0.0] if given is None else given if isinstance(given, list) else [given]
    separations = tuple(h - shift + 0.0 for h in listed)  # -0.0 is 0.0
    back, film = section.read("unload_from"), _film(section, objects.get("film"))
    back = min(separations) if back == "loop" else back
    names = section.read("quantities") or _QUANTITIES
    names = (*names, *(["conductance_si"] if film and "conductance_si" not in names else []))
    also = () if back is None else (q.name for n in names for q in UNLOADING.values() if q.unloading == n)
    law = _law(section, objects)
    return {
        "separations": separations,
        "law": law,
        **_softer(section, law, of_python="law" in objects),
        "unload_from": back,
        "film": film,
        "quantities": (*names, *(name for name in also if name not in names)),
    }


def _law(section: Section, objects: Values) -> ContactLaw:
    """Of Python, or by its keys."""
    if "law" not in objects:
        return contact_law(section)
    given = objects["law"]
    if not isinstance(given, ContactLaw):
        section.fail("law", given, "your own law is mcgw.CustomLaw(load=..., area=..., ...)")
        return Hertz()
    return given


def _softer(section: Section, law: ContactLaw, *, of_python: bool) -> Values:
    """Hardness and Poisson's ratio that an elastic law does not take, to tell whether its contacts yield."""
    found: Values = dict.fromkeys(_OF_YIELD)
    if not of_python and section.table.get("law", Hertz.name) != law.name:
        return found  # what is wrong with the law is noted
    own: list[str] = [field.name for field in fields(law)] if is_dataclass(law) else []
    for key in _OF_YIELD:
        if key not in section:
            continue
        if key not in own and not law.yields:
            found[key] = section.read(key)
        elif of_python:
            section.known(key)
            advice = f"give it to the law, {type(law).__name__}, or leave it out"
            section.fail(key, section.table[key], advice)
    if found["poisson"] is not None:
        try:
            check_poisson(found["poisson"])
        except ValueError as error:
            section.note(f"contact.{error}")
        if "hardness" not in section:
            section.fail("poisson", found["poisson"], "give hardness too, or leave it out")
    return found


def _film(section: Section, given: Any) -> Film | None:
    """What spots conduct through; None where nobody asks for conductances."""
    keys = section.read_all(field.name for field in fields(Film))
    if given is not None and not isinstance(given, Film):
        return section.fail(
            "film", given, "give resistivity and film_resistance; in Python mcgw.Film of them"
        )
    if given is not None:
        keys = {key: layer if key == "layer" else getattr(given, key) for key, layer in keys.items()}
        keys["layer"] = keys["layer"] or given.layer
    found = {key: value for key, value in keys.items() if value is not None}
    if "layer" in found and "conductivities" not in found:
        return section.fail("layer", found["layer"], "give conductivities too, or leave it out")
    return Film(**found) if ("resistivity" in found) != ("conductivities" in found) else None


def _made(top: Section, section: Section, make: Callable[..., Any]) -> Any:
    """What all keys of a table make; None where it is left out, or wrong, which is noted."""
    if not isinstance(top.table.get(section.name), dict):
        return None
    before, found = len(top.problems), section.read_all(section.rows)
    if len(top.problems) > before:
        return None
    try:
        return make(**{key: tuple(x) if isinstance(x, list) else x for key, x in found.items()})
    except ValueError as error:
        return section.note(f"{section.name}.{error}")


def _ensemble(section: Section, surface: Surface | None, seed: Callable[[], int | None] | None) -> Values:
    """How many surfaces, and how they are drawn; numbers that nobody gave are marked."""
    most, number, n = section.read_all(("max_surfaces", "n_surfaces", "n_asperities")).values()
    values = section.read_all(key for key in section.rows if key not in _DERIVED)
    values["n_surfaces"] = _number(section, "n_surfaces", most if number is None else number)
    values["n_asperities"] = _number(section, "n_asperities", n)
    if "seed" in section:
        values["seed"] = _number(section, "seed", section.read("seed"))
    else:
        section.known("seed")
        other = None if seed is None else seed()
        values["seed"] = LeftOut(secrets.randbits(63) if other is None else other)
    for key in _left_out(section, surface, n):
        if values[key] is not None:
            values[key] = LeftOut(values[key])
    return values


def _number(section: Section, key: str, value: int | None) -> int:
    """A number; one that nobody gave is marked as such, and stays."""
    given = section.table.get(key)
    return given if isinstance(given, LeftOut) else LeftOut() if value is None else value


def _left_out(section: Section, surface: Surface | None, n_asperities: int | None) -> list[str]:
    """Which values, though written here, nobody gave when the scene was asked: see `scene_text`."""
    given = section.read("left_out") or []
    if "n_asperities" in given and surface and n_asperities not in (None, round(surface.n_asperities)):
        advice = (
            f"left_out lists it, but eta * nominal_area is {surface.n_asperities:.10g}; remove it from "
            "left_out, or leave n_asperities out"
        )
        section.fail("n_asperities", n_asperities, advice)
        return []
    return given
