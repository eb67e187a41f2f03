"""Summits at their places against boundary elements, on the maps of `solves.csv`; and means by levels.

    python runs/validation/located.py [--most-seconds 600]

For each spectrum and load: rms over maps of the error of own summits alone and located, correlations over
maps with boundary elements, and how many CPU seconds plain boundary elements take for 2 % of each mean, over
what levels take. Last, how far the surface falls from its summits to the rims of their spots, over what
paraboloids do. Nothing of the model was fitted to these solves.
"""

import argparse
import csv
import math
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
from rough_maps import GaussianMap
from scipy.ndimage import map_coordinates

from mcgw.elasticity.levels import LEVELS, Pressed
from mcgw.elasticity.multilevel import design, mean_of
from mcgw.errors import RunError

HERE = Path(__file__).parent
NAMES = ("area", "stiffness", "mean_gap")
REPEATED, FEW = 300, 4


def solves():
    """Maps of each spectrum, and boundary elements of each load: values and seconds."""
    found = defaultdict(dict)
    with open(HERE / "solves.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["kind"] == "gaussian" and row["purpose"] in ("study", "fresh"):
                alpha, hurst, seed = float(row["x"]), float(row["hurst"]), int(row["seed"])
                surface = GaussianMap(hurst, int(alpha), seed, int(row["waves"]), int(row["pixels"]))
                values = [float(row[name]) for name in ("area", "stiffness", "gap", "seconds", "m0")]
                found[alpha, hurst][surface, float(row["p"])] = values
    return found


def flatter(pressed):
    """How far the surface falls to the rims of its located spots, over what paraboloids do; by load."""
    summits = pressed.summits
    delta = np.maximum(summits.at_load(pressed.load).penetrations, 0)
    on = delta > 0
    radii, load = summits.spots.radii[on], summits.spots.load(delta)[on]
    angle, rim = np.arange(16) * math.pi / 8, np.sqrt(radii * delta[on]) * len(pressed.heights)
    ring = [
        x[:, None] + rim[:, None] * f(angle)
        for x, f in zip(summits.places[:, on], (np.sin, np.cos), strict=True)
    ]
    fall = summits.spots.heights[on] - map_coordinates(pressed.heights, ring, order=3, mode="grid-wrap").mean(
        axis=1
    )
    return float((fall * load).sum() / (delta[on] / 2 * load).sum())


def covered(values, rng):
    """Share of 95 % intervals by levels, from few maps of these, that hold the mean of all of them."""
    n, hits = len(values[2]), 0
    truth = values[2].mean(axis=0)
    for _ in range(REPEATED):
        samples = [values[1], (values[2] - values[1])[rng.permutation(n)[:FEW]]]
        low, high = mean_of(samples, n).interval()
        hits += (low <= truth) & (truth <= high)
    return hits / REPEATED


def main():
    """Print a row for each spectrum and load."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--most-seconds", type=float, default=600.0)
    most, begun, rng = parser.parse_args().most_seconds, time.process_time(), np.random.default_rng(7)
    tried = failed = 0
    print(
        "alpha  H  p/(E* g)  maps | alone: area stiffness gap/rms | located | correlation | saved | covered"
        " | falls"
    )
    for (alpha, hurst), all_solves in sorted(solves().items()):
        loads = sorted({p for _, p in all_solves})
        kept = {}
        for p in loads:
            rows, costs, falls = [], [], []
            for (surface, load), bem in all_solves.items():
                if load != p or time.process_time() - begun > most:
                    continue
                heights = kept.setdefault(surface, surface.heights())
                pressed = Pressed(heights, (1.0, 1.0), 1.0, p)
                tried += 1
                try:
                    (a, one), (b, two) = (level.timed(pressed) for level in LEVELS[:2])
                except RunError as error:
                    failed += 1
                    print(f"  {surface.name} p = {p:g}: {error}")
                    continue
                rms = math.sqrt(bem[4])
                rows.append([[a[k] for k in NAMES], [b[k] for k in NAMES], bem[:3], [rms] * 3])
                costs.append((one, two, bem[3]))
                falls.append(flatter(pressed))
            if len(rows) < 3:
                continue
            x = np.array(rows).transpose(1, 0, 2)
            scale = np.where(np.arange(3) == 2, x[3], x[2])
            errors = [np.sqrt((((x[k] - x[2]) / scale) ** 2).mean(axis=0)) for k in (0, 1)]
            together = [np.corrcoef(x[1][:, q], x[2][:, q])[0, 1] for q in range(3)]
            seconds = np.mean(costs, axis=0)
            saved = []
            for q in range(3):
                table = {level: np.log(np.abs(x[level][:, q : q + 1])) + 30 for level in range(3)}
                planned = design(table, seconds, 0.02 / 30)
                saved.append(planned.plain / planned.seconds)
            texts = [" ".join(f"{v:+.3f}" for v in part) for part in (*errors, together)]
            texts.append(" ".join(f"{v:.1f}" for v in saved))
            texts.append(" ".join(f"{v:.2f}" for v in covered(x[:3], rng)) if len(rows) > FEW else "")
            texts.append(f"{np.mean(falls):.2f}")
            print(
                f"{alpha:g}  {hurst:g}  {p:g}  {len(rows)} | {' | '.join(texts)} | {seconds.round(2)}",
                flush=True,
            )
    print(f"{tried - failed} of {tried} balances found")


if __name__ == "__main__":
    main()
