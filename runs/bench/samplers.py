"""Speed of the samplers, as ratios to what a user would write instead.

Everything is timed side by side in one process, in turn, after a warm-up; a ratio is the median over
the rounds of the ratios of one round, and its range. Scene S1: N asperities, gamma = 2, separations
0 ... 4, load, area, stiffness and contacts. Run: ``python runs/bench/samplers.py [--quick]``.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numba import njit, prange

import analytic
from mcgw.ensemble.simulation import at_a_time, block_size, drawn_blocks
from mcgw.sampling.philox import centred
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)
S1 = Scene(
    surface=SURFACE,
    separations=tuple(np.linspace(0, 4, 41)),
    grading=analytic.Exponential(2.0),
    n_asperities=10**6,
    seed=1,
    sampler="cells",
)


def numpy_script(n: int, separations: tuple[float, ...], surfaces: int) -> np.ndarray:
    """What a user writes first: all normals, then a vector expression for each separation."""
    rng = np.random.default_rng(1)
    result = np.empty((surfaces, len(separations), 4))
    for i in range(surfaces):
        s = rng.standard_normal(n)
        e = 2.0 - np.exp(-s)
        for k, h in enumerate(separations):
            d = np.maximum(s - h, 0.0)
            result[i, k] = (e * d**1.5).sum(), d.sum(), (e * d**0.5).sum(), (d > 0).sum()
    return result


@njit(parallel=True)
def numba_loop(seed: int, n: int, separations: np.ndarray, surfaces: int) -> np.ndarray:
    """What a user writes next: a loop over asperities and separations, on all cores."""
    result = np.zeros((surfaces, separations.size, 4))
    for i in prange(surfaces):
        np.random.seed(seed + i)
        for _ in range(n):
            s = np.random.standard_normal()
            e = 2.0 - np.exp(-s)
            for k in range(separations.size):
                d = s - separations[k]
                if d > 0:
                    root = np.sqrt(d)
                    result[i, k, 0] += d * root * e
                    result[i, k, 1] += d
                    result[i, k, 2] += root * e
                    result[i, k, 3] += 1
    return result


@njit(parallel=True)
def philox_alone(words: int, surfaces: int) -> float:
    """Only the uniforms that `cells` draws, on all cores."""
    total = 0.0
    for i in prange(surfaces):
        x = np.empty(512)
        for first in range(0, words, 512):
            centred(x, np.uint64(1), 0, i, 0, first, 512)
            total += x[0]
    return total


def per_surface(call: Callable[[], object], surfaces: int) -> float:
    """Seconds a surface."""
    start = time.perf_counter()
    call()
    return (time.perf_counter() - start) / surfaces


def compare(title: str, jobs: dict[str, tuple[Callable[[], object], int]], base: str, rounds: int) -> None:
    """Time the jobs in turn and print each one's ratio to the base job."""
    for call, _ in jobs.values():
        call()
    times = {name: [] for name in jobs}
    for _ in range(rounds):
        for name, (call, surfaces) in jobs.items():
            times[name].append(per_surface(call, surfaces))
    print(f"\n{title}")
    for name, values in times.items():
        ratio = np.array(values) / np.array(times[base])
        low, middle, high = np.quantile(ratio, [0, 0.5, 1])
        print(f"  {name:42} {np.median(values) * 1e6:12.1f} us   {middle:8.3g} x  ({low:.3g} ... {high:.3g})")


def block(scene: Scene) -> tuple[Callable[[], object], int]:
    """Blocks as a run would draw them, its mesh and response made beforehand."""
    sampler = sampler_of(scene)
    size = block_size(scene, sampler)
    surfaces = at_a_time(size)
    return (lambda: list(drawn_blocks(sampler, 0, surfaces, size))), surfaces


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="three rounds in place of seven")
    rounds = 3 if parser.parse_args().quick else 7
    h = np.array(S1.separations)

    compare(
        "N = 1e6, 41 separations",
        {
            "cells": block(S1),
            "NumPy script": (lambda: numpy_script(10**6, S1.separations, 1), 1),
            "plain numba loop, all cores": (lambda: numba_loop(1, 10**6, h, 4), 4),
            "Philox alone, the same uniforms": (lambda: philox_alone(500_000, 64), 64),
            "tail": block(replace(S1, sampler="tail")),
        },
        "cells",
        rounds,
    )
    small = replace(S1, n_asperities=10**4)
    compare(
        "N = 1e4, 2000 surfaces",
        {
            "cells": block(small),
            "NumPy script": (lambda: numpy_script(10**4, S1.separations, 20), 20),
        },
        "cells",
        rounds,
    )
    compare(
        "more separations, or higher ones (N = 1e6)",
        {
            "h = 0 ... 4, 41 separations": block(S1),
            "h = 0 ... 4, 401 separations": block(replace(S1, separations=tuple(np.linspace(0, 4, 401)))),
            "h = 2 ... 4, 41 separations": block(replace(S1, separations=tuple(np.linspace(2, 4, 41)))),
        },
        "h = 0 ... 4, 41 separations",
        rounds,
    )
    compare(
        "aggregate",
        {
            f"N = 1e{k}": block(replace(S1, sampler="aggregate", n_asperities=10**k))
            for k in (8, 4, 6, 10, 12, 15)
        },
        "N = 1e8",
        rounds,
    )


if __name__ == "__main__":
    main()
