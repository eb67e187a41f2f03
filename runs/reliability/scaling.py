"""What executors cost, and how far they scale: ``python runs/reliability/scaling.py [-o FOLDER]``.

Blocks here take a second and give 1 MiB each, but wait instead of computing: so what is measured is the
executor and the commit, not the processor, and more workers than cores can be tried. Writes `scaling.json`
and `scaling.png` into FOLDER (left out: `runs/out`).
"""

import argparse
import hashlib
import json
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import distributed
import numpy as np

import mcgw
from mcgw.jobs.executors import Jobs, drive
from mcgw.machine.process import Signals
from mcgw.store.run_plan import Span, commit_shard

SECONDS, ROWS, COLUMNS = 1.0, 1024, 128
RUN = hashlib.sha256(b"scaling").hexdigest()


def wait_and_commit(folder, first, seconds):
    """A block that waits, and commits 1 MiB of numbers."""
    time.sleep(seconds)
    return commit(folder, first, ROWS)


def nothing(*_):
    """A block that costs nothing: what is left is the executor."""
    return RUN


def commit(folder, first, rows):
    """Commit a shard of random numbers."""
    load = np.random.default_rng(first).random((rows, COLUMNS))
    span = Span(first, rows)
    commit_shard(Path(folder) / span.file_name, RUN, span, {"load": load}, SECONDS)
    return span.file_name


def wall(executor, blocks, seconds, task=wait_and_commit):
    """Seconds for so many blocks."""
    spans, signals = [Span(ROWS * i, ROWS) for i in range(blocks)], Signals()
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        drive(executor, spans, task, lambda s: (folder, s.first, seconds), lambda *_: None, signals)
        return time.perf_counter() - begin


def commit_seconds():
    """Median cost of a commit, by size in MiB."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for mib in (1, 4, 8, 16):
            times = []
            for i in range(9):
                begin = time.perf_counter()
                commit(folder, i * ROWS * mib, ROWS * mib)
                times.append(time.perf_counter() - begin)
            found[mib] = float(np.median(times))
    return found


def merge_seconds():
    """Cost of merging, reading back and sealing a MiB of results; median of three runs of some shards."""
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    scene = mcgw.Scene(surface, separations=np.linspace(0, 4, 41), n_surfaces=40_000, seed=1)
    times = []
    for _ in range(3):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "e.h5"
            mcgw.run(scene, path, shard="1/1")
            begin = time.perf_counter()
            results = mcgw.merge(path)
            times.append(time.perf_counter() - begin)
            size = 8 * results.scene.width * results.n_surfaces
    return float(np.median(times)) / (size / 2**20)


@contextmanager
def dask_workers(n):
    """Yield the executor of so many workers of this machine."""
    with (
        distributed.LocalCluster(n_workers=n, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client.get_executor(pure=False)


def measure():
    """All figures."""
    result = {}
    result["commit"], result["merge_per_mib"] = commit_seconds(), merge_seconds()
    for name, make, workers, blocks in (
        ("threads", ThreadPoolExecutor, 1, 8),
        ("processes", Jobs, 2, 16),
        ("dask", dask_workers, 2, 16),
    ):
        with make(workers) as executor:
            wall(executor, 2 * workers, 0.0)  # workers import and connect
            result[name] = wall(executor, blocks, SECONDS) / (blocks / workers * SECONDS) - 1
            if name == "dask":
                result["tasks_per_second"] = 500 / wall(executor, 500, 0.0, nothing)
    curve = {}
    for workers in (1, 2, 4, 8, 16):
        with dask_workers(workers) as executor:
            wall(executor, 2 * workers, 0.0)
            curve[workers] = 6 * SECONDS / wall(executor, 6 * workers, SECONDS)
    result["efficiency"] = curve
    return result


def predicted(cores, result, seconds=SECONDS):
    """Share of the time that cores compute: blocks end, and the scheduler has them one after the other."""
    commit = result["commit"]["1"]
    demand = cores / (seconds + commit)  # blocks a second
    return seconds / (seconds + commit) * min(1.0, result["tasks_per_second"] / demand)


def draw(result, path):
    """Efficiency against workers, predicted and measured."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    cores = np.logspace(0, 4, 100)
    for seconds in (1, 10, 60):
        axes.semilogx(cores, [predicted(c, result, seconds) for c in cores], label=f"blocks of {seconds} s")
    measured = {int(k): v for k, v in result["efficiency"].items()}
    axes.plot(list(measured), list(measured.values()), "ko", label="measured, 1 s, workers that wait")
    axes.set(xlabel="workers", ylabel="share of the time that is computed", ylim=(0, 1.05))
    axes.legend(loc="lower left")
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=150)


def main():
    """Measure, draw, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parents[1] / "out")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    result = json.loads(json.dumps(measure()))
    (folder / "scaling.json").write_text(json.dumps(result, indent=1) + "\n")
    draw(result, folder / "scaling.png")
    print(json.dumps(result, indent=1))
    for cores in (100, 1000):
        shares = ", ".join(f"{predicted(cores, result, s):.2f} (blocks of {s} s)" for s in (1, 10, 60))
        print(f"{cores} cores: computing {shares} of the time")


if __name__ == "__main__":
    main()
