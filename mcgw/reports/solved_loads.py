"""Solutions for given loads as plain text and as one table."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mcgw.ensemble.at_load import GAPS
from mcgw.ensemble.intervals import MANY
from mcgw.ensemble.solved import Solution, against_elasticity
from mcgw.formats.table import SEPARATION, Column, Table, joined
from mcgw.scene.in_words import contact_facts, joint_text
from mcgw.scene.scene import Scene
from mcgw.scene.validity import percent

_SHOWN = ("contact law", "film", "interaction", "joint")  # what of the contacts counts at a given load
_GAP = {
    "mean_gap": "mean gap between the mean planes of the surfaces",
    "gap_to_summits": "gap to the mean plane of the summits",
}
_LINES = 2  # loads that the news names one by one
# Left out of the short table; all but the first only where a film gives the conductance in SI units.
_VARIANTS = ("load_slope", "conductance", "conductance_si", "specific_contact_resistance")


def solutions_text(
    scene: Scene, solutions: Sequence[Solution], scatter: float | None = None, full: bool = False
) -> str:
    """The answers, a line for each given value, at most two; then a table of them.

    With `scatter` also how many asperities it takes; `full` adds every quantity and the sources of error.
    """
    lines = [_brief(x) for x in (solutions if len(solutions) <= _LINES else (solutions[0], solutions[-1]))]
    lines.append(against_elasticity(solutions).verdict)
    one = len(solutions) == 1
    if not full:
        lines.append(f"{solutions[0].budget().brief}; more: add -v")
        lines += ["", (_answer(solutions[0]) if one else _by_load(scene, solutions)).text()]
    else:
        lines += _background(scene, solutions)
        for solution in solutions:
            table = _full(solution)
            lines += ["", (replace(table, title="") if one else table).text()]
        if scene.film is not None:
            lines += ["", conductances(scene, solutions).text()]
    if scatter is not None:
        lines += ["", *(_sizes(solution, scatter) for solution in solutions)]
    for budget in (solution.budget() for solution in solutions if full):
        title = "Sources of error" if one else f"Sources of error, {_lowered(budget.title)}"
        lines += ["", replace(budget.table(), title=title).text(), f"  {budget.advice}"]
    return "\n".join(lines)


def _full(solution: Solution) -> Table:
    table = solution.sheet().table
    assert table is not None
    return table


def _answer(solution: Solution) -> Table:
    """Theory, mean and specimens to the digits that count, a row for each quantity that is not a variant."""
    table = _full(solution)
    name, unit, theory, mean, interval, least, *corrected = table.columns
    low, high = (np.asarray(column.values) for column in interval.flat)
    half = Column("half", (high - low) / 2, form=".2g")
    table = Table(
        (
            name,
            unit,
            replace(theory, form=".4g", error=None),
            replace(mean, words="mean (95 %)", error=half.values, beside=half, between=" ± "),
            least,
            *corrected,
        ),
        joint_text(solution.scene) if solution.scene.thermal else "",
    )
    hidden = _VARIANTS if solution.scene.film is not None else _VARIANTS[:1]
    return table.at([k for k, x in enumerate(name.values) if x not in hidden])


def _by_load(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """Answers of the theory with their 95 % errors where known, a row for each given value."""
    if scene.film is not None:
        return conductances(scene, solutions)
    area, budgets = scene.surface.nominal_area, [each.budget() for each in solutions]
    if solutions[0].given == "load":
        given = Column("pressure", [x.value / area / 1e6 for x in solutions], unit="MPa", form=".4g")
    else:
        given = Column("area_fraction", [x.value / area for x in solutions], "A/A_n", form=".4g")
    h = Column("separation", [x.theory["separation"] for x in solutions], SEPARATION, form=".3f")
    columns = [given, h]
    for k, name in enumerate(budgets[0].quantities):
        unit = "m" if name in GAPS else scene.quantity(name).unit
        error = Column("error", [budget.all[k] for budget in budgets], form=".1%")
        values = [x.theory[name] for x in solutions]
        words = name.replace("_", " ")
        columns.append(Column(name, values, words, unit, form=".4g", beside=error, between=" ± "))
    return Table((*columns, Column("contacts", [x.theory["contacts"] for x in solutions], form=".4g")))


def _brief(solution: Solution) -> str:
    """The answer in one line: separation, area or load with its error, contacts, conductance."""
    budget, theory, scene = solution.budget(), solution.theory, solution.scene
    name = budget.quantities[0]
    told = f"d/sigma = {theory['separation']:.4g}, "
    told += f"{name} = {theory[name]:.4g} {scene.quantity(name).unit} ± {percent(budget.all[0])}"
    conducted = next((x for x in ("joint_conductance", "contact_conductance") if x in theory), None)
    if conducted is not None and scene.film is not None:
        q = scene.quantity(conducted)
        told += f", {q.name.replace('_', ' ')} = {theory[conducted]:.4g} {q.unit}"
    return f"{solution.title}: {told}"


def _background(scene: Scene, solutions: Sequence[Solution]) -> list[str]:
    """What is meant by the numbers."""
    ways = ", drawn from the measured ones" if scene.as_measured else ""
    many = f"{solutions[0].drawn.n_surfaces} surfaces of {scene.n_asperities:g} asperities{ways}"
    lines = [f"specimens: {many}, seed {scene.seed}; {_GAP[scene.gap]}"]
    if any(x.theory["contacts"] < MANY for x in solutions):
        lines.append("few contacts: finite surfaces differ from the theory of an infinite one beyond noise")
    if scene.unload_from is not None:
        lines.append("each surface is loaded from first contact; unloading is not included")
    lines += [f"{word}: {what}" for word, what in contact_facts(scene) if word in _SHOWN]
    if solutions[0].told_by is not None:
        lines.append("90 % of specimens: for the separation from its exact distribution")
    return lines


def _lowered(title: str) -> str:
    """A title inside a line."""
    return f"{title[0].lower()}{title[1:]}"


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
    where = _lowered(solution.title)
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
