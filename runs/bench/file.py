"""What a file costs: `mcgw.run` of 200 000 surfaces of 10^4 asperities against `mcgw.simulate` of the same.

The separations and quantities of S1: 262 MB of results. Each round has a seed of its own and a new file, in
the folder of temporary files, which should be on a disk. Run: ``python runs/bench/file.py [--rounds 7]``.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from scenes import S1, fresh
from timing import Job, against, parser_of, seconds, show, timed

import mcgw

MANY = S1.replace(n_asperities=10**4, n_surfaces=200_000)


def into_memory() -> float:
    """Seconds of drawing them."""
    scene = fresh(MANY)
    return seconds(lambda: mcgw.simulate(scene))


def into_file() -> float:
    """Seconds of drawing and writing them."""
    scene = fresh(MANY)
    with TemporaryDirectory() as folder:
        return seconds(lambda: mcgw.run(scene, Path(folder) / "many.h5"))


def jobs() -> dict[str, Job]:
    """What is compared."""
    return {"run": into_file, "simulate": into_memory}


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of `run` to those of `simulate`: lower is better. No more than three rounds."""
    return against(timed(jobs(), min(rounds, 3)), "simulate", ["run"])


def main() -> None:
    """Print both."""
    rounds = parser_of(__doc__).parse_args().rounds
    show("200 000 surfaces of 1e4 asperities", timed(jobs(), rounds), "simulate")


if __name__ == "__main__":
    main()
