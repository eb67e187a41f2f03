"""Speed of the samplers, as ratios to what a user would write instead.

Everything is timed side by side in one process, in turn, after a warm-up; a ratio is the median over
the rounds of the ratios of one round, and its range. Scene S1: N asperities, gamma = 2, separations
0 ... 4, load, area, stiffness and contacts. Run: ``python runs/bench/samplers.py [--rounds 7]``.
"""

import numpy as np
from numba import njit, prange
from scenes import S1, block, script
from timing import Job, against, job, parser_of, show, timed

from mcgw.sampling.philox import centred


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


def one_million() -> dict[str, Job]:
    """The samplers of real surfaces, and what else there is."""
    h = np.array(S1.separations)
    return {
        "cells": block(S1),
        "NumPy script": script(),
        "plain numba loop, all cores": job(lambda: numba_loop(1, 10**6, h, 4), 4),
        "Philox alone, the same uniforms": job(lambda: philox_alone(500_000, 64), 64),
        "tail": block(S1.replace(sampler="tail")),
    }


def ten_thousand() -> dict[str, Job]:
    """Small surfaces."""
    return {
        "cells, N = 1e4": block(S1.replace(n_asperities=10**4)),
        "NumPy script, N = 1e4": script(10**4),
    }


def separations() -> dict[str, Job]:
    """More of them, or higher ones."""
    return {
        "h = 0 ... 4, 41 separations": block(S1),
        "h = 0 ... 4, 401 separations": block(S1.replace(separations=tuple(np.linspace(0, 4, 401)))),
        "h = 2 ... 4, 41 separations": block(S1.replace(separations=tuple(np.linspace(2, 4, 41)))),
    }


def aggregates() -> dict[str, Job]:
    """Any number of asperities, and a small surface by the script."""
    scenes = {
        f"aggregate, N = 1e{k}": S1.replace(sampler="aggregate", n_asperities=10**k)
        for k in (8, 4, 6, 10, 12, 15)
    }
    return {name: block(scene) for name, scene in scenes.items()} | {"NumPy script, N = 1e4": script(10**4)}


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a surface, to those of the peer named last: lower is better."""
    large = timed(one_million(), rounds)
    peers = "NumPy script", "plain numba loop, all cores", "Philox alone, the same uniforms"
    found = {name: value for peer in peers for name, value in against(large, peer, ["cells"]).items()}
    found |= against(large, "NumPy script", ["tail"])
    found |= against(timed(ten_thousand(), rounds), "NumPy script, N = 1e4", ["cells, N = 1e4"])
    first, *others = separations()
    found |= against(timed(separations(), rounds), first, others)
    small, large_one = "aggregate, N = 1e4", "aggregate, N = 1e15"
    return found | against(timed(aggregates(), rounds), "NumPy script, N = 1e4", [small, large_one])


def main() -> None:
    """Print every ratio."""
    rounds = parser_of(__doc__).parse_args().rounds
    show("N = 1e6, 41 separations", timed(one_million(), rounds), "cells")
    show("N = 1e4", timed(ten_thousand(), rounds), "cells, N = 1e4")
    show("separations (N = 1e6)", timed(separations(), rounds), "h = 0 ... 4, 41 separations")
    show("aggregate", timed(aggregates(), rounds), "aggregate, N = 1e8")


if __name__ == "__main__":
    main()
