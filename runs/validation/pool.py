"""Repetitions of `mcgw.elastic` with few solves: how often its intervals hold; its error against its time.

    python runs/validation/pool.py                # from the stored solves: a table and levels.png
    python runs/validation/pool.py --solve 1700   # solve the maps up to this number first (Tamaas); resumes

`pool.csv` holds boundary elements of small maps, 16 and 32 shortest waves wide, under p/(E* g) = 0.01; what
summits say of them is found anew. Repetitions draw each of their maps from it, with replacement: so their
true mean is that of the stored maps, without an error. The standard error of that as a mean of all such maps
is printed, too.
"""

import argparse
import csv
import math
from pathlib import Path
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import SpectralMoments
from mcgw.elasticity.elastic import _by_levels
from mcgw.elasticity.levels import LEVELS, Pressed
from mcgw.elasticity.multilevel import difference, terms_of
from mcgw.elasticity.sources import Maps
from mcgw.figures.style import HOMOGENEOUS, MONTE_CARLO, STYLE, THEORY, save_figure
from mcgw.maps.synthetic import Spectrum, gaussian_map

HERE = Path(__file__).parent
FILE, PICTURE = HERE / "pool.csv", HERE / "levels.png"
NAMES, SHOWN = ("area", "stiffness", "mean_gap"), ("stiffness", "mean_gap", "area")
TICKS = {"x": [0.2, 0.5, 1, 2, 5, 10, 20, 50], "y": [1, 2, 5, 10, 20]}
WAVES = {5: 16, 20: 32}  # by alpha, across a map
LOAD, SEED = 0.01, 1  # p/(E* g); of the maps
REPEATED, PILOT, FEW, SOLVES = 300, 8, 8, (4, 8, 16, 32, 64)
MOST = 100_000  # maps a repetition
CHAINS = {
    "boundary elements": ((2,), "o", "-", HOMOGENEOUS),
    "two levels": ((0, 2), "s", "--", THEORY),
    "three levels": ((0, 1, 2), "^", ":", MONTE_CARLO),
}


def maps_of(alpha):
    """Gaussian maps of this alpha, m0 = m2 = 1, eight points a shortest wave."""
    spectrum = Spectrum.with_moments(SpectralMoments(1.0, 1.0, float(alpha)))
    points, side = 8 * WAVES[alpha], WAVES[alpha] * spectrum.short
    shape, pixel = (points, points), (side / points, side / points)
    return Maps(
        lambda k, seed: gaussian_map(spectrum, shape, pixel, np.random.default_rng([seed, k])).heights,
        (side, side),
        f"alpha = {alpha}",
    )


def pressed(maps, number):
    """One of them under the load, E* = 1."""
    return Pressed(maps.heights(number, SEED), maps.size, 1.0, LOAD * math.sqrt(2))


def rows():
    """Of the file."""
    if not FILE.exists():
        return []
    with open(FILE, encoding="utf-8") as file:
        found = list(csv.DictReader(file))
    whole = ("alpha", "map")
    return [{name: int(v) if name in whole else float(v) for name, v in row.items()} for row in found]


def solve(many):
    """Write what boundary elements say of maps that are not in the file."""
    done = {(row["alpha"], row["map"]) for row in rows()}
    with open(FILE, "a", encoding="utf-8", buffering=1) as file:
        if not file.tell():
            file.write(f"alpha,map,{','.join(NAMES)},seconds\n")
        for alpha in WAVES:
            maps = maps_of(alpha)
            for number in range(many):
                if (alpha, number) not in done:
                    values, seconds = LEVELS[-1].timed(pressed(maps, number))
                    found = ",".join(f"{values[name]:.6g}" for name in NAMES)
                    file.write(f"{alpha},{number},{found},{seconds:.2g}\n")


def table_of(alpha):
    """Values of the maps, shape (maps, levels, quantities), and CPU seconds of one at each level."""
    maps, known = maps_of(alpha), [row for row in rows() if row["alpha"] == alpha]
    summits = [
        [level.timed(one) for level in LEVELS[:2]] for one in (pressed(maps, row["map"]) for row in known)
    ]
    found = [
        [*([one[name] for name in NAMES] for one, _ in levels), [row[name] for name in NAMES]]
        for levels, row in zip(summits, known, strict=True)
    ]
    seconds = [[one for _, one in row] for row in summits]
    return np.array(found), [
        *np.mean(seconds, axis=0).tolist(),
        float(np.mean([row["seconds"] for row in known])),
    ]


class Stored:
    """Stands in for what `mcgw.elastic` solves: a map that it asks for is any of those that are stored."""

    maps, seed, quantities, seconds = SimpleNamespace(number=None, words="stored maps"), 0, NAMES, 0.0

    def __init__(self, table, costs, rng):
        self.table, self.costs = table, np.array(costs)
        self.rows = rng.integers(len(table), size=MOST)

    def at(self, levels, number):
        """Values of a map at levels, and their seconds."""
        which = [LEVELS.index(level) for level in levels]
        return self.table[self.rows[number], which], self.costs[which]


