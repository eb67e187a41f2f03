"""The table [ensemble] of a scene: how many surfaces, and how they are drawn."""

import math
import secrets
from collections.abc import Callable
from typing import Any

from analytic import Surface
from mcgw.scene.fields import EXACT
from mcgw.scene.samplers import SAMPLERS
from mcgw.scene.section import Section
from mcgw.scene.stop_rule import rel_err_of

__all__ = ["LeftOut", "drawing_values", "ensemble_values"]


class LeftOut(int):
    """A whole number that nobody gave: it equals any other, but is found anew when the scene changes."""


def drawing_values(section: Section) -> dict[str, Any]:
    """Read what a file and Python give alike; mistakes are noted in the section."""
    return {
        "count": section.choice("count", "fixed", ("fixed", "poisson")),
        "sampler": section.choice("sampler", "auto", SAMPLERS),
        "keep": section.choice("keep", "sums", ("sums", "moments", "statistics")),
        "accuracy": section.number("accuracy", EXACT, unit="1"),
        "law_error": section.number("law_error", 0.0, unit="1", positive=False),
        "edges": _edges(section),
        "rel_err": rel_err_of(section),
        "max_seconds": section.number("max_seconds", unit="s") if "max_seconds" in section else None,
    }


def _edges(section: Section) -> tuple[float, ...]:
    """Heights, once each and increasing."""
    given = section.take("edges")
    values = [] if given is None else given
    if not isinstance(values, list) or not all(map(_is_height, values)):
        section.fail("edges", given, "give a list of finite heights s = z/sigma, or leave it out")
        return ()
    return tuple(sorted({float(s) + 0.0 for s in values}))  # -0.0 is 0.0


def _is_height(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def ensemble_values(
    section: Section, surface: Surface | None, seed: Callable[[], int | None] | None
) -> dict[str, Any]:
    """Read the table of a file, without what is left out; the seed is asked for if it gives none."""
    other = None if "seed" in section or seed is None else seed()
    values = {
        "n_surfaces": _most_surfaces(section),
        "n_asperities": section.whole("n_asperities", None, least=1),
        "seed": section.whole("seed", LeftOut(secrets.randbits(63) if other is None else other)),
        **drawing_values(section),
    }
    section.known("rel_err", "max_seconds", "max_surfaces", "n_surfaces")
    for key in _left_out(section, surface, values["n_asperities"]):
        if values[key] is not None:
            values[key] = LeftOut(values[key])
    return {key: value for key, value in values.items() if value is not None}


def _left_out(section: Section, surface: Surface | None, n_asperities: int | None) -> list[str]:
    """Which values, though written here, nobody gave when the scene was asked: see `scene_text`."""
    given = section.take("left_out")
    keys = ["n_asperities", "seed"]
    if given is None:
        return []
    if not (isinstance(given, list) and all(key in keys for key in given)):
        section.fail("left_out", given, f"give a list of {', '.join(keys)}, or leave it out")
        return []
    if "n_asperities" in given and surface and n_asperities not in (None, round(surface.n_asperities)):
        section.fail(
            "n_asperities",
            n_asperities,
            f"left_out says that nobody gave it, but eta * nominal_area is {surface.n_asperities:.10g}; "
            "take it out of left_out, or leave n_asperities out",
        )
        return []
    return given


def _most_surfaces(section: Section) -> int | None:
    """Number of surfaces, or the most that a stop rule may draw."""
    if "rel_err" not in section:
        if "max_surfaces" in section:
            section.fail("max_surfaces", section.take("max_surfaces"), "goes with rel_err; give n_surfaces")
        return section.whole("n_surfaces", None, least=1)  # type: ignore[no-any-return]
    if "n_surfaces" in section:
        advice = "rel_err decides how many; give max_surfaces for the most, or leave rel_err out"
        section.fail("n_surfaces", section.take("n_surfaces"), advice)
    return section.whole("max_surfaces", None, least=1)  # type: ignore[no-any-return]
