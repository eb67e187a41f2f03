"""What crowds change in the laws of values, measured against what `law_error` promises; and what they buy.

Run: ``python runs/bench/law_error.py [--rounds 7]``. The same surfaces, with the same numbers in their cells,
are drawn with crowds and asperity by asperity: the distributions of their values differ by what the crowds
make of a cell, and the fluctuations that both share cancel. The largest difference is looked for at 49
quantiles of each value; a difference below five standard errors is not resolved, and printed in brackets.
"""

from dataclasses import replace

import numpy as np
from scenes import S1, block
from timing import Job, against, parser_of, show, timed

from mcgw.sampling.block import Sampler
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.crowding import crowding
from mcgw.sampling.samplers import aggregate_of
from mcgw.scene.scene import Scene

ASPERITIES, ASKED = (10**2, 10**3, 10**4, 10**6), (1e-1, 1e-3, 1e-4)
DRAWN, MOST, AT_ONCE = 10**10, 100_000, 2000  # asperities and surfaces of a line of the table
NOBODY = 2**60  # asperities in a cell: none is crowded
QUANTILES = np.linspace(0.02, 0.98, 49)
RESOLVED = 5.0  # standard errors


def values(sampler: Sampler, first: int) -> np.ndarray:
    """Of some surfaces: all quantities that are not counted, at all separations, beside each other."""
    sums = sampler.block(first, AT_ONCE).sums
    return np.concatenate([sums[name] for name in ("load", "area", "stiffness")], axis=1)


def distance(scene: Scene, threshold: int, surfaces: int) -> tuple[float, float]:
    """Largest difference of two distribution functions, and its standard error."""
    crowds, alone = aggregate_of(scene, threshold), aggregate_of(scene, NOBODY)
    marks = np.quantile(values(alone, 0), QUANTILES, axis=0)
    total, squares = np.zeros(marks.shape), np.zeros(marks.shape)
    for first in range(0, surfaces, AT_ONCE):
        one, other = values(crowds, first), values(alone, first)
        for k, mark in enumerate(marks):
            apart = (one <= mark).astype(np.int64) - (other <= mark)
            total[k] += apart.sum(axis=0)
            squares[k] += np.abs(apart).sum(axis=0)
    largest = np.unravel_index(np.abs(total).argmax(), total.shape)
    return float(np.abs(total[largest])) / surfaces, float(np.sqrt(squares.max())) / surfaces


def table() -> None:
    """A line for each number of asperities and each law error."""
    print(f"{'N':>8} {'asked':>8} {'crowd':>8} {'promised':>9} {'measured':>10} {'known to':>9}")
    for n in ASPERITIES:
        for asked in ASKED:
            scene = replace(S1, n_asperities=n, separations=tuple(np.linspace(0, 4, 9)), law_error=asked)
            found = crowding(scene, mesh_of(scene, split=False))
            if found is None or found.distance < 1e-9:  # no cell is crowded
                continue
            seen, error = distance(scene, found.threshold, min(MOST, DRAWN // n))
            text = f"{seen:.2g}" if seen > RESOLVED * error else f"({seen:.2g})"
            mark = "  more than promised" if seen > found.distance + RESOLVED * error else ""
            line = f"{found.threshold:8} {found.distance:9.2g} {text:>10} {error:9.2g}{mark}"
            print(f"{n:8.0e} {asked:8.0e} {line}", flush=True)


def crowds() -> dict[str, Job]:
    """A hundred million asperities with crowds and without."""
    scene = replace(S1, sampler="auto", n_asperities=10**8)
    return {"law_error 1e-4, N = 1e8": block(replace(scene, law_error=1e-4)), "cells, N = 1e8": block(scene)}


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a surface with crowds, to those without: lower is better."""
    return against(timed(crowds(), rounds), "cells, N = 1e8")


def main() -> None:
    """Print the table, then the times."""
    rounds = parser_of(__doc__).parse_args().rounds
    table()
    show("N = 1e8, 41 separations", timed(crowds(), rounds), "law_error 1e-4, N = 1e8")


if __name__ == "__main__":
    main()
