"""A long run killed at random times, again and again: ``python soak.py FOLDER KILLS BLOCKS``.

Prints one JSON line: kills, second drivers refused, blocks that vanished, digests that differ.
"""

import json
import os
import random
import shutil
import signal
import sys
import time
from pathlib import Path

from harness import RECORD, ROWS, RunFolder, attempt, forked, parts_of, prepare, scene_of

from mcgw.store import ensembles


def begun(scene, file):
    """Start a driver in a process of its own."""
    pid = os.fork()
    if not pid:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
        os._exit(attempt(scene, file))
    return pid


def committed(file):
    if not (parts_of(file) / RECORD).is_file():
        return set()
    return {shard.span.first for shard in RunFolder.open(parts_of(file)).shards()}


def main(folder, kills, blocks):
    prepare()
    scene, dice = scene_of(blocks), random.Random(1)
    folder.mkdir(parents=True)
    whole, file = folder / "whole.h5", folder / "e.h5"
    begin = time.perf_counter()
    forked(lambda: attempt(scene, whole))
    span = time.perf_counter() - begin
    digest = ensembles.verify(whole)[1]
    count = {"kills": 0, "rounds": 0, "refused": 0, "vanished": 0, "wrong": 0}
    while count["kills"] < kills:
        before = committed(file)
        pid = begun(scene, file)
        if dice.random() < 0.1:
            time.sleep(0.01)
            second = begun(scene, file)
            count["refused"] += os.waitstatus_to_exitcode(os.waitpid(second, 0)[1]) == 1
        time.sleep(dice.uniform(0, 0.4 * span))
        os.kill(pid, signal.SIGKILL)
        count["kills"] += os.waitpid(pid, 0)[1] == signal.SIGKILL
        if file.exists():
            count["wrong"] += forked(lambda: attempt(scene, file)) != 0
            count["wrong"] += ensembles.verify(file) != ("", digest)
            count["rounds"] += 1
            file.unlink()
            shutil.rmtree(parts_of(file), ignore_errors=True)
        else:
            count["vanished"] += len(before - committed(file))
    count["wrong"] += forked(lambda: attempt(scene, file)) != 0
    count["wrong"] += ensembles.verify(file) != ("", digest)
    sys.stdout.write(json.dumps({**count, "surfaces": ROWS * blocks}) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
