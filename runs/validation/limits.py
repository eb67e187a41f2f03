"""Rows of the condensed table for lighter loads than any that was solved, by what contact tends to there.

Separate caps become Hertz's single contacts, which their model has. Gaussian surfaces tend to the limit of
Bush, Gibson and Thomas (1975, Wear 35, 87), as summits with radii of their own do: where alpha is at most
`CONVERGED` these are within 7 % of it at the lightest load solved, and off boundary elements by no more than
eight maps tell. The right answer is taken to be off that model by half of what it is there, and unsure by as
much; these rows have no maps, and their deviations are that uncertainty.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

from deviations import Condensed
from models import Model, summits_of

CONVERGED = 5.0  # alpha: of broader spectra the error still grows where loads become lighter
LIGHTER = (1e-8, 1e-6)  # p/(E* g)
LIGHTER_CAPS = (1e-6, 1e-3)  # of the lightest load solved
SIDE = 1e-5  # m0; any


def limits(lines: list[Condensed]) -> Iterator[Condensed]:
    """In the order of the table."""
    lightest: dict[tuple[str, str, str, float], Condensed] = {}
    for line in sorted(lines, key=lambda line: -line.p):
        lightest[line.map, line.model, line.interaction, line.x] = line
    for line in lightest.values():
        if line.map == "caps":
            yield from (_halved(line, share * line.p) for share in LIGHTER_CAPS)
        elif line.x <= CONVERGED:
            right = lightest[line.map, "own radii", "none", line.x]
            yield from (_beside(line, right, p) for p in LIGHTER)


def _halved(line: Condensed, p: float) -> Condensed:
    half = {name: value / 2 for name, value in line.mean.items()}
    steep = line.std["load"] / (1 + line.mean["load"]) / line.std["separation"]
    std = {name: abs(value) for name, value in half.items()}
    std["load"] = std["separation"] * steep * (1 + half["load"])
    return replace(line, p=p, mean=half, std=std, maps=0)


def _beside(line: Condensed, right: Condensed, p: float) -> Condensed:
    """A model beside the one that has the limit."""
    moments = SIDE, 0.5, line.x / 4 / SIDE
    summits, own, unit = summits_of(line.model, *moments), summits_of("own radii", *moments), math.sqrt(SIDE)
    model = Model(summits, line.interaction)
    x, at = summits.separation(p), own.separation(p)
    found, known = summits.at(x), own.at(at)
    half = {name: value / 2 for name, value in right.mean.items()}
    gap = at - half["separation"] * unit
    mean = {
        "area": found.area / known.area * (1 + half["area"]) - 1,
        "stiffness": model.stiffness(x) / known.stiffness * (1 + half["stiffness"]) - 1,
        "separation": (model.gap(x) - gap) / unit,
        "load": model.load_at(gap) / p - 1,
    }
    std = {name: abs(half[name]) * (1 + mean[name]) for name in ("area", "stiffness")}
    std["separation"] = abs(half["separation"])
    std["load"] = std["separation"] * known.stiffness * unit / p * (1 + mean["load"])
    return replace(line, p=p, mean=mean, std=std, maps=0)
