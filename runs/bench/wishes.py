"""Whether what `mcgw.tradeoff` advises holds: ``python runs/bench/wishes.py [--seeds 20]``.

For five scenes and three wishes (a mean to 1e-3, the 99 % quantile to 1 %, values of surfaces to 1e-6): the
share of ensembles whose error is within what was wished, and their time over what was promised. Means are
held against theory, quantiles against twenty times as many surfaces, values against sums over heights.
"""

import argparse
from dataclasses import dataclass, replace
from math import ceil
from time import perf_counter

import numpy as np
from scenes import SURFACE

import mcgw
from mcgw.sampling.direct import asperity_sums
from mcgw.scene.scene import Scene
from mcgw.statistics.wishes import Advice, Wish, advise, ways_for

WISHES = (Wish("mean", 1e-3), Wish("quantile", 1e-2), Wish("surfaces", 1e-6))
_MORE = 20  # times as many surfaces, for a quantile that is known
_LISTED = 3  # surfaces of an ensemble whose heights are listed


def _scene(*separations: float, **changes: object) -> Scene:
    return Scene(SURFACE, separations=separations, quantities=("load", "area"), n_surfaces=200, **changes)


SCENES = {
    "graded": _scene(0.0, 1.0, grading=mcgw.Exponential(2.0), n_asperities=10**5),
    "few contacts": _scene(0.0, 1.5, n_asperities=5000),
    "ten million": _scene(0.5, n_asperities=10**7),
    "yielding": _scene(0.0, 1.0, law=mcgw.KogutEtsion(critical=0.1), n_asperities=10**4),
    "skew heights": _scene(0.5, 1.0, heights=mcgw.Weibull(1.5), n_asperities=20_000),
}


@dataclass(frozen=True)
class Kept:
    """What came of one advice: share of ensembles within the wish; median time over the promise."""

    scene: str
    advice: Advice
    kept: float
    time: float


def kept(seeds: int, share: float = 1.0, wishes: tuple[Wish, ...] = WISHES) -> list[Kept]:
    """Ensembles as advised, with that share of the surfaces, for each scene and wish."""
    found = []
    for name, scene in SCENES.items():
        ways = tuple(ways_for(scene))
        for advice in advise(scene, scene.separations[-1], ways, wishes):
            asked = replace(advice.scene, n_surfaces=ceil(share * advice.scene.n_surfaces))
            exact = _exact(advice)
            errors, times = zip(
                *(_drawn(replace(asked, seed=k), advice.wish, exact) for k in range(seeds)), strict=True
            )
            within = float(np.mean(np.array(errors) <= advice.wish.within))
            found.append(Kept(name, advice, within, float(np.median(times)) / advice.seconds))
    return found


def _exact(advice: Advice) -> float:
    """The mean by theory, or a quantile that is known better."""
    scene, h = advice.scene, advice.scene.separations[-1]
    if advice.wish.of == "quantile":
        many = replace(scene, n_surfaces=_MORE * scene.n_surfaces, seed=2**40, separations=(h,))
        return float(np.quantile(mcgw.simulate(many).load[:, 0], 0.99))
    return float(scene.theory.mean("load", h))


def _drawn(scene: Scene, wish: Wish, exact: float) -> tuple[float, float]:
    """Relative error and seconds of one ensemble."""
    start = perf_counter()
    ensemble = mcgw.simulate(scene)
    seconds = perf_counter() - start
    if wish.of == "surfaces":
        return max(_worst(ensemble, number) for number in range(_LISTED)), seconds
    load = ensemble.load[:, -1]
    value = load.mean() if wish.of == "mean" else np.quantile(load, 0.99)
    return abs(float(value) / exact - 1), seconds


def _worst(ensemble: mcgw.Ensemble, number: int) -> float:
    """Largest relative error of a value of one surface."""
    s = mcgw.heights(ensemble.scene, number)
    plain = asperity_sums(ensemble.scene, np.array([s.size]), s, np.ones(s.size))
    return max(float(np.abs(ensemble[name][number] / plain[name][0] - 1).max()) for name in plain)


def main() -> None:
    """Print a line for each advice."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seeds", type=int, default=20, help="ensembles for each scene and wish (default: 20)"
    )
    found = kept(parser.parse_args().seeds)
    print(f"{'scene':14} {'wish':38} {'run':34} {'kept':>6} {'time/promise':>13}")
    for one in found:
        asked = one.advice.scene
        run = f"{one.advice.sampler} {asked.accuracy:g} {asked.law_error:g}, {asked.n_surfaces}"
        print(f"{one.scene:14} {one.advice.wish.text:38} {run:34} {one.kept:6.0%} {one.time:13.2f}")
    print(
        f"kept: {np.mean([one.kept for one in found]):.1%}, time at most {max(x.time for x in found):.2f} x"
    )


if __name__ == "__main__":
    main()
