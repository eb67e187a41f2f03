"""Solutions for given loads as plain text and as rows of a table."""

from collections.abc import Iterator, Sequence

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.intervals import interval_text
from mcgw.ensemble.solved import Solution, against_elasticity
from mcgw.formats.csv_table import Row
from mcgw.reports.elasticity import two_questions
from mcgw.scene.contact_text import contact_facts
from mcgw.scene.scene import Scene

__all__ = ["SOLUTION_HEADER", "solution_rows", "solution_table"]

SOLUTION_HEADER = (
    "pressure_Pa", "load_or_area_SI", "quantity", "unit", "theory", "mean", "low_95", "high_95", "std"
)  # fmt: skip
_LABELS = {
    "separation": "separation d/sigma",
    "nominal_separation": "nominal d/sigma",
    "conductance": "conductance x rho",
}
_SHOWN = ("contact law", "film", "interaction")  # what of the contacts counts at a given load


def solution_table(scene: Scene, solutions: Sequence[Solution]) -> str:
    """Theory and Monte Carlo side by side, one block for each given value."""
    lines = []
    for solution in solutions:
        lines += [
            f"{_title(scene, solution)}",
            f"  {'':22} {'theory':>12} {'mean':>12} {'95 % interval of the mean':>29} {'std':>10}",
        ]
        for name, x in solution.surfaces.items():
            if name == solution.given:
                continue
            label, unit = _LABELS.get(name, name), _unit(name)
            low, high = solution.interval(name)
            lines.append(
                f"  {label + (f' ({unit})' if unit != '1' else ''):22} {solution.theory[name]:12.6g} "
                f"{x.mean():12.6g} {interval_text(low, high):>29} {x.std(ddof=1):10.3g}"
            )
        lines.append("")
    few = [x for x in solutions if x.theory["contacts"] < 30]
    if few:
        lines.append(
            "Few contacts: finite surfaces differ from theory, whose surface is infinite, by more than noise."
        )
    lines += [f"{word}: {what}" for word, what in contact_facts(scene) if word in _SHOWN]
    if scene.unload_from is not None:
        lines.append("each surface is loaded from far away; nothing of it is on the way back")
    lines.append(
        f"std: over {scene.n_surfaces} surfaces of {scene.n_asperities:g} asperities, each at its own d;"
        f" heights drawn one by one, seed {scene.seed}"
    )
    return "\n".join([*lines, "", *two_questions(against_elasticity(solutions))])


def solution_rows(scene: Scene, solutions: Sequence[Solution]) -> Iterator[Row]:
    """Rows under `SOLUTION_HEADER`; an interval of too few contacts is nan."""
    for solution in solutions:
        pressure = solution.value / scene.surface.nominal_area if solution.given == "load" else np.nan
        for name, x in solution.surfaces.items():
            low, high = solution.interval(name)
            std = x.std(ddof=1)
            yield pressure, solution.value, name, _unit(name), solution.theory[name], x.mean(), low, high, std


def _unit(name: str) -> str:
    return "1" if name == "separation" else quantity_of(name).unit


def _title(scene: Scene, solution: Solution) -> str:
    share = solution.value / scene.surface.nominal_area
    if solution.given == "area":
        return f"Real area {solution.value:.6g} m^2 = {share:.4%} of the nominal area"
    return f"Load {solution.value:.6g} N = pressure {share / 1e6:.6g} MPa on the nominal area"
