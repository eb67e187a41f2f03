"""What a cell costs: the prices by which `mcgw.sampling.spacing` cuts the heights.

Run: ``python runs/bench/prices.py``. Prints, beside the price in use, what is measured here on one core, in
asperities that give ten moments: medians over rounds, all sizes in turn.
"""

import numpy as np
from timing import Job, job, parser_of, timed

from mcgw.machine.threads import use_threads
from mcgw.sampling import spacing
from mcgw.sampling.moments import Layout, OneByOne

SURFACES, CELLS, MANY, FEW = 64, 20, 4000, 16
ORDERS = [(10, 0), (12, 0), (15, 0), (20, 0), (10, 6), (10, 11), (10, 16)]


def cell(asperities: int, plain: int, rooted: int) -> Job:
    """Drawing one cell of one surface."""
    layout = Layout(np.full(CELLS, plain), np.full(CELLS, rooted))
    counts = np.full((CELLS, SURFACES), asperities)
    return job(lambda: OneByOne().moments(1, 0, counts, layout), SURFACES * CELLS)


def measure(rounds: int) -> None:
    """Print what is paid and what it costs."""
    sizes = [(MANY, *orders) for orders in ORDERS] + [(FEW, 10, 0)]
    times = timed({str(size): cell(*size) for size in sizes}, rounds)
    *many, few = (np.median(column) for column in times.values())
    one = (many[0] - few) / (MANY - FEW)
    print(f"an asperity that gives ten moments: {1e9 * one:.3g} ns")
    print(f"{'a cell':>24} {spacing._CELL:8.2f} {few / one - FEW:8.2f}")
    for (plain, rooted), time in zip(ORDERS, many, strict=True):
        known = float(spacing.price(np.array(plain), np.array(rooted)))
        print(f"{plain:>12} T and {rooted:>2} R {known:8.2f} {(time - few + FEW * one) / one / MANY:8.2f}")


def main() -> None:
    """Measure and print."""
    rounds = parser_of(__doc__).parse_args().rounds
    with use_threads(1):
        measure(rounds)


if __name__ == "__main__":
    main()
