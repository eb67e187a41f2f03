"""Random ``kill -9`` of all that writes: ``python runs/reliability/kills.py [KILLS [SEED [FOLDER]]]``.

Runs that are one block, runs in blocks, extensions, jobs that share a run, merges, sweeps, exports: each is
killed at random moments, several times in a row, and repeated at once. Where FOLDER lies on a disk of a few
megabytes, as a small tmpfs, that is filled up at times too. Prints one JSON line: kills of each kind, full
disks; blocks that were committed and are gone (lost), files with another digest than the undisturbed run's
(wrong) or with anything beside them (left), and commands that did not go on (stuck). All but the kills and
the full disks should be 0.

The surfaces of runs are made up: what is tried here is the store.
"""

import hashlib
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "crash"))

import harness
from oracles.inside import RECORD, Plan, home, parts_of, read_attributes, verify

import mcgw
from mcgw.errors import RunError, StoreError

BLOCKS, SMALL_DISK = 12, 2**24
OVER = {"surface.E_star": [1e9, 2e9], "ensemble.seed": list(range(7, 13))}
WANTED = harness.scene_of(BLOCKS)
ONE = WANTED.replace(n_surfaces=harness.ROWS)
HALF = WANTED.replace(n_surfaces=harness.ROWS * BLOCKS // 2 + 3)


def run(scene):
    """Draw a scene, as `mcgw run` does."""
    return lambda file: mcgw.run(scene, file)


def job(number):
    """Draw a share, as `mcgw run --shard` does."""
    return lambda file: mcgw.run(WANTED, file, shard=f"{number}/2")


def sweep(file):
    """Draw twelve scenes in six groups, as `mcgw sweep` does."""
    mcgw.sweep(WANTED.replace(n_surfaces=40), OVER, path=file)


def exported(file):
    """Write tables of means and quantiles, as `mcgw export` does."""
    mcgw.export(WANTED.replace(n_surfaces=200), file, to="calculix", points=100)


# What lies there before, what is killed again and again, and what ends it.
KINDS = {
    "one block": ([], [run(ONE)]),
    "blocks": ([], [run(WANTED)]),
    "extension": ([run(HALF)], [run(WANTED)]),
    "one block grows": ([run(ONE.replace(n_surfaces=3))], [run(ONE)]),
    "jobs": ([], [job(1), job(2), mcgw.merge]),
    "merge": ([job(1), job(2)], [mcgw.merge]),
    "sweep": ([], [sweep]),
    "export": ([], [exported]),
}


def digest_of(file):
    """Damage of a file, if it can be seen, and its digest."""
    if not file.exists():
        return "there is none", ""
    if file.suffix == ".h5":
        return verify(file)
    texts = [path.read_bytes() for path in sorted(file.parent.iterdir())]
    return "", hashlib.sha256(b"\0".join(texts)).hexdigest()


def file_of(kind, folder):
    """Where the last step of a kind writes."""
    return folder / ("e.inp" if kind == "export" else "e.h5")


def forked(action, file):
    """Begin an action in a process of its own."""
    pid = os.fork()
    if not pid:
        code = 1
        try:
            action(file)
            code = 0
        except (RunError, StoreError, OSError) as error:
            sys.stderr.write(f"{error}\n")
        finally:
            os._exit(code)
    return pid


def done(action, file):
    """Exit code of an action that is left alone."""
    return os.waitstatus_to_exitcode(os.waitpid(forked(action, file), 0)[1])


def committed(file):
    """Surfaces that lie there, in the file or in shards of its run."""
    held = set()
    if file.exists():  # of a sweep and an export all or none
        held.update(range(10**4 if file.suffix != ".h5" else _surfaces(file)))
    if (parts_of(file) / RECORD).is_file():
        for span in Plan.open(parts_of(file)).shards():
            held.update(range(span.first, span.stop))
    return held


def _surfaces(file):
    return 10**4 if "axes" in read_attributes(file) else mcgw.open_ensemble(file).n_surfaces


def struck(action, file, after, count):
    """Kill an action, on a disk that is full for it at times; whether it was still at work."""
    before, ballast = committed(file), file.parent / "ballast"
    room = shutil.disk_usage(file.parent).free
    if room < SMALL_DISK and count["dice"].random() < 0.5:
        ballast.write_bytes(bytes(max(room - int(2 ** count["dice"].uniform(10, 17)), 0)))
    pid = forked(action, file)
    time.sleep(after if not ballast.exists() else 3 * after)
    os.kill(pid, signal.SIGKILL)
    status = os.waitpid(pid, 0)[1]
    if ballast.exists():
        count["full"] += status != signal.SIGKILL and os.waitstatus_to_exitcode(status) == 1
        count["stuck"] += status != signal.SIGKILL and os.waitstatus_to_exitcode(status) not in (0, 1)
        ballast.unlink()
    count["lost"] += len(before - committed(file))
    return status == signal.SIGKILL


def trial(kind, folder, dice, count, expected):
    """Kill every step of one kind some times, let it go on, and look at what is there."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    file = file_of(kind, folder)
    before, steps = KINDS[kind]
    span, names, right = expected
    for action in before:
        count["stuck"] += done(action, file) != 0
    for action in steps:
        while dice.random() < 0.7:
            count[kind] += struck(action, file, dice.uniform(0, span), count)
        count["stuck"] += done(action, file) != 0  # the same command, repeated at once
    count["wrong"] += digest_of(file) != ("", right)
    count["left"] += sorted(path.name for path in folder.iterdir()) != names


def undisturbed(kind, folder):
    """Time of the last step of a kind, the files that it leaves, and their digest."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    file = file_of(kind, folder)
    before, steps = KINDS[kind]
    for action in (*before, *steps[:-1]):
        assert done(action, file) == 0
    begin = time.perf_counter()
    assert done(steps[-1], file) == 0
    names = sorted(path.name for path in folder.iterdir())
    return 1.1 * (time.perf_counter() - begin), names, digest_of(file)[1]


def main(kills, seed, folder):
    """As many kills, spread over all kinds alike."""
    harness.prepare()
    home("PATIENCE").PATIENCE = 1.0
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory() as once:  # compile the loops before the process is copied
        sweep(Path(once) / "e.h5")
        exported(Path(once) / "e.inp")
    count = {"lost": 0, "wrong": 0, "left": 0, "stuck": 0, "full": 0, **dict.fromkeys(KINDS, 0), "dice": dice}
    expected = {kind: undisturbed(kind, folder / "whole") for kind in KINDS}
    while sum(count[kind] for kind in KINDS) < kills:
        least = min(KINDS, key=lambda kind: count[kind])
        trial(least, folder / "trial", dice, count, expected[least])
    del count["dice"]
    print(json.dumps({"kills": sum(count[kind] for kind in KINDS), **count}))


if __name__ == "__main__":
    memory = Path("/dev/shm")  # flushing is quick there: what is tried is the order of the calls
    memory = sys.argv[3] if len(sys.argv) > 3 else memory if memory.is_dir() else None
    with tempfile.TemporaryDirectory(dir=memory) as place:
        words = [int(word) for word in sys.argv[1:3]]
        main(words[0] if words else 200, words[1] if len(words) > 1 else 1, Path(place))
