"""Time of one value of `analytic.fn` on arrays, against scipy.integrate.quad of the definition.

Run from the repository root: ``python -m runs.bench.bench_analytic``.
Medians over repetitions, after a warm-up, both in the same run.
"""

import math
import warnings
from collections.abc import Callable
from functools import partial
from statistics import median
from time import perf_counter_ns

import numpy as np
from scipy.integrate import IntegrationWarning, quad

import analytic

N = 1.5
GAMMA = 2.0
H = np.random.default_rng(1).uniform(-2, 6, 20_000)  # where surfaces are in contact
REPEATS = 7
QUAD_VALUES = 100


def exponential(s: float) -> float:
    """E*(s)/E* of Eq. (4), one height at a time."""
    return GAMMA - (GAMMA - 1) * math.exp(-s)


def by_quad(h: float, grading: Callable[[float], float] | None, options: dict[str, float]) -> float:
    """F*_n as one would write it down: adaptive quadrature of the definition."""
    factor = 1 / math.sqrt(2 * math.pi)
    if grading is None:
        return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * factor, h, math.inf, **options)[0]
    return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * grading(s) * factor, h, math.inf, **options)[
        0
    ]


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
    tolerances: dict[str, dict[str, float]] = {
        "quad as it comes": {},
        "quad to 1e-12": {"epsabs": 0, "epsrel": 1e-12, "limit": 200},
    }
    few = H[:QUAD_VALUES].tolist()
    print(f"{'grading':<12} {'fn, ns':>8}   {'against':<17} {'ns':>8} {'ratio':>6} {'its error':>10}")
    for name, (grading, scalar) in cases.items():
        fast = median_ns(lambda grading=grading: analytic.fn(N, H, grading), H.size)
        exact = analytic.fn(N, few, grading)
        for label, options in tolerances.items():
            work = partial(list_by_quad, few, scalar, options)
            slow = median_ns(work, len(few))
            wrong = np.abs(work() / exact - 1).max()
            print(f"{name:<12} {fast:>8.0f}   {label:<17} {slow:>8.0f} {slow / fast:>6.0f} {wrong:>10.1e}")


def list_by_quad(
    separations: list[float], grading: Callable[[float], float] | None, options: dict[str, float]
) -> np.ndarray:
    """One value after another; that quad cannot reach the tolerance is no news here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)
        return np.array([by_quad(h, grading, options) for h in separations])


if __name__ == "__main__":
    main()
