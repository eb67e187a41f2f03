"""The README of this folder, in two screens, and its long tables as CSV."""

from pathlib import Path

import from_print
from as_markdown import Sheet
from charted import VALID, Fresh, fresh, fresh_table
from conductance import conductance_table
from density import density_table
from deviations import Condensed
from resolution import mesh_table, size_table, tolerance_table
from rough_maps import DRAWN_PIXELS
from solve_list import jobs
from solve_table import Row
from within import within_table

FOLDER = Path(__file__).parent
SHOWN_ALPHA = "5"
TEMPLATE = FOLDER / "README.template.md"


def page(lines: list[Condensed], rows: list[Row]) -> str:
    """The README; the tables and the page that it links to are written beside it."""
    gaussian = [line for line in lines if line.map == "gaussian"]
    found = fresh(lines, rows)
    long = {
        "fresh": fresh_table(found),
        "density": density_table(gaussian),
        "conductance": conductance_table(rows),
        "tolerance": tolerance_table(rows),
        "mesh": mesh_table(rows),
        "cells": size_table(rows),
        "printed": from_print.sheet(),
        "claims": from_print.claims_sheet(),
    }
    for name, sheet in long.items():
        sheet.write(FOLDER / f"table_{name}.csv")
    (FOLDER / "published.md").write_text(from_print.page(long["printed"], long["claims"]))
    return TEMPLATE.read_text().format(
        amount=amount(rows),
        pixels=DRAWN_PIXELS,
        within=within_table(gaussian),
        conductance=Sheet(
            long["conductance"].head, [x for x in long["conductance"].rows if x[0] == SHOWN_ALPHA]
        ),
        claim=claim(found),
        printed=from_print.summary(long["printed"], long["claims"]),
    )


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


def claim(found: list[Fresh]) -> str:
    """Whether fresh maps agree where the chart is sure that a model is within 10 %."""
    valid = [x for x in found if x.claimed]
    beyond = [abs(x.measured) for x in valid if abs(x.measured) > VALID]
    most = f", the most {max(beyond):.1%}" if beyond else ""
    return f"at {len(valid)} of {len(found)} points; of these fresh maps are beyond it at {len(beyond)}{most}"
