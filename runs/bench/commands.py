"""How long whole commands take, each in its own process, against the imports that they cannot do without.

Least and median of the rounds, and the least time beyond the imports. With ``--other FOLDER`` another
checkout of the project, such as ``git worktree add`` makes of an older commit, is timed in between. Run:
``python runs/bench/commands.py [--rounds 7] [--other FOLDER]``.
"""

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from timing import Job, Times, against, job, parser_of, timed

HERE = Path(__file__).resolve().parents[2]
PEER = "imports"
NEEDED = "import numpy, h5py, numba, scipy.special"


def process(arguments: list[str], checkout: Path, folder: Path) -> Job:
    """A job: Python with these arguments, in a folder that holds no other checkout."""
    environment = {key: x for key, x in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPATH"] = str(checkout)
    call = [sys.executable, *arguments]
    return job(lambda: subprocess.run(call, env=environment, cwd=folder, check=True, capture_output=True))


def jobs(folder: Path, checkout: Path = HERE) -> dict[str, Job]:
    """What is compared; `run` makes the file that the others open."""
    file, scene = folder / "quick.h5", str(HERE / "runs" / "quick.toml")
    draw = process(["-m", "mcgw", "run", scene, "-o", str(file)], checkout, folder)

    def run() -> float:
        file.unlink(missing_ok=True)
        return draw()

    opened = f"import mcgw; mcgw.open_ensemble({str(file)!r})"
    others = {
        "import mcgw": ["-c", "import mcgw"],
        "open_ensemble": ["-c", opened],
        "show": ["-m", "mcgw", "show", str(file)],
        "compare": ["-m", "mcgw", "compare", str(file)],
    }
    needed = process(["-c", NEEDED], checkout, folder)
    return {PEER: needed, "run quick.toml": run} | {
        name: process(arguments, checkout, folder) for name, arguments in others.items()
    }


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of each command to those of the imports: lower is better."""
    with TemporaryDirectory() as folder:
        made = jobs(Path(folder))
        return against(timed(made, rounds), PEER)


def show(checkout: Path, times: Times, before: Times | None) -> None:
    """Print a line for each command; beside it its share of what it took before."""
    print(f"\n{checkout}\n{'seconds':18}{'least':>8}{'median':>8}{'beyond imports':>16}")
    for name, taken in times.items():
        line = f"{name:18}{taken.min():8.2f}{np.median(taken):8.2f}{taken.min() - times[PEER].min():16.2f}"
        print(line if before is None else f"{line}   {taken.min() / before[name].min():.2f} of that before")


def main() -> None:
    """Measure and print."""
    parser = parser_of(__doc__)
    parser.add_argument("--other", type=Path, metavar="FOLDER", help="another checkout")
    asked = parser.parse_args()
    checkouts = [HERE] if asked.other is None else [asked.other.resolve(), HERE]
    with TemporaryDirectory() as name:
        places = {checkout: Path(name) / str(k) for k, checkout in enumerate(checkouts)}
        made = {}
        for checkout, folder in places.items():
            folder.mkdir()
            made |= {f"{folder.name}{what}": call for what, call in jobs(folder, checkout).items()}
        times = timed(made, asked.rounds)
    before = None
    for checkout, folder in places.items():
        own = {what[1:]: taken for what, taken in times.items() if what[0] == folder.name}
        show(checkout, own, before)
        before = own


if __name__ == "__main__":
    main()
