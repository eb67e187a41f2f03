"""A curve as the text of a file that a program reads."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mcgw.exports.curves import Curve
from mcgw.exports.kinds import Kind
from mcgw.exports.programs import Program, foot_of, rows_of
from mcgw.exports.unit_systems import UnitSystem
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import one_line

__all__ = ["all_curves", "in_units", "table_text"]


def in_units(curve: Curve, kind: Kind, system: UnitSystem) -> Curve:
    """A curve of SI in other units."""
    factor = (system.length if kind.against == "gap" else system.pressure)[0]
    return Curve(curve.name, factor * curve.x, getattr(system, kind.quantity)[0] * curve.y)


def table_text(
    curve: Curve, kind: Kind, program: Program, system: UnitSystem, head: Sequence[str], file: str
) -> str:
    """Comments, keyword and rows.

    Parameters
    ----------
    curve : Curve
        In the units of the file.
    kind, program, system
        Of what, for which program, in which units.
    head : sequence of str
        What its comments begin with.
    file : str
        Its name, which some comments tell.

    Raises
    ------
    ValueError
        If the program has no room for it.
    """
    foot = foot_of(curve) if kind.against == "gap" else 0.0
    rows = rows_of(curve, kind, program, foot)
    _check(rows, kind, program)
    comments = [*head, *(_foot(foot, kind, program, system) if foot else ()), *program.hints(kind, file)]
    lines = [f"{program.comment} {one_line(line)}" for line in comments]
    lines += [program.keywords[kind.name]] if program.keywords[kind.name] else []
    lines += [program.separator.join(f"{x:.9e}" for x in row) for row in rows.tolist()]
    return "\n".join([*lines, ""])


def _foot(foot: float, kind: Kind, program: Program, system: UnitSystem) -> list[str]:
    """Where the curve ends, and what zero is."""
    lines = [
        f"nothing is carried from the gap d0 = {foot:.9e} {system.length[1]} on",
        "(there the line through the last two points comes down to 0)",
    ]
    if program.overclosure and kind.quantity == "pressure":
        lines.append("overclosure = d0 - d: lay the two surfaces so that they meet where the gap is d0")
    return lines


def _check(rows: NDArray[np.float64], kind: Kind, program: Program) -> None:
    if program.most is not None and len(rows) > program.most:
        raise ValueError(
            f"points = {len(rows) - 1}: {program.name} has room for {program.most} lines; give fewer"
        )
    if program.least_step and kind.quantity == "pressure" and np.diff(rows[:, 1]).min() < program.least_step:
        raise ValueError(
            f"points: overclosures lie nearer than {program.least_step:g}, which {program.name} moves apart; "
            'give fewer points or units = "mm-N-s"'
        )


def all_curves(curves: Sequence[Curve], kind: Kind, system: UnitSystem) -> Table:
    """All curves beside each other, in the units of the files; empty where one of them carries nothing."""
    x = np.unique(np.concatenate([curve.x for curve in curves])).tolist()
    unit = (system.length if kind.against == "gap" else system.pressure)[1]
    value = getattr(system, kind.quantity)[1].partition(",")[0]
    columns = [Column(f"{kind.against} ({unit})", x)]
    for curve in curves:
        held = dict(zip(curve.x.tolist(), curve.y.tolist(), strict=True))
        columns.append(Column(f"{kind.quantity} {curve.name} ({value})", [held.get(at, "") for at in x]))
    return Table(tuple(columns))
