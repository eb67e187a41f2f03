"""Time of one value of `analytic.fn` on arrays, against scipy.integrate.quad of the definition.

Run: ``python runs/bench/bench_analytic.py [--rounds 7]``. Medians over rounds, all in the same run.
"""

import math
import warnings
from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.integrate import IntegrationWarning, quad
from timing import Job, against, job, parser_of, ratio, timed

import analytic

N = 1.5
GAMMA = 2.0
H = np.random.default_rng(1).uniform(-2, 6, 20_000)  # where surfaces are in contact
FEW = H[:100].tolist()


def exponential(s: float) -> float:
    """E*(s)/E* of Eq. (4), one height at a time."""
    return GAMMA - (GAMMA - 1) * math.exp(-s)


GRADINGS: dict[str, tuple[analytic.Grading | None, Callable[[float], float] | None]] = {
    "homogeneous": (None, None),
    "exponential": (analytic.Exponential(GAMMA), exponential),
    "custom": (analytic.Custom(lambda s: GAMMA - (GAMMA - 1) * np.exp(-s)), exponential),
}
TOLERANCES: dict[str, dict[str, float]] = {
    "quad as it comes": {},
    "quad to 1e-12": {"epsabs": 0, "epsrel": 1e-12, "limit": 200},
}


def by_quad(h: float, grading: Callable[[float], float] | None, options: dict[str, float]) -> float:
    """F*_n as one would write it down: adaptive quadrature of the definition."""
    factor = 1 / math.sqrt(2 * math.pi)
    if grading is None:
        return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * factor, h, math.inf, **options)[0]
    return quad(lambda s: (s - h) ** N * math.exp(-s * s / 2) * grading(s) * factor, h, math.inf, **options)[
        0
    ]


def list_by_quad(
    separations: list[float], grading: Callable[[float], float] | None, options: dict[str, float]
) -> np.ndarray:
    """One value after another; that quad cannot reach the tolerance is no news here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)
        return np.array([by_quad(h, grading, options) for h in separations])


def jobs(name: str) -> dict[str, Job]:
    """Seconds a value of one grading, by `fn` and by each peer."""
    grading, scalar = GRADINGS[name]
    peers = {
        f"{label}, {name}": job(partial(list_by_quad, FEW, scalar, options), len(FEW))
        for label, options in TOLERANCES.items()
    }
    return {f"fn, {name}": job(lambda: analytic.fn(N, H, grading), H.size)} | peers


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a value, to those of quad: lower is better."""
    found: dict[str, float] = {}
    for name in GRADINGS:
        ours, *peers = jobs(name)
        times = timed(jobs(name), rounds)
        for peer in peers:
            found |= against(times, peer, [ours])
    return found


def main() -> None:
    """Print the table."""
    rounds = parser_of(__doc__).parse_args().rounds
    print(f"{'grading':<12} {'fn, ns':>8}   {'against':<17} {'ns':>8} {'ratio':>6} {'its error':>10}")
    for name, (grading, scalar) in GRADINGS.items():
        times = timed(jobs(name), rounds)
        exact = analytic.fn(N, FEW, grading)
        fast = 1e9 * np.median(times[f"fn, {name}"])
        for label, options in TOLERANCES.items():
            peer = f"{label}, {name}"
            slow, faster = 1e9 * np.median(times[peer]), ratio(times, peer, f"fn, {name}")
            wrong = np.abs(list_by_quad(FEW, scalar, options) / exact - 1).max()
            print(f"{name:<12} {fast:>8.0f}   {label:<17} {slow:>8.0f} {faster:>6.0f} {wrong:>10.1e}")


if __name__ == "__main__":
    main()
