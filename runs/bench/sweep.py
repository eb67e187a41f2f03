"""Time a scene of `mcgw.sweep` over gradings, for several N at once: ``python runs/bench/sweep.py``.

Gradings of 1000 surfaces each, at 41 separations: mean and standard deviation of load, area, stiffness and
contacts. The peer is `mcgw.simulate` of the same scenes, one after the other. A scene of 1000 gradings has
to take at most 4 ms (`--points`); the history has fewer gradings, of which each takes a little longer.
"""

import numpy as np
from scenes import S1
from timing import Job, against, job, parser_of, show, timed

import mcgw
from analytic import Exponential, KogutEtsion, Table

PEER = "simulate"
N = [10_000, 30_000, 100_000]
SCENE = S1.replace(n_surfaces=1000, sampler="auto")
FEW = 20


def gradings(points: int) -> Job:
    """A scene of a sweep over gradings and N, with its means and deviations."""
    gammas = np.linspace(0.2, 2.0, points)

    def sweep() -> None:
        found = mcgw.sweep(SCENE, {"grading.gamma": gammas, "ensemble.n_asperities": N})
        for name in found.quantities:
            found.mean(name), found.std(name)

    return job(sweep, points * len(N))


def tables(points: int) -> Job:
    """The same of one N, where every grading has a kink of its own."""
    given = [Table((-1, k, 6), (1.0, 1.5, 3.0)) for k in np.linspace(0.2, 0.8, points)]
    scene = SCENE.replace(n_asperities=N[1])
    return job(lambda: mcgw.sweep(scene, {"grading": given}), points)


def hardness(points: int) -> Job:
    """The same of one N under a law with breaks; few, for every one cuts all cells."""
    scene = SCENE.replace(n_asperities=N[1], law=KogutEtsion(hardness=1.2e9, poisson=0.3))
    return job(lambda: mcgw.sweep(scene, {"contact.law.hardness": np.linspace(1e9, 3e9, points)}), points)


def alone() -> Job:
    """A scene by itself: the mean over all N."""
    scenes = [SCENE.replace(n_asperities=n, grading=Exponential(g)) for n in N for g in (0.7, 1.9)]

    def simulate() -> None:
        for scene in scenes:
            ensemble = mcgw.simulate(scene)
            for name in scene.quantities:
                ensemble.mean(name), ensemble.std(name)

    return job(simulate, len(scenes))


def jobs(points: int = 100) -> dict[str, Job]:
    """What is compared."""
    return {
        "gradings": gradings(points),
        "tables, each with a kink": tables(FEW),
        "hardness": hardness(FEW // 4),
        PEER: alone(),
    }


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of a scene, to those of one alone: lower is better."""
    return against(timed(jobs(), rounds), PEER)


def main() -> None:
    """Print microseconds a scene and every ratio."""
    parser = parser_of(__doc__)
    parser.add_argument("--points", type=int, default=1000, help="gradings for each N (default: 1000)")
    options = parser.parse_args()
    show("one scene of 1000 surfaces", timed(jobs(options.points), options.rounds), PEER)


if __name__ == "__main__":
    main()
