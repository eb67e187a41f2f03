"""What sbatch does with the examples, on one machine: ``slurm_stand_in.py [options] SCRIPT [arguments]``.

A job is run at once, where it is submitted; the tasks of an array two at a time, the last ones first. As
Slurm does it, the script is copied elsewhere, and options on the command line go before those in the script.
In the folder SLURM_STAND_IN a file for each job holds the worst exit code of its tasks.
"""

import argparse
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def options_of(words):
    parser = argparse.ArgumentParser(prog="sbatch", allow_abbrev=False)
    for name in ("--array", "--dependency", "--job-name", "--time", "--wrap"):
        parser.add_argument(name)
    parser.add_argument("--cpus-per-task", type=int)
    for name in ("--parsable", "--requeue"):
        parser.add_argument(name, action="store_true")
    parser.add_argument("script", nargs="*")
    script = next(
        (i for i, word in enumerate(words) if not word.startswith("--") and not _value(words, i)), None
    )
    given, rest = (words, []) if script is None else (words[:script], words[script:])
    if rest:
        lines = Path(rest[0]).read_text().splitlines()
        said = [word for line in lines if line.startswith("#SBATCH ") for word in line.split()[1:]]
        given = [*said, *given]
    options = parser.parse_args(given)
    options.script = rest
    return options


def _value(words, i):
    return i > 0 and words[i - 1] == "--wrap"


def main():
    home, options = Path(os.environ["SLURM_STAND_IN"]), options_of(sys.argv[1:])
    number = 100 + len(list(home.glob("job-*")))
    state = home / f"job-{number}"
    state.write_text("waiting")
    sys.stdout.write(f"{number}\n" if options.parsable else f"Submitted batch job {number}\n")
    sys.stdout.flush()
    if options.dependency:
        kind, _, other = options.dependency.partition(":")
        assert kind == "afterok"
        if (home / f"job-{other}").read_text() != "0":
            state.write_text("DependencyNeverSatisfied")
            return
    script = home / f"script-{number}"
    script.write_text(
        Path(options.script[0]).read_text() if options.script else f"#!/bin/sh\n{options.wrap}\n"
    )
    first, last = map(int, options.array.split("-")) if options.array else (None, None)
    common = {"SLURM_JOB_ID": str(number)}
    if options.cpus_per_task:
        common["SLURM_CPUS_PER_TASK"] = str(options.cpus_per_task)

    def run(task):
        more = {}
        if task is not None:
            more = {"SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_COUNT": last - first + 1}
        env = {**os.environ, **common, **{name: str(value) for name, value in more.items()}}
        shell = script.read_text().splitlines()[0].removeprefix("#!")
        with open(home / f"slurm-{number}_{task}.out", "w") as out:
            return subprocess.call([shell, script, *options.script[1:]], env=env, stdout=out, stderr=out)

    with ThreadPoolExecutor(2) as pool:
        codes = list(pool.map(run, range(last, first - 1, -1) if options.array else [None]))
    state.write_text(str(max(codes, key=abs)))


if __name__ == "__main__":
    main()
