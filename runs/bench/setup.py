"""Time of one call of `mcgw.simulate` for one surface, its set-up and all: ``python runs/bench/setup.py``.

The scene is made outside the timing. Every call has a fresh one (another seed, slightly other separations),
so that nothing kept of an earlier one helps; only before "a change of gamma alone" the same scene was drawn
with another gamma. The first use is the first call in a new process whose loops are compiled. The peer is the
NumPy script for one surface of S1.
"""

import subprocess
import sys

import numpy as np
from scenes import S1, fresh, script
from timing import Job, against, parser_of, seconds, show, timed

import mcgw
from analytic import Exponential, KogutEtsion
from mcgw.scene.scene import Scene

PEER = "NumPy script"
ONE = S1.replace(n_surfaces=1, sampler="auto")
FIRST = "first use in a process"
FIRST_USE = """
import sys
from time import perf_counter
import mcgw
simulate, scene = mcgw.simulate, mcgw.scene_from(sys.stdin.read())
start = perf_counter()
simulate(scene)
print(perf_counter() - start)
"""


def one_surface(scene: Scene, calls: int = 5) -> Job:
    """A surface of a scene that nothing is known of: mean of a few calls, each with a scene of its own."""

    def simulate() -> float:
        asked = [fresh(scene) for _ in range(calls)]
        return seconds(lambda: [mcgw.simulate(each) for each in asked], calls)

    return simulate


def gamma_alone(calls: int = 5) -> float:
    """A surface whose scene was just drawn with other gammas."""
    before = fresh(ONE)
    asked = [before.replace(grading=Exponential(2.0 + 0.01 * k)) for k in range(1, calls + 1)]
    mcgw.simulate(before)
    return seconds(lambda: [mcgw.simulate(each) for each in asked], calls)


def first_use() -> float:
    """Seconds of the first call of a process, its imports made."""
    call, text = [sys.executable, "-c", FIRST_USE], mcgw.scene_text(fresh(ONE))
    return float(subprocess.run(call, input=text, capture_output=True, text=True, check=True).stdout)


def jobs() -> dict[str, Job]:
    """What is compared."""
    return {
        "S1": one_surface(ONE),
        "401 separations": one_surface(ONE.replace(separations=tuple(np.linspace(0, 4, 401)))),
        "N = 1e4": one_surface(ONE.replace(n_asperities=10**4)),
        "10 001 separations": one_surface(ONE.replace(separations=tuple(np.linspace(0, 4, 10_001))), 1),
        "Kogut-Etsion": one_surface(ONE.replace(law=KogutEtsion(critical=0.05))),
        "a change of gamma alone": gamma_alone,
        FIRST: first_use,
        PEER: script(),
    }


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of a call, to those of the NumPy script: lower is better."""
    *names, peer = jobs()
    return against(timed(jobs(), rounds), peer, names)


def main() -> None:
    """Print milliseconds and every ratio."""
    rounds = parser_of(__doc__).parse_args().rounds
    times = timed(jobs(), rounds)
    show("one surface by mcgw.simulate", times, PEER)
    print(f"{FIRST}: {1e3 * np.median(times[FIRST] - times['S1']):.0f} ms more than a later one of S1")


if __name__ == "__main__":
    main()
