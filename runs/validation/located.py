"""Summits at their places against boundary elements; and means by levels.

    python runs/validation/located.py            # on the maps of solves.csv; --alpha 50, --most-seconds 600
    python runs/validation/located.py --fresh    # on maps that nothing was tuned on, in located.csv
    python runs/validation/located.py --solve    # solve those first (Tamaas); resumes

For each spectrum and load: rms over maps of the error of own summits alone and located, correlations over
maps with boundary elements, and how many CPU seconds plain boundary elements take for 2 % of each mean, over
what levels take.
"""

import argparse
import csv
import math
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
from rough_maps import GaussianMap

from mcgw.elasticity.levels import LEVELS, Pressed
from mcgw.elasticity.multilevel import design, mean_of
from mcgw.errors import RunError

HERE = Path(__file__).parent
NAMES = ("area", "stiffness", "mean_gap")
REPEATED, FEW = 300, 4
FRESH = HERE / "located.csv"
ALPHAS, SEEDS, LOADS = (5, 10, 20, 36), range(8001, 8009), (1e-3, 1e-2, 5e-2)
HURST, WAVES = 0.8, 64


def fresh():
    """Maps of 512^2 points, and boundary elements of each load: values and seconds."""
    found = defaultdict(dict)
    with open(FRESH, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            alpha, values = float(row["alpha"]), [float(row[name]) for name in (*NAMES, "seconds", "m0")]
            surface = GaussianMap(HURST, int(alpha), int(row["seed"]), WAVES)
            found[alpha, HURST][surface, float(row["p"])] = values
    return found


def solve():
    """Write what boundary elements say of fresh maps that are not in the file."""
    done = {(int(m.alpha), m.seed, p) for maps in fresh().values() for m, p in maps} if FRESH.exists() else ()
    with open(FRESH, "a", encoding="utf-8", buffering=1) as file:
        if not file.tell():
            file.write(f"alpha,seed,p,{','.join(NAMES)},m0,seconds\n")
        for seed in SEEDS:
            for alpha in ALPHAS:
                heights = GaussianMap(HURST, alpha, seed, WAVES).heights()
                for p in LOADS:
                    if (alpha, seed, p) not in done:
                        values, seconds = LEVELS[-1].timed(Pressed(heights, (1.0, 1.0), 1.0, p))
                        found = ",".join(f"{values[name]:.8g}" for name in NAMES)
                        m0 = float((heights**2).mean())
                        file.write(f"{alpha},{seed},{p:g},{found},{m0:.8g},{seconds:.3g}\n")


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
    parser.add_argument("--alpha", type=float, help="of the maps; default: all")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--solve", action="store_true")
    asked = parser.parse_args()
    if asked.solve:
        solve()
    known = fresh() if asked.fresh or asked.solve else solves()
    most, begun, rng = asked.most_seconds, time.process_time(), np.random.default_rng(7)
    tried = failed = 0
    print(
        "alpha  H  p/(E* g)  maps | alone: area stiffness gap/rms | located | correlation | saved | covered"
    )
    for (alpha, hurst), all_solves in sorted(known.items()):
        if asked.alpha not in (None, alpha):
            continue
        loads = sorted({p for _, p in all_solves})
        kept = {}
        for p in loads:
            rows, costs = [], []
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
            if len(rows) < 3:
                continue
            x = np.array(rows).transpose(1, 0, 2)
            scale = np.where(np.arange(3) == 2, x[3], x[2])
            errors = [np.sqrt((((x[k] - x[2]) / scale) ** 2).mean(axis=0)) for k in (0, 1)]
            together = [np.corrcoef(x[1][:, q], x[2][:, q])[0, 1] for q in range(3)]
            seconds = np.mean(costs, axis=0)
            saved = []
            for q in range(3):
                planned = design(np.log(np.abs(x[:3, :, q : q + 1])).swapaxes(0, 1) + 30, seconds, 0.02 / 30)
                saved.append(planned.plain / planned.cost)
            texts = [" ".join(f"{v:+.3f}" for v in part) for part in (*errors, together)]
            texts.append(" ".join(f"{v:.1f}" for v in saved))
            texts.append(" ".join(f"{v:.2f}" for v in covered(x[:3], rng)) if len(rows) > FEW else "")
            print(
                f"{alpha:g}  {hurst:g}  {p:g}  {len(rows)} | {' | '.join(texts)} | {seconds.round(2)}",
                flush=True,
            )
    print(f"{tried - failed} of {tried} maps with summits")


if __name__ == "__main__":
    main()
