"""Time what `keep = "statistics"` takes: ``python runs/bench/kept_statistics.py``.

A surface of 41 separations and four quantities, of 100 and of 30 000 asperities. The peer keeps all values in
an array, and asks NumPy for mean, deviation and covariance.
"""

import numpy as np
from scenes import S1
from timing import Job, against, job, parser_of, show, timed

import mcgw

PEER = "values, and NumPy"
SCENES = {
    "100 asperities": S1.replace(n_asperities=100, n_surfaces=32_768, sampler="auto"),
    "30 000 asperities": S1.replace(n_asperities=30_000, n_surfaces=4096, sampler="auto"),
}


def statistics(scene: mcgw.Scene) -> Job:
    """Drawn for its statistics."""
    kept = scene.replace(keep="statistics")

    def draw() -> None:
        e = mcgw.simulate(kept)
        for name in scene.quantities:
            e.mean(name), e.std(name), e.covariance(name)

    return job(draw, scene.n_surfaces)


def values(scene: mcgw.Scene) -> Job:
    """Drawn with all values, of which NumPy makes the same."""

    def draw() -> None:
        e = mcgw.simulate(scene)
        table = np.concatenate([e[name].astype(np.float64) for name in scene.quantities], axis=1)
        table.mean(axis=0), np.cov(table, rowvar=False)

    return job(draw, scene.n_surfaces)


def jobs(name: str) -> dict[str, Job]:
    """Both ways of a scene."""
    return {"statistics": statistics(SCENES[name]), PEER: values(SCENES[name])}


def ratios(rounds: int) -> dict[str, float]:
    """What the history keeps."""
    found = {}
    for name in SCENES:
        found |= {f"{name}: {key}": value for key, value in against(timed(jobs(name), rounds), PEER).items()}
    return found


def main() -> None:
    """Print both scenes."""
    asked = parser_of(__doc__).parse_args()
    for name in SCENES:
        show(f"{name}, a surface", timed(jobs(name), asked.rounds), PEER)


if __name__ == "__main__":
    main()
