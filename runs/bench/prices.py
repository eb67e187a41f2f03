"""What a cell costs: the prices by which `mcgw.sampling.spacing` cuts the heights.

Run: ``python runs/bench/prices.py [--short]``. Prints, beside the price in use, what is measured here on one
core, in asperities that give ten moments: medians over rounds, all sizes in turn. With ``--short``, what is
paid where less than the last digit is asked (`mcgw.sampling.short_prices`): for each number of bits, and
below them the numbers of which these prices are made.
"""

import numpy as np
from timing import Job, job, parser_of, timed

from mcgw.ensemble.drawing import use_threads
from mcgw.sampling import short_prices, spacing
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.short_sums import short_moments

SURFACES, CELLS, MANY, FEW = 64, 20, 4000, 16
ORDERS = [(10, 0), (12, 0), (15, 0), (20, 0), (10, 6), (10, 11), (10, 16)]
BITS = (32, 16, 8)


def cell(asperities: int, plain: int, rooted: int, bits: int | None = None) -> Job:
    """Drawing one cell of one surface, of short sums where bits are given."""
    layout = Layout(np.full(CELLS, plain), np.full(CELLS, rooted))
    counts, words = np.full((CELLS, SURFACES), asperities), np.full(CELLS, bits or 32)
    if bits is None:
        return job(lambda: cell_moments(1, 0, counts, layout), SURFACES * CELLS)
    return job(lambda: short_moments(1, 0, counts, layout, words), SURFACES * CELLS)


def long(rounds: int) -> None:
    """Sums to the last digit."""
    sizes = [(MANY, *orders) for orders in ORDERS] + [(FEW, 10, 0)]
    times = timed({str(size): cell(*size) for size in sizes}, rounds)
    *many, few = (np.median(column) for column in times.values())
    one = (many[0] - few) / (MANY - FEW)
    print(f"an asperity that gives ten moments: {1e9 * one:.3g} ns")
    print(f"{'a cell':>24} {spacing._CELL:8.2f} {few / one - FEW:8.2f}")
    for (plain, rooted), time in zip(ORDERS, many, strict=True):
        known = float(spacing.price(np.array(plain), np.array(rooted)))
        print(f"{plain:>12} T and {rooted:>2} R {known:8.2f} {(time - few + FEW * one) / one / MANY:8.2f}")


def short(rounds: int) -> None:
    """Sums to fewer digits, in asperities that give ten moments of 32-bit uniforms to the last."""
    sizes = [
        (plain, rooted, bits)
        for bits in BITS
        for plain in short_prices.PLAIN
        for rooted in short_prices.ROOTED
    ]
    jobs = {"last digit": cell(MANY, 10, 0), "few, last digit": cell(FEW, 10, 0), "few": cell(FEW, 8, 4, 16)}
    times = timed({**jobs, **{str(size): cell(MANY, *size) for size in sizes}}, rounds)
    long_one, long_few, few, *many = (np.median(column) for column in times.values())
    one = (long_one - long_few) / (MANY - FEW)
    found = (np.array(many) - few) / (MANY - FEW) / one
    print(f"{'a cell':>32} {short_prices._CELL:8.2f} {few / one:8.2f}")
    for (plain, rooted, bits), price in zip(sizes, found, strict=True):
        known = short_prices.of_bits(np.array(plain), np.array(rooted), np.array(bits))
        print(f"{bits:>8} bits, {plain:>2} T and {rooted:>2} R {float(known):8.2f} {price:8.2f}")
    table = found.reshape(len(BITS), len(short_prices.PLAIN), len(short_prices.ROOTED))
    words = table[:, 0, 0]
    print("words with five plain moments:", dict(zip(BITS, words.round(2).tolist(), strict=True)))
    print("more moments than these, over all bits:")
    print((table - words[:, None, None]).mean(axis=0).round(2))


def main() -> None:
    """Measure and print."""
    parser = parser_of(__doc__)
    parser.add_argument("--short", action="store_true", help="prices of sums to fewer digits")
    asked = parser.parse_args()
    with use_threads(1):
        (short if asked.short else long)(asked.rounds)


if __name__ == "__main__":
    main()
