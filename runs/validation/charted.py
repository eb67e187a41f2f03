"""The condensed table as a map: its errors between the measured points, and how fresh maps meet it."""

import math
from dataclasses import dataclass

import numpy as np
from as_markdown import load, percent, table
from deviations import Condensed, condensed
from model_tables import SHOWN
from solve_table import Row

VALID = 0.10  # relative error within which a model calls itself valid
CLAIMED = (
    ("one radius", "none", "area"),
    ("own radii", "none", "area"),
    ("one radius", "none", "stiffness"),
    ("one radius", "summits", "stiffness"),
    ("own radii", "none", "stiffness"),
    ("own radii", "summits", "stiffness"),
    ("own radii", "contacts", "stiffness"),
)  # at a given load, interaction leaves the area as it is


def interpolated(
    lines: list[Condensed], model: str, interaction: str, quantity: str, x: float, p: float
) -> float:
    """Error of a model on a Gaussian surface: linear in the logarithms of alpha and load; nan outside."""
    own = {
        (line.x, line.p): line.mean[quantity]
        for line in lines
        if (line.map, line.model, line.interaction) == ("gaussian", model, interaction)
    }
    alphas, loads = (sorted({key[k] for key in own}) for k in (0, 1))
    if not (alphas and alphas[0] <= x <= alphas[-1] and loads[0] <= p <= loads[-1]):
        return math.nan
    at_alpha = [
        np.interp(math.log(p), np.log(loads), [own.get((alpha, one), math.nan) for one in loads])
        for alpha in alphas
    ]
    return float(np.interp(math.log(x), np.log(alphas), at_alpha))


@dataclass(frozen=True)
class Fresh:
    """A model on fresh maps of one spectrum at one load: charted error, measured one and its own error."""

    hurst: float
    alpha: float
    p: float
    model: str
    interaction: str
    quantity: str
    charted: float
    measured: float
    error: float
    maps: int

    @property
    def holds(self) -> bool:
        """Whether the error is within 10 %, as charted, or not beyond by more than twice its own error."""
        return abs(self.measured) <= VALID + 2 * self.error


def fresh(lines: list[Condensed], rows: list[Row]) -> list[Fresh]:
    """All fresh maps against the chart."""
    found = []
    for hurst in sorted({float(row["hurst"]) for row in rows if row["purpose"] == "fresh"}):
        mine = condensed([row for row in rows if row["purpose"] == "fresh" and row["hurst"] == hurst])
        for one in mine:
            for where in (x for x in CLAIMED if x[:2] == (one.model, one.interaction)):
                chart, measured = interpolated(lines, *where, one.x, one.p), one.mean[where[2]]
                found.append(
                    Fresh(hurst, one.x, one.p, *where, chart, measured, one.error(where[2]), one.maps)
                )
    return found


def claimed(found: list[Fresh]) -> list[Fresh]:
    """Those where the chart says that a model is within 10 %."""
    return [one for one in found if abs(one.charted) <= VALID]


def fresh_table(found: list[Fresh]) -> str:
    """Charted and measured errors."""
    points = sorted({(one.alpha, one.hurst, one.p, one.maps) for one in found})
    cells = {(one.alpha, one.hurst, one.p, one.model, one.interaction, one.quantity): one for one in found}
    body = []
    for alpha, hurst, p, maps in points:
        row = [cells[(alpha, hurst, p, *where)] for where in CLAIMED]
        shown = [f"{percent(one.charted)}: {percent(one.measured, one.error)}" for one in row]
        body.append([f"{alpha:g}", f"{hurst:g}", load(p), str(maps), *shown])
    head = [f"{quantity}, {model}{SHOWN[interaction]}" for model, interaction, quantity in CLAIMED]
    return table(["α", "H", "p/(E* g)", "maps", *head], body)
