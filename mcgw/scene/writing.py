"""Parts of a scene as the tables of a file, which read back the same."""

import math
from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from typing import Any

import analytic
from analytic import Grading, HeightLaw, MeasuredHeights, MeasuredRadii, RandomCurvature, Surface
from analytic.laws import ContactLaw
from mcgw.scene.keys import KEYS
from mcgw.scene.kinds import Word
from mcgw.scene.laws import GRADINGS, HEIGHTS
from mcgw.scene.section import SceneError


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


def grading_table(grading: Grading) -> dict[str, Any]:
    """Write the table [grading] of a grading that is data."""
    (law,) = [name for name, kind in GRADINGS.items() if isinstance(grading, kind)]
    return {"law": law, **written(grading, "grading")}


def heights_table(heights: HeightLaw, file: str | None = None) -> dict[str, Any]:
    """Write the table [heights] of a height law; measured heights by the name of their file.

    Raises SceneError if the law is a class of the user.
    """
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
    elif type(heights) in HEIGHTS.values():  # a subclass may do more
        (law,) = [name for name, kind in HEIGHTS.items() if type(heights) is kind]
        return {"law": law, **{x.name: getattr(heights, x.name) for x in fields(own)}}
    reason = "is a Python class that a file cannot store; give a distribution of scipy.stats, or its points"
    raise SceneError([f"heights: {type(own).__name__} {reason} as a HeightTable"])


def summits_table(
    radii: RandomCurvature | MeasuredRadii, surface: Surface, file: str | None = None
) -> dict[str, Any]:
    """Write the table [summits]; measured radii by the name of their file, if they have one.

    Radii stand there over that of the surface, which has a last digit of its own.
    """
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
    series = {"load": custom.load_of, "area": custom.area_of}
    unchecked = {} if custom.checked else {"checked": False}
    return {"name": law.name, **_plain(numbers | series), **unchecked}
