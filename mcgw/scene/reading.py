"""The values of a scene out of its tables: those of a file, or what Python gives as such."""

import math
import secrets
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

import analytic
from analytic import UNLOADING, HeightLaw, Interaction, MeasuredRadii, Nayak, RandomCurvature
from analytic.laws import ContactLaw
from analytic.laws.law import check_poisson
from mcgw.scene import laws
from mcgw.scene.contact import Contact, Joint
from mcgw.scene.ensemble import Sampling
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import INSIDE, KEYS, TABLES
from mcgw.scene.kinds import as_toml
from mcgw.scene.measured import MOMENTS, SUMMITS, Fitted
from mcgw.scene.section import SceneError, Section, mistake, nearest
from mcgw.scene.surface import Spectral, read_surface

Values = dict[str, Any]
Tables = Mapping[str, Any]
Seeds = Callable[[], int | None]  # asked for a seed

_LISTS = ("file", "heights", "radii", "ratios", "resample")  # keys of listed summits
_QUANTITIES = ("load", "area", "stiffness", "contacts")
# Keys of what may stand in place of a table: a word, or an object that no keys make.
_OF_WORD = {"grading": "law", "heights": "law", "summits": "curvature", "interaction": "reference"}
_TABLES_WITH = Counter(key for rows in KEYS.values() for key in rows)
# Each key that one table alone has, with that table; of several laws the one of contacts.
_WHOLE = {key: f"{name}.{key}" for name in filter(None, KEYS) for key in KEYS[name] if _TABLES_WITH[key] == 1}
_WHOLE |= {"law": "contact.law"}


def of_arguments(given: Mapping[str, Any]) -> Values:
    """Read parts of a scene, and keys of them by their names, as its file would be read; None: left out."""
    changes: Values = {}
    for name, value in given.items():
        place = _WHOLE.get(name, name)
        if name in TABLES:
            changes |= {} if value is None else _keys_of(name, value)
        elif "." in place or place in KEYS[""]:
            changes[place] = value
        else:
            known = [*filter(None, TABLES), *_WHOLE]
            meant = nearest(name, known).rstrip() or f"it has {', '.join(known)}"
            raise TypeError(f"a scene has no {name!r}; {meant}")
    tables_first = dict(sorted(changes.items()))
    return of_tables(as_toml(with_changes({}, tables_first)))


def _keys_of(name: str, value: Any) -> Values:
    """Return a table and each of its keys, dotted, of what stands for a whole table."""
    keys = value
    if isinstance(value, laws.Graded) or (
        is_dataclass(value) and name not in ("grading", "heights", "summits")
    ):
        parts = (value.surface, value.moments) if isinstance(value, Spectral) else (value,)
        keys = {each.name: getattr(part, each.name) for part in parts for each in fields(part)}
        keys |= dict.fromkeys(SUMMITS) if isinstance(value, Spectral) else {}
    elif name in _OF_WORD and not isinstance(value, Mapping):
        keys = {_OF_WORD[name]: value}
    if not isinstance(keys, Mapping):
        return {name: keys}
    inside = {key: place for key, place in _WHOLE.items() if place.startswith(f"{name}.")}
    return {name: {}} | {inside.get(key, f"{name}.{key}"): x for key, x in keys.items()}


