"""How far a model is from elasticity, in words and as a table."""

import math
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from mcgw.formats.table import SEPARATION, Column, Table
from mcgw.scene.validity_errors import ModelErrors

_MOST_ROWS = 9
_AT_LOAD = {"area": "area", "stiffness": "stiffness", "separation": "gap"}  # columns at a given load
_COLUMNS = {"area": "area", "stiffness": "stiffness", "separation": "gap/sigma", "load": "load at d"}


def verdict(v: ModelErrors) -> str:
    """One sentence: how far from elasticity, where, and where that was not measured."""
    if not v.measured.any():
        return f"Against elasticity: {v.unknown}"
    parts, at_load, at_gap = [], v.known("area", "stiffness"), v.known("load")
    if at_load.any():
        parts.append(f"within {percent(v.worst('area', 'stiffness'))} at a given load{_here(v, at_load)}")
    if at_gap.any():
        where = "" if np.array_equal(at_gap, at_load) else _here(v, at_gap)
        parts.append(f"load within {percent(v.worst('load'))} at a given mean gap{where}")
    line = f"Against elasticity: {', '.join(parts)} (95 %{_homogeneous(v)})"
    if not v.measured.all():
        line += f"; at d/sigma = {span(v.separations, ~v.measured)} {v.unknown}"
    return line


def details(v: ModelErrors) -> str:
    """What has which error, and where it was measured; empty where nothing was."""
    if not v.measured.any():
        return ""
    known = {word: v.worst(name) for name, word in _AT_LOAD.items() if not math.isnan(v.worst(name))}
    told = [
        f"{word} {rounded_up(worst):g} sigma" if word == "gap" else f"{word} {percent(worst)}"
        for word, worst in known.items()
    ]
    lacking = [word for word in _AT_LOAD.values() if word not in known]
    each = ", ".join(told) + (f"; {', '.join(lacking)}: not measured" if lacking else "")
    return f"{each} (95 %); by {v.where}"


def short_verdict(v: ModelErrors) -> str:
    """The same in 88 characters."""
    if not v.measured.any():
        return v.unknown
    errors = {"at a given load": v.worst("area", "stiffness"), "in load at a given gap": v.worst("load")}
    told = [f"{percent(error)} {of}" for of, error in errors.items() if not math.isnan(error)]
    where = "" if v.measured.all() else f"; d/sigma = {span(v.separations, v.measured)}"
    return f"within {', '.join(told)} (95 %{_homogeneous(v)}){where}"


def _homogeneous(v: ModelErrors) -> str:
    return ", without the grading" if v.graded else ""


def table_of(v: ModelErrors) -> Table:
    """At some separations the bias of each quantity, and how far 95 % are from it; empty where unmeasured."""
    if not v.measured.any():
        return Table(())
    told = (
        Column(name, [_cell(v, name, k) for k in range(len(v.separations))], words)
        for name, words in _COLUMNS.items()
    )
    separation = Column("separation", v.separations, SEPARATION, form="g")
    return Table((separation, Column("pressure", v.loads, unit="1", form=".2g"), *told)).rows(_MOST_ROWS)


def percent(x: float) -> str:
    """A share, rounded up: what is said holds."""
    return f"{100 * rounded_up(x):.0f} %"


def rounded_up(x: float) -> float:
    """To two decimals."""
    return math.ceil(100 * x - 1e-9) / 100


def span(h: NDArray[np.float64], where: NDArray[np.bool_]) -> str:
    """Separations of one kind: from where to where, perhaps twice."""
    runs = []
    for wanted, group in groupby(range(len(h)), key=lambda k: bool(where[k])):
        members = list(group)
        if wanted:
            ends = dict.fromkeys(f"{h[k]:.3g}" for k in (members[0], members[-1]))
            runs.append(" to ".join(ends))
    return " and ".join(runs)


def _here(v: ModelErrors, where: NDArray[np.bool_]) -> str:
    return "" if where.all() else f" for d/sigma = {span(v.separations, where)}"


def _cell(v: ModelErrors, name: str, k: int) -> str:
    bias, error = float(v.bias[name][k]), float(v.error[name][k])
    if math.isnan(error):
        return "not measured"
    off = error - abs(bias)
    if name == "separation":
        return f"{bias:+.2f} ± {off:.2f}"
    return f"{100 * bias:+.0f} ± {100 * off:.0f} %"
