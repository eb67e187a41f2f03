"""The values of a scene out of its tables, which are those of a file or hold the objects of Python."""

import secrets
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analytic import UNLOADING, Gaussian, HeightLaw, MeasuredRadii, Nayak, RandomCurvature, Surface
from analytic.laws import ContactLaw, Hertz
from analytic.laws.law import check_poisson
from mcgw.scene.arguments import as_seed, as_toml
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import KEYS, MOMENTS, SURFACE_UNITS, TABLES, as_tables, whole_key
from mcgw.scene.laws import OF_YIELD, contact_law, grading_given, grading_of, heights_given, heights_of
from mcgw.scene.parts import Contact, Graded, Joint, Sampling
from mcgw.scene.radii import LISTS, Spectral, curvature_of, datum_shift, listed_of
from mcgw.scene.rough_bodies import with_bodies
from mcgw.scene.section import SceneError, Section, nearest
from mcgw.scene.surface import read_surface

Values = dict[str, Any]
Summits = tuple[Surface | None, HeightLaw | None, RandomCurvature | MeasuredRadii | None]

_OBJECTS = ("surface", "grading", "heights", "summits")  # which may be objects of other classes
_WORDS = {"interaction": "reference", "summits": "curvature"}  # what a word in place of a part is
# Parts of a scene, and of which of them a value that may be given by its own name is a field.
PLACES = dict.fromkeys(("surface", "title", "grading", "heights", "contact", "summits"), "")
PLACES |= dict.fromkeys(("interaction", "joint", "ensemble", "fitted"), "")
PLACES |= {"separations": "contact", "negative": "grading"}
PLACES |= dict.fromkeys((*SURFACE_UNITS, "uncertainty"), "surface")
for _table, _part in (("contact", Contact), ("joint", Joint), ("ensemble", Sampling)):
    PLACES |= {field.name: _table for field in fields(_part)}
_QUANTITIES = ("load", "area", "stiffness", "contacts")


def of_arguments(given: Mapping[str, Any]) -> Values:
    """Read parts of a scene, and fields of them by their names, as its file would be read; None: left out.

    Raises
    ------
    TypeError
        If there is no such part or field.
    SceneError
        With one line for each mistake.
    """
    document: dict[str, Any] = {}
    objects: Values = {}
    for name, value in given.items():
        if name not in PLACES:
            meant = nearest(name, PLACES).rstrip() or f"it has {', '.join(PLACES)}"
            raise TypeError(f"a scene has no {name!r}; {meant}")
        if PLACES[name] or value is None:
            continue
        word = _WORDS[name] if isinstance(value, str) and name in _WORDS else ""
        if name in _OBJECTS and not word and not isinstance(value, Mapping | Graded):
            objects[name] = value
        else:
            document[name] = {word: value} if word else _keys_of(value)
    for name, table in PLACES.items():
        if not table or name not in given:
            continue
        if table == "surface" and table in objects:
            document[table] = _keys_of(objects.pop(table))
        if isinstance(keys := document.setdefault(table, {}), dict):
            keys |= {name: given[name]}
            document[table] = {key: value for key, value in keys.items() if value is not None}
    if isinstance(contact := document.get("contact"), dict):
        law = contact.pop("law", {})
        of_yield = {key: contact.pop(key) for key in OF_YIELD if key in contact}
        objects |= {} if isinstance(law, str | Mapping) else {"law": law}
        named = {"name": law} if isinstance(law, str) else law if isinstance(law, Mapping) else {}
        contact["law"] = {**named, **of_yield}
    if isinstance(grading := document.get("grading"), dict) and not isinstance(grading.get("law", ""), str):
        objects["grading"] = grading.pop("law")
    if isinstance(ensemble := document.get("ensemble"), dict) and "seed" in ensemble:
        ensemble["seed"] = as_seed(ensemble["seed"])
    return of_tables(as_toml(document), objects, Path(), None)


