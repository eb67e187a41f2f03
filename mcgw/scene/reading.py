"""The values of a scene out of its tables: those of a file, or what Python gives as such."""

import math
import secrets
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analytic import UNLOADING, Gaussian, HeightLaw, MeasuredRadii, Nayak, RandomCurvature, Surface
from analytic.laws import ContactLaw, Hertz
from analytic.laws.law import check_poisson
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import KEYS, SURFACE_UNITS, TABLES, as_tables, whole_key
from mcgw.scene.kinds import as_toml
from mcgw.scene.laws import LISTS, OF_YIELD, contact_law, grading_of, heights_of, listed_summits
from mcgw.scene.measured import MOMENTS, SUMMITS
from mcgw.scene.parts import Contact, Graded, Joint, Sampling
from mcgw.scene.rough_bodies import with_bodies
from mcgw.scene.section import SceneError, Section, nearest
from mcgw.scene.surface import Spectral, read_surface

Values = dict[str, Any]
Seeds = Callable[[], int | None]  # asked for a seed
Radii = RandomCurvature | MeasuredRadii | None

# Keys of what may stand in place of a table: a word, or an object that no keys make.
_OF_WORD = {"grading": "law", "heights": "law", "summits": "curvature", "interaction": "reference"}
# Parts of a scene, and of which of them a value that may be given by its own name is a key.
PLACES = {name or "title": "" for name in TABLES if "." not in name}
for _table in ("contact", "joint", "ensemble"):
    PLACES |= dict.fromkeys(KEYS[_table], _table)
PLACES |= dict.fromkeys(("law", *OF_YIELD), "contact") | {"negative": "grading"}
PLACES |= dict.fromkeys((*SURFACE_UNITS, "uncertainty"), "surface")
_QUANTITIES = ("load", "area", "stiffness", "contacts")


def of_arguments(given: Mapping[str, Any]) -> Values:
    """Read parts of a scene, and keys of them by their names, as its file would be read; None: left out.

    Raises TypeError if there is no such part or key, SceneError with one line for each mistake.
    """
    document: Values = {}
    for name, value in given.items():
        if name not in PLACES:
            meant = nearest(name, PLACES).rstrip() or f"it has {', '.join(PLACES)}"
            raise TypeError(f"a scene has no {name!r}; {meant}")
        if not PLACES[name] and value is not None:
            document[name] = _keys_of(name, value)
    for name, value in given.items():
        if not (table := PLACES[name]):
            continue
        keys = document.get(table, {})
        keys = _fields(keys) if isinstance(keys, Surface) else keys
        if isinstance(keys, dict):
            document[table] = {key: x for key, x in {**keys, name: value}.items() if x is not None}
    if isinstance(contact := document.get("contact"), dict):
        of_yield = {key: contact.pop(key) for key in OF_YIELD if key in contact}
        if of_yield:
            contact["law"] = as_tables(document)["contact"].get("law", {}) | of_yield
    return of_tables(as_toml(document))


