"""A scene written: its parts as the tables of a file, which read back the same, and in words."""

import math
from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from typing import Any, cast

import numpy as np

import analytic
from analytic import Grading, HeightLaw, MeasuredHeights, MeasuredRadii, RandomCurvature, Surface
from analytic.laws import ContactLaw, Hertz
from mcgw.formats.law_text import law_text
from mcgw.formats.table import Table
from mcgw.machine.terminal import brief
from mcgw.scene.fields import Fields
from mcgw.scene.keys import KEYS, SURFACE_UNITS
from mcgw.scene.kinds import Word, as_toml
from mcgw.scene.laws import LAWS
from mcgw.scene.section import SceneError

_PLANES = {"body": "undeformed body", "mean-plane": "mean deformed plane"}


def written(part: Any, table: str) -> dict[str, Any]:
    """Return the keys of a table that are values of a part of a scene, without what is not asked for."""
    found = {}
    for key, row in KEYS[table].items():
        value: Any = getattr(part, key, None)
        value = as_toml(asdict(cast(Any, value)) if is_dataclass(value) else value)
        if value is not None and (value != row.default or isinstance(row.kind, Word)):
            found[key] = value
    return found


def law_table(law: Grading | HeightLaw, table: str) -> dict[str, Any]:
    """Write the table [grading] or [heights] of a law that is data."""
    words = {kind: word for word, kind in LAWS[table].items()}
    word = next(words[kind] for kind in type(law).__mro__ if kind in words)
    own = {each.name for each in fields(cast(Any, law)) if each.init}
    return {"law": word, **{key: value for key, value in written(law, table).items() if key in own}}


def heights_table(heights: HeightLaw, file: str | None = None) -> dict[str, Any]:
    """Write the table [heights] of a height law that is data; measured heights by the name of their file."""
    if type(heights) is MeasuredHeights:
        held = {"heights": list(heights.heights)} if file is None else {"file": file}
        return {"law": "table", **held, "resample": False}
    own: Any = heights
    if type(heights) is analytic.ScipyHeights:
        import scipy.stats  # takes half a second; other scenes do not need it

        own = getattr(heights.distribution, "dist", own)
        name = getattr(own, "name", None)
        if name and type(own) is type(getattr(scipy.stats, name, None)):
            return {"law": "scipy", "name": name, "shapes": heights.shapes}
    elif type(heights) in LAWS["heights"].values():  # a subclass may do more
        return law_table(heights, "heights")
    reason = "is a Python class that a file cannot store; give a distribution of scipy.stats, or its points"
    raise SceneError([f"heights: {type(own).__name__} {reason} as a HeightTable"])


def summits_table(
    radii: RandomCurvature | MeasuredRadii, surface: Surface, file: str | None = None
) -> dict[str, Any]:
    """Write the table [summits]: measured radii, over that of the surface, or the name of their file."""
    if isinstance(radii, MeasuredRadii):
        lists = {"heights": list(radii.heights.heights), "ratios": list(radii.ratios)}
        return {**(lists if file is None else {"file": file}), "resample": radii.heights.resampled}
    bound = {} if math.isinf(radii.largest) else {"largest_radius": radii.largest * surface.radius}
    return {"curvature": "random", **bound}


def contact_law_table(law: ContactLaw) -> dict[str, Any]:
    """Keys that describe a law other than Hertz's."""
    if law.name != "custom":
        return {"name": law.name, **law.given()}
    custom: Any = law
    numbers = {"critical": custom.critical, "limits": custom.edges}
    series = {
        name: [{"edges": piece.edges, "coefficients": piece.coefficients} for piece in pieces]
        for name, pieces in (("load", custom.load_of), ("area", custom.area_of))
    }
    unchecked = {} if custom.checked else {"checked": False}
    return {"name": law.name, **as_toml(numbers | series), **unchecked}


def contact_facts(scene: Fields) -> list[tuple[str, str]]:
    """Facts, by name, that differ from Hertz's contact pressed once."""
    facts, film = [], scene.film
    if type(scene.law) is not Hertz:
        facts.append(("contact law", law_text(scene.law)))
    if scene.unload_from is not None:
        facts.append(("unloading", f"from d/sigma = {scene.unload_from:g}"))
    if film is not None:
        electric = f"resistivity {film.resistivity:g} ohm m" if film.resistivity else ""
        bodies = electric or "{:g} and {:g} W/(m K)".format(*film.conductivities or ())
        unit = "ohm m^2" if electric else "m^2 K/W"
        bodies += f", film {film.film_resistance:g} {unit}" if film.film_resistance else ""
        layer = film.layer
        bodies += f", layer {layer.thickness:g} m of {layer.conductivity:g} W/(m K)" if layer else ""
        facts.append(("bodies", bodies))
    if scene.interaction is not None:
        plane = _PLANES[scene.interaction.reference]
        facts.append(("interaction", f"from the {plane}, separations effective"))
    if scene.thermal:
        facts.append(("joint", joint_text(scene)))
    return facts


def joint_text(scene: Fields) -> str:
    """Return what fills the gap; by default nothing: spots only, as in vacuum."""
    if scene.gas is None or scene.filled is None or (gas := scene.filled.gas) is None:
        return "spots only (vacuum)"
    name = scene.gas.gas if isinstance(scene.gas.gas, str) else "gas"
    return (
        f"{name}, {gas.conductivity:.4g} W/(m K), temperature-jump distance {gas.jump:.3g} m; "
        f"combined rms roughness {scene.filled.rms:.4g} m"
    )


def accuracy_facts(scene: Fields) -> list[tuple[str, str]]:
    """Facts, by name, about laws that are not exact."""
    return [("accuracy", f"up to {scene.accuracy:g} from the exact laws")] if scene.accuracy else []


def sheet_of(scene: Fields) -> Table:
    """Display of a scene, at most a dozen lines."""
    x = {key: f"{key} = {getattr(scene.surface, key):g} {unit}" for key, unit in SURFACE_UNITS.items()}
    h, among = scene.separations, f"{len(scene.separations)} from " if len(scene.separations) > 1 else ""
    ends = " to ".join(f"{end:g}" for end in sorted({min(h), max(h)}))
    given = scene.rel_err if isinstance(scene.rel_err, Mapping) else {"": scene.rel_err}
    least = [
        f"{name} {np.min(x):g}{' at best' * isinstance(x, tuple)}".strip() for name, x in given.items() if x
    ]
    stop = f"until rel_err = {', '.join(least)}, at most " if least else ""
    facts = [
        ("surface", ", ".join((x["sigma"], x["radius"], x["eta"]))),
        ("", f"{x['nominal_area']}, {x['E_star']}"),
        ("grading", law_text(scene.grading) + ("" if scene.negative == "error" else f", {scene.negative}")),
        ("heights", law_text(scene.heights)),
        *([] if scene.summits is None else [("radii", law_text(scene.summits))]),
        *([] if scene.fitted is None else zip(("fitted to", ""), scene.fitted.lines(), strict=True)),
        *contact_facts(scene),
        ("separations", f"{among}{ends} (d/sigma)"),
        ("quantities", ", ".join(scene.quantities)),
        (
            "ensemble",
            f"{stop}{scene.n_surfaces} surfaces of {scene.n_asperities} asperities ({scene.count}), "
            f"seed {scene.seed}, sampler {scene.sampler}",
        ),
        *accuracy_facts(scene),
    ]
    return Table((), brief(f"Scene: {scene.title}") if scene.title else "Scene", facts)
