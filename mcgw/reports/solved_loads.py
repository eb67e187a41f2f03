"""Solutions for given loads as plain text and as one table."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mcgw.ensemble.at_load import rise_of_summits
from mcgw.ensemble.intervals import MANY
from mcgw.ensemble.solved import Solution, against_elasticity
from mcgw.formats.table import Column, Table, joined
from mcgw.scene.in_words import contact_facts
from mcgw.scene.scene import Scene

_SHOWN = ("contact law", "film", "interaction")  # what of the contacts counts at a given load


def solutions_text(scene: Scene, solutions: Sequence[Solution]) -> str:
    """Theory and Monte Carlo side by side, one block for each given value."""
    lines = [f"{solution.sheet().table}\n" for solution in solutions]
    if any(x.theory["contacts"] < MANY for x in solutions):
        lines.append(
            "Few contacts: finite surfaces differ from theory, whose surface is infinite, by more than noise."
        )
    lines += [f"{word}: {what}" for word, what in contact_facts(scene) if word in _SHOWN]
    plane = "summits, which lies above that of the surface" if rise_of_summits(scene) is None else "surface"
    lines.append(f"mean gap: of the rigid plane from the mean plane of the {plane}")
    if scene.unload_from is not None:
        lines.append("each surface is loaded from far away; nothing of it is on the way back")
    lines.append(
        f"std: over {scene.n_surfaces} surfaces of {scene.n_asperities:g} asperities, each at its own d;"
        f" heights drawn one by one, seed {scene.seed}"
    )
    for budget in (solution.budget() for solution in solutions):
        lines += ["", f"Off a real specimen, {budget.title[0].lower()}{budget.title[1:]}:"]
        lines += [replace(budget.table(), title="").text(), f"  {budget.advice}"]
    return "\n".join([*lines, "", against_elasticity(solutions).verdict])


def solutions_table(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """All of them under each other, each row with what was given."""
    tables = []
    for solution in solutions:
        table, area = solution.table(), scene.surface.nominal_area
        pressure = solution.value / area if solution.given == "load" else np.nan
        given = {"pressure_Pa": pressure, "load_or_area_SI": solution.value}
        columns = (Column(name, np.full(len(table), value)) for name, value in given.items())
        tables.append(Table((*columns, *table.columns)))
    return joined(tables)
