"""Time of one value of `analytic.fn` on arrays, against scipy.integrate.quad of the definition.

Run from the repository root: ``python -m runs.bench.bench_analytic`` or with the package installed.
Medians over repetitions, after a warm-up, both in the same run.
"""

import math
from collections.abc import Callable
from statistics import median
from time import perf_counter_ns

import numpy as np
from scipy.integrate import quad

import analytic

N = 1.5
GAMMA = 2.0
H = np.random.default_rng(1).uniform(-2, 6, 20_000)  # where surfaces are in contact
REPEATS = 7
QUAD_VALUES = 100


def exponential(s: float) -> float:
    """E*(s)/E* of Eq. (4), one height at a time."""
    return GAMMA - (GAMMA - 1) * math.exp(-s)


def by_quad(h: float, grading: Callable[[float], float] | None) -> float:
    """F*_n as one would write it down: adaptive quadrature of the definition with default tolerances."""
    factor = 1 / math.sqrt(2 * math.pi)
    if grading is None:
        return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * factor, h, math.inf)[0]
    return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * grading(s) * factor, h, math.inf)[0]


def median_ns(work: Callable[[], object], values: int) -> float:
    """Median time per value, ns."""
    work()
    times = []
    for _ in range(REPEATS):
        start = perf_counter_ns()
        work()
        times.append((perf_counter_ns() - start) / values)
    return median(times)


def main() -> None:
    """Print the table."""
    cases: dict[str, tuple[analytic.Grading | None, Callable[[float], float] | None]] = {
        "homogeneous": (None, None),
        "exponential": (analytic.Exponential(GAMMA), exponential),
        "custom": (analytic.Custom(lambda s: GAMMA - (GAMMA - 1) * np.exp(-s)), exponential),
    }
    few = H[:QUAD_VALUES].tolist()
    print(f"{'grading':<12} {'fn, ns':>9} {'quad, ns':>10} {'ratio':>7} {'quad error':>11}")
    for name, (grading, scalar) in cases.items():
        fast = median_ns(lambda grading=grading: analytic.fn(N, H, grading), H.size)
        slow = median_ns(lambda scalar=scalar: [by_quad(h, scalar) for h in few], len(few))
        wrong = np.abs(np.array([by_quad(h, scalar) for h in few]) / analytic.fn(N, few, grading) - 1).max()
        print(f"{name:<12} {fast:>9.0f} {slow:>10.0f} {slow / fast:>7.0f} {wrong:>11.1e}")


if __name__ == "__main__":
    main()
