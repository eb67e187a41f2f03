"""The condensed table as a map: its errors between the measured points, and how fresh maps meet it."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from as_markdown import Sheet, load, percent, table
from deviations import Condensed, condensed
from models import SHOWN
from solve_table import Row

Value = Callable[[Condensed], float]

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
    lines: list[Condensed], model: str, interaction: str, value: Value, x: float, p: float
) -> float:
    """Something of a model on Gaussian surfaces, linear in the logarithms of alpha and load; nan outside."""
    own = {
        (line.x, line.p): value(line)
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
    """A model on fresh maps of one spectrum at one load.

    Parameters
    ----------
    hurst, alpha, p, model, interaction, quantity
        What and where.
    charted, charted_error : float
        Relative error that the chart tells, and its standard error.
    measured, error : float
        Relative error found, mean over maps, and its standard error: by the scatter that the chart tells of
        maps with so many spots, as that of three maps is hardly known from themselves.
    maps : int
    """

    hurst: float
    alpha: float
    p: float
    model: str
    interaction: str
    quantity: str
    charted: float
    charted_error: float
    measured: float
    error: float
    maps: int

    @property
    def claimed(self) -> bool:
        """Whether the chart is sure that the model is within 10 %."""
        return abs(self.charted) + 2 * self.charted_error <= VALID

    @property
    def holds(self) -> bool:
        """Whether the fresh maps are within 10 %, but for twice the standard error."""
        return abs(self.measured) <= VALID + 2 * self.error

    @property
    def z(self) -> float:
        """Measured less charted over the standard error of both."""
        return (self.measured - self.charted) / math.hypot(self.error, self.charted_error)


def fresh(lines: list[Condensed], rows: list[Row]) -> list[Fresh]:
    """All fresh maps against the chart."""
    found = []
    for hurst in sorted({float(row["hurst"]) for row in rows if row["purpose"] == "fresh"}):
        mine = condensed([row for row in rows if row["purpose"] == "fresh" and row["hurst"] == hurst])
        for one in mine:
            for model, interaction, quantity in CLAIMED:
                if (one.model, one.interaction) == (model, interaction):
                    found.append(_against(lines, one, quantity, hurst))
    return found


def _against(lines: list[Condensed], one: Condensed, quantity: str, hurst: float) -> Fresh:
    def chart(value: Value) -> float:
        return interpolated(lines, one.model, one.interaction, value, one.x, one.p)

    scatter = chart(lambda line: line.std[quantity] * math.sqrt(line.contacts))
    return Fresh(
        hurst=hurst,
        alpha=one.x,
        p=one.p,
        model=one.model,
        interaction=one.interaction,
        quantity=quantity,
        charted=chart(lambda line: line.mean[quantity]),
        charted_error=chart(lambda line: line.error(quantity)),
        measured=one.mean[quantity],
        error=scatter / math.sqrt(one.contacts * one.maps),
        maps=one.maps,
    )


def fresh_table(found: list[Fresh]) -> Sheet:
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
