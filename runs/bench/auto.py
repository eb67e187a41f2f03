"""What `auto` chooses from: `tail` against `cells`, for few and many asperities and separations.

Medians of five rounds, in microseconds a surface. Run: ``python runs/bench/auto.py``.
"""

from dataclasses import replace

import numpy as np
from scenes import S1, block
from timing import timed

from mcgw.sampling.samplers import sampler_of


def main() -> None:
    """Print a line for each pair of numbers."""
    print("separations  contacts     tail    cells    auto takes")
    for separations in (1, 9, 41, 161, 401, 1601):
        h = tuple(np.linspace(0, 4, separations))
        for n in (3, 30, 100, 300, 1000):
            scene = replace(S1, n_asperities=n, separations=h)
            times = timed({name: block(replace(scene, sampler=name)) for name in ("tail", "cells")}, 5)
            tail, cells = (1e6 * np.median(times[name]) for name in ("tail", "cells"))
            taken = sampler_of(replace(scene, sampler="auto")).name
            mark = "" if taken == ("tail" if tail < cells else "cells") else "  (the other one is faster)"
            print(f"{separations:11} {n / 2:9.4g} {tail:8.1f} {cells:8.1f}    {taken}{mark}")


if __name__ == "__main__":
    main()