def repeated(alpha):
    """Print how often the intervals hold; by quantity and chain seconds and errors."""
    table, costs = table_of(alpha)
    many, truth = len(table), table[:, 2].mean(axis=0)
    found = [
        _by_levels(Stored(table, costs, np.random.default_rng([alpha, k])), 0.05, FEW, PILOT, lambda *_: None)
        for k in range(REPEATED)
    ]
    low, high = np.array([one.found.interval() for one in found]).transpose(1, 0, 2)
    held = ((low <= truth) & (truth <= high)).sum(axis=0)
    stderr = table[:, 2].std(axis=0, ddof=1) / math.sqrt(many)
    alone = np.abs(table[:, 1].mean(axis=0) / truth - 1)
    missed = ((low <= table[:, 1].mean(axis=0)) & (table[:, 1].mean(axis=0) <= high)).sum(axis=0)
    used = [tuple(one.planned.chain) for one in found]
    print(f"alpha = {alpha}: {many} maps of {8 * WAVES[alpha]}^2, seconds a level {np.round(costs, 4)}")
    print("  levels used:", {chain: used.count(chain) for chain in sorted(set(used))})
    for q, name in enumerate(NAMES):
        half = np.median(high[:, q] - low[:, q]) / 2
        print(
            f"  {name:9} {held[q]} of {REPEATED} intervals hold the mean of the maps; half of one is "
            f"{half / truth[q]:.1%}, {half / stderr[q]:.0f} standard errors of that mean; "
            f"{missed[q]} hold that of located summits, which is {alone[q]:.1%} off",
            flush=True,
        )
    errors = {
        (name, label): _errors(table, costs, chain, NAMES.index(name))
        for name in SHOWN
        for label, (chain, *_) in CHAINS.items()
    }
    for name in SHOWN:
        worth = [float(np.mean(t * e**2)) for t, e in (errors[name, label] for label in CHAINS)]
        words = ", ".join(f"{label} {worth[0] / w:.1f}" for label, w in zip(CHAINS, worth, strict=True))
        print(f"  times less than plainly for the {name}: {words}")
    return errors


def _errors(table, costs, chain, q):
    """Seconds, and 1.96 rms errors of a quantity over its mean, for each number of solves."""
    rng, truth, terms = np.random.default_rng(1), table[:, 2, q].mean(), terms_of(chain)
    prices = [sum(costs[i] for i in term) for term in terms]
    samples = [difference(table[:, term])[:, q] / truth for term in terms]
    shares = [math.sqrt(x.var() / price) for x, price in zip(samples, prices, strict=True)]
    found = []
    for solves in SOLVES:
        maps = [max(round(solves * share / shares[-1]), 4) for share in shares]
        drawn = [rng.integers(len(samples[0]), size=(10 * REPEATED, n)) for n in maps]
        off = sum(x[rows].mean(axis=1) for x, rows in zip(samples, drawn, strict=True)) - 1
        seconds = sum(n * price for n, price in zip(maps, prices, strict=True))
        found.append([seconds, 1.96 * math.sqrt(float(np.mean(off**2)))])
    return np.array(found).T


def picture(found):
    """Error against time of each chain: a row for each quantity, a column for each alpha."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.4, 7.4), layout="constrained")
        axes = figure.subplots(len(SHOWN), len(found), sharex="col", sharey="row")
        for column, (alpha, lines) in zip(axes.T, found.items(), strict=True):
            for ax, name in zip(column, SHOWN, strict=True):
                for label, (_, marker, dash, colour) in CHAINS.items():
                    seconds, error = lines[name, label]
                    ax.loglog(seconds, 100 * error, marker=marker, ls=dash, color=colour, ms=5, label=label)
                ax.set_title(f"{name.replace('_', ' ')}, α = {alpha}")
            column[-1].set_xlabel("CPU time (s)")
        for ax in axes[:, 0]:
            ax.set_ylabel("95 % error of the mean (%)")
        for ax in axes.flat:
            ends = ax.get_xlim(), ax.get_ylim()
            ax.set_xticks(TICKS["x"], [f"{x:g}" for x in TICKS["x"]])
            ax.set_yticks(TICKS["y"], [f"{y:g}" for y in TICKS["y"]])
            ax.minorticks_off()
            ax.set(xlim=ends[0], ylim=ends[1])
        axes[0, 0].legend()
        save_figure(figure, PICTURE)


def main():
    """Solve what is asked for, or repeat what can be."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--solve", type=int, default=0, metavar="N")
    if many := parser.parse_args().solve:
        solve(many)
    picture({alpha: repeated(alpha) for alpha in WAVES})


if __name__ == "__main__":
    main()
