"""The README of this folder: what was solved, and how far each model is from it."""

import importlib
import importlib.util
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from charted import CLAIMED, VALID, Fresh, fresh, fresh_table
from density import density_table, verdict
from deviations import Condensed
from model_tables import SHOWN, by_load, maps_table
from resolution import mesh_table, size_table, tolerance_table
from rough_maps import DRAWN_PIXELS
from solve_list import jobs
from solve_table import Row
from within import within_table

TEMPLATE = Path(__file__).with_name("README.template.md")


def page(lines: list[Condensed], rows: list[Row]) -> str:
    """All of it."""
    gaussian = [line for line in lines if line.map == "gaussian"]
    caps = [line for line in lines if line.map == "caps"]
    found = fresh(lines, rows)
    parts: dict[str, Any] = {
        q: by_load(gaussian, q, "α") for q in ("area", "stiffness", "separation", "load")
    }
    parts |= {f"caps_{q}": by_load(caps, q, "ηRσ") for q in ("area", "stiffness", "separation", "load")}
    text = TEMPLATE.read_text().format(
        amount=amount(rows),
        pixels=DRAWN_PIXELS,
        within=within_table(gaussian),
        maps=maps_table(lines),
        density=density_table(gaussian),
        verdict=verdict(gaussian),
        mesh=mesh_table(rows),
        size=size_table(rows),
        tolerance=tolerance_table(rows),
        fresh=fresh_table(found),
        claim="\n".join(claims(found)),
        **parts,
    )
    return text + from_print()


def amount(rows: list[Row]) -> str:
    """How many solves, their hours, and which are missing."""
    hours = sum(float(row["seconds"]) for row in rows) / 3600
    text = f"{len(rows)} solves, {hours:.1f} hours on one core (of two, shared with other work)."
    known = {row["job"] for row in rows}
    missing = [
        f"{job.map.group} ({job.purpose})" for job in jobs() for name, _ in job.solves() if name not in known
    ]
    if missing:
        maps = "; ".join(f"{group}: {missing.count(group)}" for group in dict.fromkeys(missing))
        text += f" Listed and not done are {len(missing)} solves: {maps}."
    return text


def claims(found: list[Fresh]) -> Iterable[str]:
    """Of each model, where the chart is sure that it is within 10 %, whether fresh maps agree."""
    for model, interaction, quantity in CLAIMED:
        own = [x for x in found if (x.model, x.interaction, x.quantity) == (model, interaction, quantity)]
        valid = [x for x in own if x.claimed]
        beyond = [abs(x.measured) for x in valid if abs(x.measured) > VALID]
        said = f"beyond it at {len(beyond)}, the most {max(beyond):.1%}" if beyond else "nowhere beyond it"
        off = sum(abs(x.z) > 2 for x in own)
        yield (
            f"- {quantity}, {model}{SHOWN[interaction]}: sure to be within {VALID:.0%} at {len(valid)} of "
            f"{len(own)} points; there fresh maps are {said}; beyond it by more than twice the standard "
            f"error at {sum(not x.holds for x in valid)}. Of all points {off} differ from what was "
            f"expected by more than twice the standard error of both."
        )


def from_print() -> str:
    """The section of printed numbers, where it is there."""
    if importlib.util.find_spec("from_print") is None:
        return ""
    module = importlib.import_module("from_print")
    return f"\n{module.section()}"
