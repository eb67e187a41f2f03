"""Every command told to write over what it reads: ``python runs/reliability/overwrite.py``.

Prints a line a command: under how many names of the file it was tried, how often it was refused with exit
code 2, and how often any file changed. `tests/commands/test_outputs.py` asserts the same.
"""

import contextlib
import io
import os
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from oracles.overwrites import CASES, attempt, prepare, ways


def tried(case, inputs, place):
    """Names tried, refusals, and attempts that changed a file."""
    refused = harmed = 0
    for way in ways(case):
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(inputs, place)
        os.chdir(place)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            code, changed = attempt(case, way)
        os.chdir(inputs)
        refused += code == 2
        harmed += bool(changed)
    return len(ways(case)), refused, harmed


def main(folder):
    """Try all."""
    inputs = folder / "inputs"
    inputs.mkdir()
    os.chdir(inputs)
    with contextlib.redirect_stdout(io.StringIO()):
        prepare(inputs)
    total = [0, 0, 0]
    for case, (read, words, _) in CASES.items():
        counts = tried(case, inputs, folder / "trial")
        total = [a + b for a, b in zip(total, counts, strict=True)]
        print(
            f"{counts[0]} names, {counts[1]} refused, {counts[2]} changed  {read:12} mcgw {words}", flush=True
        )
    print(f"{len(CASES)} commands, {total[0]} attempts: {total[1]} refused, {total[2]} changed a file")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        main(Path(place))
