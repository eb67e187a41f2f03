"""What `auto` chooses from: `tail` against `cells`, for few and many asperities and separations.

Medians of five blocks, one after the other, in microseconds a surface. Run: ``python runs/bench/auto.py``.
"""

import time
from dataclasses import replace

import numpy as np
from samplers import S1

from mcgw.ensemble.simulation import at_a_time, block_size, drawn_blocks
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene


def microseconds(scene: Scene) -> float:
    """Time a surface, the mesh and the response made beforehand."""
    sampler = sampler_of(scene)
    size, times = min(block_size(scene, sampler), 2048), []
    n = at_a_time(size)
    for _ in range(6):
        start = time.perf_counter()
        list(drawn_blocks(sampler, 0, n, size))
        times.append(time.perf_counter() - start)
    return float(np.median(times[1:])) / n * 1e6


def main() -> None:
    """Print a line for each pair of numbers."""
    print("separations  contacts     tail    cells    auto takes")
    for separations in (1, 9, 41, 161, 401, 1601):
        h = tuple(np.linspace(0, 4, separations))
        for n in (3, 30, 100, 300, 1000):
            scene = replace(S1, n_asperities=n, separations=h)
            tail, cells = (microseconds(replace(scene, sampler=name)) for name in ("tail", "cells"))
            taken = sampler_of(replace(scene, sampler="auto")).name
            mark = "" if taken == ("tail" if tail < cells else "cells") else "  (the other one is faster)"
            print(f"{separations:11} {n / 2:9.4g} {tail:8.1f} {cells:8.1f}    {taken}{mark}")


if __name__ == "__main__":
    main()