def with_changes(document: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Tables with other values at some keys, dotted, None: without; a whole table takes the place of one.

    A key that one table alone has may stand without its table, and a word for a contact law is its name.
    """
    changed = {**document}
    for key, value in changes.items():
        *outer, last = _WHOLE.get(key, key).split(".")
        table: Any = changed
        for name in outer:
            held = table.get(name, {})
            held = {"name": held} if name == "law" and not isinstance(held, Mapping) else held
            if not isinstance(held, Mapping) or (value is None and name not in table):
                break  # which is a mistake of its own, or as it is
            table[name] = {**held}
            table = table[name]
        else:
            held = table.pop(last, None)
            if last == "law" and isinstance(held, Mapping) and not isinstance(value, Mapping):
                value = {**held, "name": value}
            table |= {} if value is None else {last: value}
    return changed


def of_tables(document: Tables, folder: Path = Path(), seed: Seeds | None = None) -> Values:
    """Read the tables of a scene, and the files beside it in `folder`; where there is no seed, ask `seed`."""
    of: dict[str, Section] = {}
    for name, table in TABLES.items():
        outer, _, inner = name.rpartition(".")
        given = of[outer].table.get(inner, {}) if name else document
        if name == "contact.law" and not isinstance(given, Mapping):
            given = {"name": given}
        if not isinstance(given, Mapping):
            other = f", or in Python give {table.advice}" if table.advice else ""
            raise mistake(name, given, f"must be a table: write [{name}] above its keys{other}")
        of[name] = Section(name, given, table.rows, INSIDE[name], _WHOLE)
    surface, heights, radii = _surface_and_summits(of, folder)
    grading = laws.law_of(of["grading"], folder=folder, surface=surface)
    joint = of["joint"].make(Joint) or Joint()
    separations, contact = _contact(of, heights, joint)
    left_out: Values = dict.fromkeys(("n_surfaces", "n_asperities"), LeftOut())
    if "seed" not in of["ensemble"].table:
        drawn = None if seed is None else seed()
        left_out["seed"] = LeftOut(secrets.randbits(63) if drawn is None else drawn)
    values = {
        "title": of[""].get("title"),
        "surface": surface,
        "separations": separations,
        "grading": grading,
        "negative": of["grading"].get("negative"),
        "heights": heights,
        "summits": radii,
        "contact": contact,
        "interaction": of["interaction"].make(Interaction) if "interaction" in document else None,
        "joint": joint,
        "ensemble": of["ensemble"].make(Sampling, **left_out),
        "fitted": of["fitted"].make(Fitted) if "fitted" in document else None,
    }
    if problems := [line for section in of.values() for line in section.problems]:
        raise SceneError(problems)
    return values


def _surface_and_summits(of: Mapping[str, Section], folder: Path) -> tuple[Any, HeightLaw | None, Any]:
    """Return a surface, the law of its heights, and that of its radii where summits have their own."""
    section, summits, of_heights = of["surface"], of["summits"], of["heights"]
    if any(key in summits.table for key in _LISTS):
        return _listed(section, summits, of_heights, folder)
    read = read_surface(section)
    surface, default = (read.surface, "random") if isinstance(read, Spectral) else (read, "mean")
    radii = summits.values.get("curvature", default)
    own: Any = radii if isinstance(radii, MeasuredRadii) else read
    if isinstance(own, MeasuredRadii | Spectral) and not of_heights.table:
        heights = own.heights
    else:
        heights = laws.law_of(of_heights, folder=folder)
    uncertain = getattr(surface, "uncertainty", None)
    if uncertain and set(MOMENTS) & set(uncertain.names) and not isinstance(heights, Nayak | None):
        advice = 'm0, m2 and m4 need heights.law = "nayak"; otherwise give sigma, radius and eta'
        section.fail("uncertainty", advice)
    if not (surface and heights and (summits.table or default == "random")):
        return surface, heights, None
    return surface, heights, summits.make(_radii, surface=surface, heights=heights, curvature=default)


def _listed(
    section: Section, summits: Section, of_heights: Section, folder: Path
) -> tuple[Any, HeightLaw | None, Any]:
    """Return the same of summits that are listed: their heights are those of the scene."""
    if isinstance(of_heights.table.get("law", ""), str) and of_heights.table:
        of_heights.problems.append("heights: [summits] already gives the heights; leave [heights] out")
    if (listed := summits.make(laws.listed_summits, folder=folder)) is None:
        return None, None, None
    law, R, told = listed
    surface = read_surface(section, told)
    if not isinstance(surface, analytic.Surface):
        return None, law, None
    return surface, law, MeasuredRadii(law, R / (surface.radius if "radius" in told else 1.0))


def _radii(
    surface: analytic.Surface, heights: HeightLaw, curvature: Any, largest_radius: float | None = None
) -> RandomCurvature | MeasuredRadii | None:
    """Return the law of the radii of summits with these heights; None: they have that of the surface."""
    if curvature == "mean" and largest_radius is not None:
        raise ValueError('largest_radius: needs curvature = "random"')
    if isinstance(curvature, MeasuredRadii) and heights != curvature.heights:
        raise ValueError("heights: they differ from those of the measured summits; leave them out")
    if curvature == "random":
        if not isinstance(heights, Nayak):
            raise ValueError('curvature: needs heights.law = "nayak", or m0, m2, m4 under [surface]')
        return RandomCurvature(heights.alpha, (largest_radius or math.inf) / surface.radius)
    if isinstance(curvature, RandomCurvature) and curvature.alpha != getattr(heights, "alpha", None):
        needed = f'heights.law = "nayak", alpha = {curvature.alpha:g}'
        raise ValueError(f"curvature: needs {needed}; use these")
    return None if curvature == "mean" else curvature


def _contact(
    of: Mapping[str, Section], heights: HeightLaw | None, joint: Joint
) -> tuple[tuple[float, ...], Contact]:
    """Separations from the mean plane of the summits; contacts, with quantities of films and unloading."""
    section, of_law, shift = of["contact"], of["contact.law"], 0.0
    if section.get("datum") == "surface" and isinstance(heights, Nayak):
        shift = heights.mean / heights.std
    elif section.get("datum") == "surface" and heights is not None:
        section.fail("datum", 'needs heights.law = "nayak", which defines the mean plane of the surface')
    given = section.make(lambda separations: np.atleast_1d(separations))
    separations = tuple((np.zeros(1) if given is None else given - shift + 0.0).tolist())  # -0.0 is 0.0
    back = section.get("unload_from")
    back = min(separations) if back == "loop" else back
    names = dict.fromkeys(section.get("quantities") or _QUANTITIES)
    names |= {} if joint.film is None else {"conductance_si": None}
    if back is not None:
        names |= {q.name: None for name in names for q in UNLOADING.values() if q.unloading == name}
    law = laws.law_of(of_law) or laws.DEFAULTS["contact.law"]
    return separations, Contact(law, tuple(names), back, **(_softer(of_law, law) if of_law.values else {}))


def _softer(section: Section, law: ContactLaw) -> Values:
    """Hardness and Poisson's ratio that an elastic law does not take, to tell whether its contacts yield."""
    found: Values = {}
    for key in [key for key in laws.OF_YIELD if key in section.values and not section.problems]:
        if key not in getattr(law, "__dataclass_fields__", {}) and not law.yields:
            found[key] = section.values[key]
        elif section.values.get("name") is law:
            section.fail(key, f"give it to the law, {type(law).__name__}, or leave it out")
    if "poisson" in found:
        try:
            check_poisson(found["poisson"])
        except ValueError as error:
            section.problems.append(f"{section.name}.{error}")
        if "hardness" not in section.table:
            section.fail("poisson", "give hardness too, or leave it out")
    return found