def _keys_of(value: Any) -> Any:
    """Return the keys of what stands for a whole table."""
    if isinstance(value, Mapping):
        return dict(value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    return {each.name: x for each in fields(value) if (x := getattr(value, each.name)) is not None}


def of_tables(
    document: Mapping[str, Any],
    python: Values | None,
    folder: Path,
    seed: Callable[[], int | None] | None,
) -> Values:
    """Read the tables of a file, those beside it in `folder`; or of `python`, which gives objects for some.

    Where nothing gives a seed, `seed` is asked first.

    Raises
    ------
    SceneError
        With one line for each mistake.
    """
    document = with_bodies(
        as_tables(document), folder, lambda tables, near: of_tables(tables, None, near, None)
    )
    top, objects = Section("", document, KEYS[""]), python or {}
    of: dict[str, Section] = {}
    for name, table in TABLES.items():
        outer, _, inner = name.rpartition(".")
        if name:
            advice = "" if python is None else table.advice
            of[name] = of.get(outer, top).section(inner, KEYS[name], advice)
    surface, heights, curvature = _surface_and_summits(top, of, objects, folder)
    if "grading" in objects:
        grading = grading_given(top, objects["grading"])
    else:
        grading = grading_of(of["grading"], surface, folder)
    joint = _joint(_made(top, of["joint"]), of["joint"])
    separations, contact = _contact(of["contact"], of["contact.law"], objects, heights, joint)
    values = {
        "title": top.read("title"),
        "surface": surface,
        "separations": separations,
        "grading": grading,
        "negative": of["grading"].read("negative"),
        "heights": heights,
        "summits": curvature,
        "contact": contact,
        "interaction": _made(top, of["interaction"]),
        "joint": joint,
        "ensemble": _ensemble(of["ensemble"], seed),
        "fitted": _made(top, of["fitted"]),
    }
    uncertain = getattr(surface, "uncertainty", None)
    if uncertain and set(MOMENTS) & set(uncertain.names) and not isinstance(heights, Nayak | None):
        advice = 'm0, m2 and m4 need heights.law = "nayak"; otherwise give sigma, radius and eta'
        of["surface"].fail("uncertainty", uncertain.names, advice)
    if python is None:  # where arguments are known by name
        top.finish(whole_key)
    for section in of.values():
        section.finish(whole_key)
    if problems := [line for section in (top, *of.values()) for line in section.problems]:
        raise SceneError(problems)
    return values


def _surface_and_summits(top: Section, of: Mapping[str, Section], objects: Values, folder: Path) -> Summits:
    """Return a surface, the law of its heights, and that of its radii where summits have their own."""
    summits, radii = of["summits"], objects.get("summits")
    if any(key in summits for key in LISTS):
        if of["heights"].table:
            of["heights"].note("heights: [summits] already gives the heights; leave [heights] out")
        listed = listed_of(summits, folder)
        surface = None if listed is None else read_surface(of["surface"], listed.parameters)
        if listed is None or not isinstance(surface, Surface):
            return None, Gaussian(), None
        return surface, *listed.laws(surface)
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
        top.fail("summits", radii, 'give "random", "mean", or mcgw.MeasuredRadii(heights, ratios)')
    return surface, heights, curvature_of(summits, heights, surface, default)


def _contact(
    section: Section, of_law: Section, objects: Values, heights: HeightLaw | None, joint: Joint
) -> tuple[tuple[float, ...], Contact]:
    """Separations from the mean plane of the summits; and contacts, with the quantities that follow.

    These are in SI units where there is a film, and of unloading.
    """
    values = section.read_all(section.rows)
    given, shift = values.pop("separations"), datum_shift(section, values.pop("datum"), heights)
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
    values |= {
        "law": (law := _law(section, of_law, objects)),
        "quantities": tuple(names),
        "unload_from": back,
    }
    return separations, Contact(**values, **_softer(of_law, law, of_python="law" in objects))


def _law(section: Section, of_law: Section, objects: Values) -> ContactLaw:
    """Of Python, or by its keys."""
    if "law" not in objects:
        return contact_law(of_law)
    given = objects["law"]
    if not isinstance(given, ContactLaw):
        section.fail("law", given, "your own law is mcgw.CustomLaw(load=..., area=..., ...)")
        return Hertz()
    return given


def _softer(section: Section, law: ContactLaw, *, of_python: bool) -> Values:
    """Hardness and Poisson's ratio that an elastic law does not take, to tell whether its contacts yield."""
    found: Values = dict.fromkeys(OF_YIELD)
    if not of_python and section.table.get("name", Hertz.name) != law.name:
        return found  # what is wrong with the law is noted
    own: list[str] = [field.name for field in fields(law)] if is_dataclass(law) else []
    for key in OF_YIELD:
        if key not in section:
            continue
        if key not in own and not law.yields:
            found[key] = section.read(key)
        elif of_python:
            advice = f"give it to the law, {type(law).__name__}, or leave it out"
            section.fail(key, section.table[key], advice)
    if found["poisson"] is not None:
        try:
            check_poisson(found["poisson"])
        except ValueError as error:
            section.note(f"{section.name}.{error}")
        if "hardness" not in section:
            section.fail("poisson", found["poisson"], "give hardness too, or leave it out")
    return found


def _joint(joint: Joint | None, section: Section) -> Joint:
    """Return a joint of which film and gas can be made; what else is wrong is noted where its keys are."""
    if joint is None or (joint.resistivity is None) == (joint.conductivities is None):
        return Joint()
    try:
        assert joint.film is not None
        assert joint.gas is None or joint.filling is not None
    except ValueError as error:
        section.note(f"joint.{error}")
        return Joint()
    return joint


def _made(top: Section, section: Section) -> Any:
    """Return what all keys of a table make; None where it is left out, or wrong, which is noted."""
    make = TABLES[section.name].make
    if make is None or not isinstance(top.table.get(section.name), dict):
        return None
    found = section.read_all(section.rows)
    return section.made(make, {key: tuple(x) if isinstance(x, list) else x for key, x in found.items()})


def _ensemble(section: Section, seed: Callable[[], int | None] | None) -> Sampling:
    """How many surfaces, and how they are drawn; numbers that nobody gave are marked."""
    values = section.read_all(section.rows)
    if "seed" not in section:
        other = None if seed is None else seed()
        values["seed"] = LeftOut(secrets.randbits(63) if other is None else other)
    for key in ("n_surfaces", "n_asperities"):
        values[key] = LeftOut() if values[key] is None else values[key]
    return Sampling(**values)
