"""Time what `keep = "statistics"` takes: ``python runs/bench/kept_statistics.py``.

A surface of 41 separations and four quantities, of 100 and of 30 000 asperities. The peer keeps all values in
an array, and asks NumPy for mean, deviation, covariance, skewness, nine quantiles and extremes.
"""

from dataclasses import replace

import numpy as np
from scenes import S1
from timing import Job, against, job, parser_of, show, timed

import mcgw

PEER = "values, and NumPy"
SHARES = (0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999)
SCENES = {
    "100 asperities": replace(S1, n_asperities=100, n_surfaces=32_768, sampler="auto"),
    "30 000 asperities": replace(S1, n_asperities=30_000, n_surfaces=4096, sampler="auto"),
}


def statistics(scene: mcgw.Scene) -> Job:
    """Drawn for its statistics."""
    kept = replace(scene, keep="statistics")

    def draw() -> None:
        e = mcgw.simulate(kept)
        for name in scene.quantities:
            e.mean(name), e.std(name), e.skewness(name), e.extremes(name), e.covariance(name)
            [e.quantile(name, share) for share in SHARES]

    return job(draw, scene.n_surfaces)


def values(scene: mcgw.Scene) -> Job:
    """Drawn with all values, of which NumPy makes the same."""

    def draw() -> None:
        e = mcgw.simulate(scene)
        table = np.concatenate([e[name].astype(np.float64) for name in scene.quantities], axis=1)
        apart = table - table.mean(axis=0)
        np.cov(table, rowvar=False), (apart**3).mean(axis=0), table.min(axis=0), table.max(axis=0)
        np.quantile(table, SHARES, axis=0)

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
