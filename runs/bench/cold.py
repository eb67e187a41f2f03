"""The first command on a machine, with nothing compiled, and later ones: ``python runs/bench/cold.py``.

Whole processes, each with a cache of its own: empty, or as the first run left it. Prints medians of the
seconds of CPU and of the wall. What a feature compiles is its first run after Hertz's, less a second one.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from timing import parser_of

ROOT = Path(__file__).parents[2]
QUICK = ("run", "runs/quick.toml")
SPECTRAL = """
[surface]
m0 = 1e-12
m2 = 1e-2
m4 = 4e8
nominal_area = 1e-4
E_star = 78.6e9
[contact]
separations = {start = 0.0, stop = 4.0, num = 9}
[ensemble]
n_surfaces = 200
n_asperities = 1000
seed = 1
"""
FEATURES = {
    "Kogut and Etsion": "contact.law=kogut-etsion contact.law.critical=0.1",
}
Found = dict[str, list[tuple[float, float]]]


def seconds(words: tuple[str, ...], cache: Path) -> tuple[float, float]:
    """CPU and wall of a command."""
    file = ("-o", tempfile.mktemp(".h5", dir=cache.parent)) if words[0] == "run" else ()
    before, start = os.times(), perf_counter()
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    call = [sys.executable, "-m", "mcgw", *words, *file]
    subprocess.run(call, cwd=ROOT, env=environment, capture_output=True, check=True)
    wall, after = perf_counter() - start, os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return cpu, wall


def measure(folder: Path, found: Found) -> None:
    """One round of all."""

    def note(name: str, words: tuple[str, ...], cache: str) -> None:
        found.setdefault(name, []).append(seconds(words, folder / cache))

    (folder / "own.toml").write_text(SPECTRAL)
    note("show --plan runs/quick.toml, cold", ("show", "--plan", "runs/quick.toml"), "plan")
    note("run runs/quick.toml, cold", QUICK, "hertz")
    note("run runs/quick.toml, warm", QUICK, "hertz")
    note("run runs/bench/aluminium.toml, cold", ("run", "runs/bench/aluminium.toml"), "demo")
    note("warm, cold", ("warm",), "all")
    features = {
        name: (*QUICK, *(part for word in words.split() for part in ("--set", word)))
        for name, words in FEATURES.items()
    }
    for name, words in {**features, "own radii": ("run", str(folder / "own.toml"))}.items():
        cache = folder / name
        shutil.copytree(folder / "hertz", cache)
        (first, at_first), (again, at_last) = seconds(words, cache), seconds(words, cache)
        found.setdefault(f"{name}, beyond Hertz", []).append((first - again, at_first - at_last))


def main() -> None:
    """Print the table."""
    found: Found = {}
    for _ in range(parser_of(__doc__).parse_args().rounds):
        with tempfile.TemporaryDirectory() as folder:
            measure(Path(folder), found)
    for name, times in found.items():
        cpu, wall = (median(column) for column in zip(*times, strict=True))
        print(f"{cpu:8.2f} s CPU {wall:8.2f} s  {name}")


if __name__ == "__main__":
    main()
