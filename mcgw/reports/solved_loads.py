"""Solutions for given loads as plain text and as one table."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mcgw.ensemble.at_load import rise_of_summits
from mcgw.ensemble.intervals import MANY
from mcgw.ensemble.solved import Solution, against_elasticity
from mcgw.formats.table import SEPARATION, Column, Table, joined
from mcgw.scene.in_words import contact_facts, joint_text
from mcgw.scene.scene import Scene

_SHOWN = ("contact law", "film", "interaction", "joint")  # what of the contacts counts at a given load


def solutions_text(scene: Scene, solutions: Sequence[Solution], scatter: float | None = None) -> str:
    """Theory and Monte Carlo side by side, one block for each given value.

    With a `scatter` that is wanted also how many asperities it takes.
    """
    lines = [f"{solution.sheet().table}\n" for solution in solutions]
    if scene.film is not None:
        lines.append(f"{conductances(scene, solutions)}\n")
    if any(x.theory["contacts"] < MANY for x in solutions):
        lines.append(
            "Few contacts: finite surfaces differ from theory, whose surface is infinite, by more than noise."
        )
    lines += [f"{word}: {what}" for word, what in contact_facts(scene) if word in _SHOWN]
    plane = "summits, which lies above that of the surface" if rise_of_summits(scene) is None else "surface"
    lines.append(f"mean gap: of the rigid plane from the mean plane of the {plane}")
    exactly = "; of the separation by its exact law" if solutions[0].told_by is not None else ""
    if scene.unload_from is not None:
        lines.append("each surface is loaded from far away; nothing of it is on the way back")
    ways = "drawn from the measured ones" if scene.as_measured else "heights drawn one by one"
    number = solutions[0].drawn.n_surfaces
    lines.append(
        f"specimens: {number} surfaces of {scene.n_asperities:g} asperities, each at its own d; {ways}, "
        f"seed {scene.seed}{exactly}"
    )
    if scatter is not None:
        lines += ["", *(_sizes(solution, scatter) for solution in solutions)]
    for budget in (solution.budget() for solution in solutions):
        lines += ["", f"Off a real specimen, {budget.title[0].lower()}{budget.title[1:]}:"]
        lines += [replace(budget.table(), title="").text(), f"  {budget.advice}"]
    return "\n".join([*lines, "", against_elasticity(solutions).verdict])


def conductances(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """What the joint conducts by theory, a row for each load: spots, bodies in series, gas beside."""
    area, other = scene.surface.nominal_area, scene.series("conductance_si")
    at = {name: np.array([x.theory[name] for x in solutions]) for name in solutions[0].theory}
    contact = at["contact_conductance"]
    found = {"spots": contact / (1 - other * area * contact)}
    if other:
        found["constriction"] = np.full(len(contact), 1 / (other * area))
    if scene.joint is not None:
        found["gas"] = at["gap_conductance"]
    found["joint"] = at.get("joint_conductance", contact)
    q = scene.quantity("thermal_resistance" if scene.thermal else "contact_resistance")
    columns = (
        Column("pressure", at["load"] / area / 1e6, unit="MPa", form=".4g"),
        Column("separation", at["separation"], SEPARATION, form=".3f"),
        Column("area_fraction", at["area"] / area, "A/A_n", form=".3g"),
        Column("stiffness", at["stiffness"] / area, unit="Pa/m", form=".4g"),
        *(Column(name, values, form=".4g") for name, values in found.items()),
        Column(q.name, at[q.name], "resistance", unit=q.unit, form=".4g"),
    )
    gas = f"; {joint_text(scene)}" if scene.thermal else ""
    unit = scene.quantity("contact_conductance").unit
    return Table(columns, f"Conductance by pressure, {unit}, theory{gas}")


def _sizes(solution: Solution, scatter: float) -> str:
    """How many asperities, on which area, a scatter takes."""
    eta = solution.scene.surface.eta
    sizes = (f"{x} {n:.3g} ({n / eta:.3g} m^2)" for x, n in solution.asperities_for(scatter).items())
    where = f"{solution.title[0].lower()}{solution.title[1:]}"
    return f"Asperities (nominal area) for std = {scatter:.3g} of the mean, {where}: {', '.join(sizes)}"


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