def _keys_of(name: str, value: Any) -> Any:
    """Return the keys of what stands for a whole table."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, Surface):
        return value
    if isinstance(value, Spectral):
        summits = {key: x for key, x in _fields(value.surface).items() if key not in SUMMITS}
        return _fields(value.moments) | summits
    if isinstance(value, Graded) or (is_dataclass(value) and name not in ("grading", "heights", "summits")):
        return _fields(value)
    return {_OF_WORD[name]: value} if name in _OF_WORD else value


def _fields(part: Any) -> Values:
    return {each.name: x for each in fields(part) if (x := getattr(part, each.name)) is not None}


def of_tables(document: Mapping[str, Any], folder: Path = Path(), seed: Seeds | None = None) -> Values:
    """Read the tables of a scene, and the files beside it in `folder`; where there is no seed, ask `seed`.

    Raises SceneError with one line for each mistake.
    """
    document = with_bodies(as_tables(document), folder, of_tables)
    if isinstance(whole := document.get("surface"), Surface):  # of Python, which checked it
        document = {**document, "surface": {}}
    of = {"": Section("", document, KEYS[""])}
    for name, table in TABLES.items():
        outer, _, inner = name.rpartition(".")
        if name:
            of[name] = of[outer].section(inner, KEYS[name], table.advice)
    if of[""].problems:
        raise SceneError(of[""].problems)
    surface, heights, radii = _surface_and_summits(of, whole, folder)
    joint = _joint(of)
    separations, contact = _contact(of, heights, joint)
    values = {
        "title": of[""].read("title"),
        "surface": surface,
        "separations": separations,
        "grading": grading_of(of["grading"], surface, folder),
        "negative": of["grading"].read("negative"),
        "heights": heights,
        "summits": radii,
        "contact": contact,
        "interaction": _made(of, "interaction"),
        "joint": joint,
        "ensemble": _ensemble(of["ensemble"], seed),
        "fitted": _made(of, "fitted"),
    }
    for section in of.values():
        section.finish(whole_key)
    if problems := [line for section in of.values() for line in section.problems]:
        raise SceneError(problems)
    return values


def _surface_and_summits(
    of: Mapping[str, Section], whole: Any, folder: Path
) -> tuple[Surface | None, HeightLaw | None, Radii]:
    """Return a surface, the law of its heights, and that of its radii where summits have their own."""
    summits, of_heights = of["summits"], of["heights"]
    if any(key in summits for key in LISTS):
        if isinstance(of_heights.table.get("law", ""), str) and of_heights.table:
            of_heights.problems.append("heights: [summits] already gives the heights; leave [heights] out")
        if (listed := listed_summits(summits, folder)) is None:
            return None, Gaussian(), None
        law, R, told = listed
        surface = whole if isinstance(whole, Surface) else read_surface(of["surface"], told)
        if not isinstance(surface, Surface):
            return None, law, None
        return surface, law, MeasuredRadii(law, R / (surface.radius if "radius" in told else 1.0))
    read = whole if isinstance(whole, Surface) else read_surface(of["surface"])
    surface, default = (read.surface, "random") if isinstance(read, Spectral) else (read, "mean")
    radii, largest = summits.read("curvature", default), summits.read("largest_radius")
    own: Any = radii if isinstance(radii, MeasuredRadii) else read
    known = isinstance(own, MeasuredRadii | Spectral) and not of_heights.table
    heights = own.heights if known else heights_of(of_heights, folder)
    uncertain = getattr(surface, "uncertainty", None)
    if uncertain and set(MOMENTS) & set(uncertain.names) and not isinstance(heights, Nayak | None):
        advice = 'm0, m2 and m4 need heights.law = "nayak"; otherwise give sigma, radius and eta'
        of["surface"].fail("uncertainty", uncertain.names, advice)
    if radii == "mean" and largest is not None:
        summits.fail("largest_radius", summits.table["largest_radius"], 'needs curvature = "random"')
    if radii == "random" and surface is not None and heights is not None:
        radii = _random(summits, heights, surface.radius, largest)
    return surface, heights, None if isinstance(radii, str) else radii


def _random(
    section: Section, heights: HeightLaw, mean: float, largest: float | None
) -> RandomCurvature | None:
    """Return radii of summits that follow from the spectrum, up to the largest, m."""
    if not isinstance(heights, Nayak):
        section.fail("curvature", "random", 'needs heights.law = "nayak", or m0, m2, m4 under [surface]')
        return None
    try:
        return RandomCurvature(heights.alpha, math.inf if largest is None else largest / mean)
    except ValueError as error:
        section.fail("largest_radius", section.table.get("largest_radius", largest), str(error))
        return None


def _contact(
    of: Mapping[str, Section], heights: HeightLaw | None, joint: Joint
) -> tuple[tuple[float, ...], Contact]:
    """Separations from the mean plane of the summits; and contacts, with the quantities that follow.

    These are in SI units where there is a film, and of unloading.
    """
    section = of["contact"]
    values = section.read_all(section.rows)
    given, datum, shift = values.pop("separations"), values.pop("datum"), 0.0
    if datum == "surface" and isinstance(heights, Nayak):
        shift = heights.mean / heights.std
    elif datum == "surface" and heights is not None:
        section.fail(
            "datum", datum, 'needs heights.law = "nayak", which defines the mean plane of the surface'
        )
    if isinstance(given, dict):
        even = np.linspace(given["start"], given["stop"], given["num"])
        given = [float(f"{h:.15g}") for h in even]  # 0.3, where even steps give 0.30000000000000004
    listed = [0.0] if given is None else given if isinstance(given, list) else [given]
    separations = tuple(h - shift + 0.0 for h in listed)  # -0.0 is 0.0
    back = min(separations) if values["unload_from"] == "loop" else values["unload_from"]
    names = dict.fromkeys(values["quantities"] or _QUANTITIES)
    names |= {} if joint.film is None else {"conductance_si": None}
    if back is not None:
        names |= {q.name: None for name in names for q in UNLOADING.values() if q.unloading == name}
    law = contact_law(of["contact.law"])
    values |= {"quantities": tuple(names), "unload_from": back}
    return separations, Contact(law, **values, **_softer(of["contact.law"], law))


def _softer(section: Section, law: ContactLaw) -> Values:
    """Hardness and Poisson's ratio that an elastic law does not take, to tell whether its contacts yield."""
    found: Values = dict.fromkeys(OF_YIELD)
    name = section.table.get("name", Hertz.name)
    if name not in (law, law.name):
        return found  # what is wrong with the law is noted
    own: list[str] = [field.name for field in fields(law)] if is_dataclass(law) else []
    for key in (key for key in OF_YIELD if key in section):
        if key not in own and not law.yields:
            found[key] = section.read(key)
        elif not isinstance(name, str):
            advice = f"give it to the law, {type(law).__name__}, or leave it out"
            section.fail(key, section.table[key], advice)
    if found["poisson"] is not None:
        try:
            check_poisson(found["poisson"])
        except ValueError as error:
            section.problems.append(f"{section.name}.{error}")
        if "hardness" not in section:
            section.fail("poisson", found["poisson"], "give hardness too, or leave it out")
    return found


def _joint(of: Mapping[str, Section]) -> Joint:
    """Return a joint of which film and gas can be made; what else is wrong is noted where its keys are."""
    joint: Joint | None = _made(of, "joint")
    if joint is not None and (joint.resistivity is None) != (joint.conductivities is None):
        try:
            _ = joint.film, joint.filling  # which are made of it
            return joint
        except ValueError as error:
            of["joint"].problems.append(f"joint.{error}")
    return Joint()


def _made(of: Mapping[str, Section], name: str) -> Any:
    """Return what all keys of a table make; None where it is left out, or wrong, which is noted."""
    section, make = of[name], TABLES[name].make
    if make is None or not isinstance(of[""].table.get(name), dict):
        return None
    found = section.read_all(section.rows)
    return section.made(make, {key: tuple(x) if isinstance(x, list) else x for key, x in found.items()})


def _ensemble(section: Section, seed: Seeds | None) -> Sampling:
    """How many surfaces, and how they are drawn; numbers that nobody gave are marked."""
    values = section.read_all(section.rows)
    if "seed" not in section:
        other = None if seed is None else seed()
        values["seed"] = LeftOut(secrets.randbits(63) if other is None else other)
    for key in ("n_surfaces", "n_asperities"):
        values[key] = LeftOut() if values[key] is None else values[key]
    return Sampling(**values)
