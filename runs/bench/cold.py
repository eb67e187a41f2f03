"""The first command on a machine, with nothing compiled, and later ones: ``python runs/bench/cold.py``.

Whole processes. Each round has a cache of its own, empty before its first process. Prints medians of the
seconds of CPU and of the wall, and how many compiled loops are kept.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from timing import parser_of

ROOT = Path(__file__).parents[2]
RUN = ("run", "runs/quick.toml", "-o")
PROCESSES = {
    "run runs/quick.toml, cold": RUN,
    "run runs/quick.toml, warm": RUN,
    "run runs/demo.toml, what it adds": ("run", "runs/demo.toml", "-o"),
    "show --plan runs/quick.toml, warm": ("show", "--plan", "runs/quick.toml"),
}


def seconds(words: tuple[str, ...], cache: Path) -> tuple[float, float]:
    """CPU and wall of a command."""
    file = [str(cache / f"{len(list(cache.iterdir()))}.h5")] if words[-1] == "-o" else []
    before, start = os.times(), perf_counter()
    call = [sys.executable, "-m", "mcgw", *words, *file]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache / "loops")}
    subprocess.run(call, cwd=ROOT, env=environment, capture_output=True, check=True)
    wall, after = perf_counter() - start, os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return cpu, wall


def main() -> None:
    """Print the table."""
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in PROCESSES}
    for _ in range(parser_of(__doc__).parse_args().rounds):
        with tempfile.TemporaryDirectory() as folder:
            for name, words in PROCESSES.items():
                found[name].append(seconds(words, Path(folder)))
            kept = len(list(Path(folder).rglob("*.nbc")))
    for name, times in found.items():
        cpu, wall = (median(column) for column in zip(*times, strict=True))
        print(f"{cpu:8.2f} s CPU {wall:8.2f} s  {name}")
    print(f"{kept:8} loops kept")


if __name__ == "__main__":
    main()
