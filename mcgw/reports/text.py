"""Results as plain text and tables: solutions at given loads, ensembles, sweeps, comparisons with theory."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import cooper_mikic_yovanovich, mean_absolute_slope, mikic_elastic, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.at_load import GAPS
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import statistics_table
from mcgw.ensemble.solved import Solution
from mcgw.ensemble.solved_table import answers_of, elastic_verdict
from mcgw.formats.table import SEPARATION, Column, Table, joined, stacked
from mcgw.machine.terminal import listed
from mcgw.scene.scene import Scene
from mcgw.scene.writing import accuracy_facts, contact_facts, joint_text
from mcgw.sweeps.axes import Axes

if TYPE_CHECKING:
    from mcgw.statistics.comparison import Comparison
    from mcgw.store.run_plan import Plan
    from mcgw.sweeps.sweep import Sweep

_AT_LOADS = ("contact law", "bodies", "interaction", "joint")  # what of the contacts counts at a given load
_GAP = {
    "mean_gap": "mean gap between the mean planes of the surfaces",
    "gap_to_summits": "gap to the mean plane of the summits",
}
_OF_SPECIMENS = {"joint": "joint, mean of h", "correlation": "correlation (spots)"}
# Left out of the short table; all but the first only where a film gives the conductance in SI units.
_VARIANTS = ("load_slope", "conductance", "conductance_si", "specific_contact_resistance")
_KEPT = "statistics alone: mean, covariance, skewness, quantiles, extremes"
_SHOWN = ("separation", "mean", "std", "stderr")


def solutions_text(
    scene: Scene, solutions: Sequence[Solution], scatter: float | None = None, full: bool = False
) -> str:
    """Return the answers, a line for each given value, at most two; then a table of them.

    With `scatter` also how many asperities it takes; `full` adds every quantity and the sources of error.
    """
    ends = solutions if len(solutions) <= 2 else (solutions[0], solutions[-1])
    lines = [*map(_brief, ends), elastic_verdict(solutions)]
    one = len(solutions) == 1
    if not full:
        lines.append(f"{solutions[0].budget().brief}; more: add -v")
        lines += ["", (answer_table(solutions[0]) if one else by_load(scene, solutions)).text()]
    else:
        lines += _background(scene, solutions)
        for solution in solutions:  # every quantity but the given one, specimens, and an infinite surface
            table = answers_of(solution, solution.table(specimens=True))
            table = table.only(*(x.name for x in table.columns if x.name != "std"))
            lines += ["", (replace(table, title="") if one else table).text()]
        if scene.film is not None:
            lines += ["", conductances(scene, solutions).text()]
    if scatter is not None:
        lines.append("")
        for each in solutions:
            known, eta = each.asperities_for(scatter).items(), each.scene.surface.eta
            sizes = ", ".join(f"{x} {n:.3g} ({n / eta:.3g} m^2)" for x, n in known)
            where = f"for std = {scatter:.3g} of the mean, {each.title[0].lower()}{each.title[1:]}"
            lines.append(f"Asperities (nominal area) {where}: {sizes}")
    for budget in (solution.budget() for solution in solutions if full):
        where = "" if one else f", {budget.title[0].lower()}{budget.title[1:]}"
        lines += ["", replace(budget.table(), title=f"Sources of error{where}").text(), f"  {budget.advice}"]
    return "\n".join(lines)


def answer_table(solution: Solution) -> Table:
    """Return the answer and specimens to the digits that count, a row a quantity that is no variant."""
    name, unit, value, least, most, std, _, *best = answers_of(solution, solution.table()).columns
    low, high = np.asarray(least.values), np.asarray(most.values)
    sure = high == low
    error = np.where(sure, 1e-4 * np.abs(np.asarray(value.values)), (high - low) / 2)
    half = Column("half", np.where(sure, np.nan, error), form=".2g", between=" ± ")
    value = replace(value, words="value (95 %)", error=error)
    title = joint_text(solution.scene) if solution.scene.thermal else ""
    hidden = _VARIANTS if solution.scene.film is not None else _VARIANTS[:1]
    words = replace(name, values=[x.replace("_", " ") for x in name.values])
    table = Table((words, unit, value, half, std, *best), title)
    return table.at([k for k, x in enumerate(name.values) if x not in hidden])


def by_load(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """Means of specimens with their 95 % errors where known, a row for each given value."""
    if scene.film is not None:
        return conductances(scene, solutions)
    budgets, amounts = [each.budget() for each in solutions], np.array([each.amount for each in solutions])
    per_area = amounts / scene.surface.nominal_area
    given = {
        "load": Column("pressure", per_area / 1e6, unit="MPa", form=".4g"),
        "nominal_separation": Column("nominal_separation", amounts, "nominal d/sigma", form=".4g"),
        "area": Column("area_fraction", per_area, "A/A_n", form=".4g"),
    }[solutions[0].given]
    h = Column("separation", [x.value["separation"] for x in solutions], SEPARATION, form=".3f")
    columns = [given, h]
    for k, name in enumerate(budgets[0].quantities):
        unit = "m" if name in GAPS else scene.quantity(name).unit
        values, errors = [x.value[name] for x in solutions], [budget.all[k] for budget in budgets]
        columns.append(Column(name, values, name.replace("_", " "), unit, form=".4g"))
        columns.append(Column("error", errors, form=".1%", between=" ± "))
    return Table((*columns, Column("contacts", [x.value["contacts"] for x in solutions], form=".4g")))


def _brief(solution: Solution) -> str:
    """Return the answer in one line, `best` with its 95 %: conductance if there is any, else area or load."""
    budget, value, scene = solution.budget(), solution.value, solution.scene
    name = budget.quantities[0]
    if scene.film is not None:
        name = next(x for x in ("joint_conductance", "contact_conductance") if x in value)
    best, scatter = solution.corrected(name), solution.std[name] / abs(value[name])
    first = value[name] if np.isnan(best.value) else best.value
    told = f"{first:.4g} {scene.quantity(name).unit} {budget.told(name, best, scatter)}"
    if f"{first:.4g}" != f"{value[name]:.4g}":
        told += f" (value {value[name]:.4g})"
    return f"{solution.title}: {name.replace('_', ' ')} = {told}, d/sigma = {value['separation']:.4g}"


def _background(scene: Scene, solutions: Sequence[Solution]) -> list[str]:
    """Return what is meant by the numbers."""
    ways = ", drawn from the measured ones" if scene.as_measured else ""
    many = f"{solutions[0].drawn.n_surfaces} surfaces of {scene.n_asperities:g} asperities{ways}"
    lines = [f"specimens: {many}, seed {scene.seed}; {_GAP[scene.gap]}"]
    if scene.unload_from is not None:
        lines.append("each surface is loaded from first contact; unloading is not included")
    lines += [f"{word}: {what}" for word, what in contact_facts(scene) if word in _AT_LOADS]
    if solutions[0].told_by is not None:
        lines.append("90 % of specimens: for the separation from its exact distribution")
    return lines


def conductances(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """Return what the joint conducts on average, a row for each load: spots, bodies in series, gas beside."""
    area, other = scene.surface.nominal_area, scene.series("conductance_si")
    at = {name: np.array([x.value[name] for x in solutions]) for name in solutions[0].value}
    contact = at["contact_conductance"]
    found = {"spots": contact / (1 - other * area * contact)}
    if other:
        found["constriction"] = np.full(len(contact), 1 / (other * area))
    if scene.gas is not None:
        found["gas"] = at["gap_conductance"]
    found["joint"] = at.get("joint_conductance", contact)
    if (told := correlation(scene, at["load"] / area)) is not None:
        found["correlation"] = told
    q = scene.quantity("thermal_resistance" if scene.thermal else "contact_resistance")
    columns = (
        Column("pressure", at["load"] / area / 1e6, unit="MPa", form=".4g"),
        Column("separation", at["separation"], SEPARATION, form=".3f"),
        Column("area_fraction", at["area"] / area, "A/A_n", form=".3g"),
        Column("stiffness", at["stiffness"] / area, unit="Pa/m", form=".4g"),
        *(Column(name, values, _OF_SPECIMENS.get(name, ""), form=".4g") for name, values in found.items()),
        Column(q.name, at[q.name], "resistance, mean of 1/(h A_n)", unit=q.unit, form=".4g"),
    )
    gas = f"; {joint_text(scene)}" if scene.thermal else ""
    unit = scene.quantity("contact_conductance").unit
    return Table(columns, f"Conductance by pressure, {unit}, means of specimens{gas}")


def correlation(scene: Scene, pressure: Array) -> Array | None:
    """Conductance of the spots by a correlation of the whole surface, per area, where m0 and m2 are known.

    That of Cooper, Mikic and Yovanovich (1969) beside a law that yields at a hardness, that of Mikic (1974)
    beside an elastic one: see `analytic.cooper_mikic_yovanovich` and `analytic.mikic_elastic`. None without
    moments or hardness, and with a film or layer.
    """
    film, moments, hardness = scene.film, scene.moments, getattr(scene.law, "hardness", None)
    if moments is None or film is None or film.film_resistance or film.layer is not None:
        return None
    spots: Any = {"rms": moments.m0**0.5, "slope": mean_absolute_slope(moments.m2)}
    spots["conductivity"] = 2 / film.rho
    if scene.law.elastic:
        return mikic_elastic(pressure, E_star=scene.surface.E_star, **spots)
    return None if hardness is None else cooper_mikic_yovanovich(pressure, hardness=hardness, **spots)


def solutions_table(scene: Scene, solutions: Sequence[Solution]) -> Table:
    """All of them under each other, each row with what was given (SI; d/sigma) and the mean pressure."""
    tables = [solution.table() for solution in solutions]
    rows = [len(table) for table in tables]
    loads = np.array([x.value["load"] for x in solutions])
    given = (
        Column("given", np.repeat([x.given for x in solutions], rows)),
        Column("amount", np.repeat([x.amount for x in solutions], rows)),
        Column("pressure", np.repeat(loads / scene.surface.nominal_area, rows), unit="Pa"),
    )
    return Table((*given, *joined(tables).columns))


def summary(result: "Ensemble | Sweep", attributes: dict[str, Any], full: bool = True) -> str:
    """Tell what a file holds: what is shown of it, and its provenance; if `full`, a table a quantity, too."""
    origin = [
        ("digest", str(attributes["digest"])),
        ("made", f"{attributes['date']} in {attributes['wall_seconds']:.2f} s on {attributes['cpu']}"),
        ("with", f"{attributes['versions']}; commit {attributes['commit']}"),
    ]
    if not isinstance(result, Ensemble):
        return "\n".join([str(result), *listed(origin)])
    scene, h, spent = result.scene, result.scene.separations, attributes.get("accuracy_spent")
    facts = [
        ("separations", f"{len(h)} from {min(h):g} to {max(h):g} (d/sigma)"),
        ("complete", "yes" if attributes["complete"] else f"no: {result.n_surfaces} of {scene.n_surfaces}"),
        *([] if spent is None else [("accuracy", f"{spent:.2g} of it spent")]),
        *([] if scene.keep != "statistics" else [("kept", _KEPT)]),
        *origin,
    ]
    lines = [result.sheet().text(whole=True), *listed(facts)]
    if not full:
        return "\n".join([*lines, "standard deviations, more separations, what was measured: add -v"])
    lines += [f"  {line}" for line in scene.validity().lines]
    for name in scene.answers:
        lines += ["", statistics_table(result, name).only(*_SHOWN).rows().text()]
    return "\n".join(lines)


def comparison_text(comparison: "Comparison") -> str:
    """Monte Carlo beside theory at some separations."""
    scene = comparison.ensemble.scene
    facts = [f"{word}: {what}" for word, what in (*contact_facts(scene), *accuracy_facts(scene))]
    return "\n".join([*facts, *(table.rows().text() for table in comparison.tables().values())])


def ratios_in_words(sweep: "Sweep") -> list[str]:
    """Of each quantity a line: its mean at the last point over that at the first, on the same surfaces."""
    h, axes = sweep.separations, sweep.axes
    ends = dict.fromkeys((int(np.argmin(h)), int(np.argmax(h))))
    last, first = axes.text(axes.size - 1), axes.text(0)
    lines = []
    for name, pairs in sweep.ratios().items():
        ratio, (low, high) = pairs[-1].ratio, pairs[-1].interval()
        found = (f"{ratio[k]:.5g} ({low[k]:.5g} to {high[k]:.5g}) at d/sigma = {h[k]:g}" for k in ends)
        lines.append(f"{quantity_of(name).long_name}, {last} over {first}: {', '.join(found)}")
    return lines


def table_of(result: "Ensemble | Sweep") -> Table:
    """Return means, standard deviations and standard errors of all that a file holds."""
    if not isinstance(result, Ensemble):
        return result.table()
    return stacked({name: statistics_table(result, name) for name in result.scene.answers}, "quantity")


def progress_of(plan: "Plan") -> str:
    """How far a sweep has come."""
    axes, total = Axes.from_text(plan.axes), plan.total
    missing = sum(span.n for span in plan.missing(0, plan.shards()))
    return (
        f"{plan.path}: a sweep of {axes.size} points over {', '.join(axes.keys)}, not finished: "
        f"{total - missing} of {total} surfaces are drawn; run mcgw sweep again to resume"
    )
