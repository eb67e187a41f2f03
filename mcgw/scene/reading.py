"""Values of a scene from Python: the same rules and the same messages as for its file."""

import secrets
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import (
    Custom,
    Gaussian,
    Grading,
    HeightLaw,
    Homogeneous,
    MeasuredRadii,
    RandomCurvature,
    ScipyHeights,
    Surface,
)
from mcgw.scene.contact_section import contact_values
from mcgw.scene.ensemble_section import LeftOut, drawing_values
from mcgw.scene.grading_section import NEGATIVE
from mcgw.scene.section import SceneError, Section
from mcgw.scene.summits_section import Spectral, curvature_of

if TYPE_CHECKING:
    from analytic import Interaction
    from mcgw.scene.fitted_section import Fitted

__all__ = ["argument", "as_toml", "read_values"]

_LAW_OF_HEIGHTS = ("support", "breaks", "span", "log_ratio", "pdf")


def read_values(given: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Read what Python gives for the fields of a scene (None: left out) as its file would be read.

    Returns the values, those left out with their defaults, and one line for each mistake.
    """
    problems: list[str] = []
    table = {key: as_toml(value) for key, value in given.items() if value is not None}
    top, grading, summits, contact, ensemble = (
        Section(name, table, problems) for name in ("", "grading", "summits", "contact", "ensemble")
    )
    surface, heights = given["surface"], given["heights"]
    spectral = isinstance(surface, Spectral)
    if spectral:
        surface, heights = surface.surface, surface.heights if heights is None else heights
    if heights is None and isinstance(given["curvature"], MeasuredRadii):
        heights = given["curvature"].heights
    if not isinstance(surface, Surface):
        top.fail("surface", given["surface"], "give mcgw.Surface(sigma, radius, eta, nominal_area, E_star)")
    law = _heights(top, heights)
    values = {
        "surface": surface,
        **contact_values(contact, law),
        "title": top.text("title", ""),
        "grading": _grading(top, given["grading"]),
        "negative": grading.choice("negative", "error", NEGATIVE),
        "heights": law,
        "interaction": _interaction(table.get("interaction"), problems),
        "fitted": _fitted(given["fitted"], problems),
        "curvature": _curvature(summits, given["curvature"], law, surface, "random" if spectral else "mean"),
        "n_surfaces": _whole(ensemble, "n_surfaces", given, LeftOut(), least=1),
        "n_asperities": _whole(ensemble, "n_asperities", given, LeftOut(), least=1),
        "seed": _whole(ensemble, "seed", given, LeftOut(secrets.randbits(63))),
        **drawing_values(ensemble),
    }
    return values, problems


def argument(key: str, value: Any, unit: str) -> float:
    """An argument that is a positive number, or a text with its unit.

    Raises
    ------
    SceneError
        If it is none; the line names it.
    """
    section = Section("", {key: as_toml(value)}, [])
    number = section.number(key, unit=unit)
    if section.problems:
        raise SceneError(section.problems)
    return number


def as_toml(value: Any) -> Any:
    """A Python value as a TOML file would give it: arrays, tuples and ranges as lists of plain numbers."""
    if isinstance(value, str | bytes | bool | int | float):
        return value.item() if isinstance(value, np.generic) else value
    if isinstance(value, Mapping):
        return {key: as_toml(inner) for key, inner in value.items()}
    if hasattr(value, "__array__"):
        return np.asarray(value).tolist()
    if isinstance(value, Iterable) and not isinstance(value, type):
        return [as_toml(inner) for inner in value]
    return value


def _whole(section: Section, key: str, given: Mapping[str, Any], default: LeftOut, *, least: int = 0) -> Any:
    """A whole number; one that nobody gave stays marked as such."""
    if isinstance(given[key], LeftOut):
        return given[key]
    return section.whole(key, default, least=least)


def _grading(section: Section, given: Any) -> Grading:
    if given is None:
        return Homogeneous()
    if isinstance(given, type) or not callable(given):
        advice = "give mcgw.Exponential(gamma), mcgw.Table(s, ratio), or a function of an array of heights"
        section.fail("grading", given, advice)
        return Homogeneous()
    if hasattr(given, "breaks") and hasattr(given, "smooth"):
        return given  # type: ignore[no-any-return]
    return Custom(given)


def _heights(section: Section, given: Any) -> HeightLaw:
    if given is None:
        return Gaussian()
    if hasattr(given, "dist") and hasattr(given, "kwds"):
        return _of_scipy(section, given)
    if all(hasattr(given, name) for name in _LAW_OF_HEIGHTS) and not isinstance(given, type):
        return given  # type: ignore[no-any-return]
    advice = (
        "give mcgw.Weibull(shape), mcgw.Nayak(alpha), mcgw.HeightTable.of(heights), or a frozen distribution "
        "of scipy.stats, as scipy.stats.lognorm(0.3)"
    )
    section.fail("heights", given, advice)
    return Gaussian()


def _interaction(given: Any, problems: list[str]) -> "Interaction | None":
    if given is None:
        return None
    from mcgw.scene.interaction_section import interaction_argument  # for those scenes alone

    return interaction_argument(given, problems)


def _fitted(given: Any, problems: list[str]) -> "Fitted | None":
    if given is None:
        return None
    from mcgw.scene.fitted_section import fitted_argument  # as above

    return fitted_argument(given, problems)


def _curvature(
    section: Section, given: Any, heights: HeightLaw, surface: Surface, default: str
) -> RandomCurvature | MeasuredRadii | None:
    if isinstance(given, RandomCurvature | MeasuredRadii):
        return given
    return curvature_of(section, heights, surface, default)


def _of_scipy(section: Section, given: Any) -> HeightLaw:
    try:
        return ScipyHeights(given)
    except (TypeError, ValueError) as error:
        section.fail("heights", given, f"give a frozen continuous distribution of scipy.stats; {error}")
        return Gaussian()
