"""Conductance at a given load against boundary elements, before and after what neighbours constrict.

Two half-spaces obey C ρ = 2K/E* whatever the shape of the spots between them (J. R. Barber,
Proc. R. Soc. A 459 (2003) 53), so that each solved stiffness is a conductance. In a periodic cell ::

    1/(C ρ) = 1/(C_spots ρ) - E* |Λ|/2,    |Λ| = 1.2415/(E* √n) per load

with n the density of all summits. C_spots is 4a summed over the spots, by :mod:`analytic`; the distance of
the mean planes is not needed, for the load is given.
"""

import math
from functools import lru_cache

import numpy as np
from as_markdown import Sheet, load, percent, table
from deviations import number
from models import SQUARE_LATTICE
from solve_list import STEP
from solve_table import Row

import analytic


@lru_cache(maxsize=64)
def summits(m0: float, m2: float, m4: float) -> analytic.Model:
    """Of a Gaussian surface with these moments, each with its own radius; E* and area are 1."""
    moments = analytic.SpectralMoments(m0, m2, m4)
    surface = moments.surface(1.0, 1.0)
    curvature = analytic.RandomCurvature(moments.alpha, 1 / surface.radius)
    return analytic.Model(surface, heights=analytic.Nayak(moments.alpha), curvature=curvature)


def errors(row: Row) -> tuple[float, float]:
    """C/C_BEM - 1 of the spots alone, and with what their neighbours constrict."""
    model = summits(*(number(row, key) for key in ("m0", "m2", "m4")))
    h = model.separation_at("pressure", (1 + STEP) / 2 * number(row, "p"))
    spots = float(model.mean("conductance", h))  # times the resistivity
    solved = 2 * number(row, "stiffness")
    resistance = 1 / spots - SQUARE_LATTICE / (2 * math.sqrt(model.surface.eta))
    return spots / solved - 1, (1 / (resistance * solved) if resistance > 0 else math.nan) - 1


def conductance_table(rows: list[Row]) -> Sheet:
    """Mean over maps ± its standard error, by spectrum and load."""
    study = [row for row in rows if row["kind"] == "gaussian" and row["purpose"] == "study"]
    loads = sorted({number(row, "p") for row in study})
    lines = []
    for alpha in sorted({number(row, "x") for row in study}):
        groups = [[errors(row) for row in study if (row["x"], row["p"]) == (alpha, p)] for p in loads]
        for k, words in enumerate(("spots alone", "with neighbours")):
            cells = [_mean(np.array([pair[k] for pair in group])) for group in groups]
            lines.append([f"{alpha:g}", words, *cells])
    return table(["α", "conductance", *(load(p) for p in loads)], lines)


def _mean(values: np.ndarray) -> str:
    if values.size < 2:
        return ""
    return percent(float(values.mean()), float(values.std(ddof=1)) / math.sqrt(values.size))


if __name__ == "__main__":
    from solve_table import read

    print(conductance_table(read()), end="")
