"""What is shown of a solution: its answers as a table, and the verdict on its model in a line."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from analytic import SEPARATIONS
from mcgw.ensemble.at_load import GAPS
from mcgw.ensemble.budget import MOST_YIELDING, yields
from mcgw.ensemble.intervals import interval_columns
from mcgw.formats.table import Column, Table
from mcgw.validity.lookup import validity_of


def sheet_of(solution: Any) -> Table:
    """Return the answers, and how specimens differ."""
    drawn = "" if solution.exact else f"{len(solution.surfaces['separation'])} "
    many = f"{drawn}surfaces of {solution.scene.n_asperities} asperities"
    many += ", drawn from the measured summits" if solution.scene.as_measured else ""
    facts = [("over", many), ("elasticity", solution.against_elasticity.brief)]
    facts += [("yielding", why)] if (why := yields(solution.yielding)) else []
    table = answers_of(solution, solution.table())
    shown = table.only(*(x.name for x in table.columns if x.name != "infinite"))
    return shown.under(shown.title, facts)


def answers_of(solution: Any, table: Table) -> Table:
    """Leave out what was given, and the corrected answers where there are none."""
    if np.isnan(table.columns[-1].values).all():
        table = replace(table, columns=table.columns[:-2])
    return table.at([k for k, name in enumerate(solution.theory) if name != solution.given])


def table_of(solution: Any, specimens: bool = False) -> Table:
    """Return the mean over specimens, their scatter and the corrected answer, a row for each quantity.

    Parameters
    ----------
    specimens : bool
        Add the range of 90 % of them, for which surfaces are drawn.
    """
    units = {**dict.fromkeys(GAPS, "m"), "separation": "sigma", **dict.fromkeys(SEPARATIONS, "sigma")}
    names = list(solution.theory)
    low, high = np.array([solution.interval(name) for name in names]).T
    means = np.array([solution.value[name] for name in names])
    error = np.where(high > low, (high - low) / 4, np.where(high == low, 1e-6 * np.abs(means), np.nan))
    right, below, above, _ = map(np.array, zip(*map(solution.corrected, names), strict=True))
    columns = [
        Column("quantity", names),
        Column("unit", [units.get(name) or solution.scene.quantity(name).unit for name in names]),
        Column("value", means, error=error),
        *interval_columns(low, high),
        Column("std", [solution.std[name] for name in names], "std of specimens", form=".2g"),
    ]
    if specimens:
        least, most = np.array([solution.specimens(name) for name in names]).T
        columns.append(Column("specimen_05", least, "90 % of specimens", form=".4g"))
        columns.append(Column("specimen_95", most, form=".4g", between=" ... "))
    infinite = [solution.theory[name] for name in names]
    columns += [
        Column("infinite", infinite, "infinite surface", form=".5g"),
        Column("best", right, "best (95 %)", error=(above - below) / 2, missing=""),
        Column("best_95", (above - below) / 2, form=".1g", between=" ± "),
    ]
    return Table(tuple(columns), solution.title)


def elastic_verdict(solutions: Sequence[Any]) -> str:
    """Measured error of the model at some solutions of one scene, and whether contacts yield, in one line."""
    scene = solutions[0].scene
    error = validity_of(scene, [each.theory["separation"] for each in solutions]).verdict
    if not scene.law.elastic:
        return error
    most = max((each.yielding for each in solutions), key=lambda share: np.nan_to_num(share, nan=-1.0))
    if np.isnan(most):
        return f"{error}; yielding not looked at: give contact.law.hardness"
    if most > MOST_YIELDING:
        return f"Model error: not known, {yields(most)}"
    return f"{error}; {most:.1%} of the contacts yield"
