"""Runs of small blocks that are begun, halted and looked at: what tests of files and engines share."""

import threading

import pytest

import mcgw
from oracles.inside import Statistics, Values, home, parts_of, verify

SIZE, SURFACES = 16, 100  # seven blocks, the last one short


class HaltError(Exception):
    """Stands for whatever ends a run."""


def in_small_blocks(patch, size=SIZE):
    for kept in (Values, Statistics):
        patch.setattr(kept, "rows", size)
    patch.setattr(home("CHUNK_ROWS"), "CHUNK_ROWS", size // 2)


def settle():
    """Wait for what is at work: a block is written even after its caller has an exception."""
    for thread in threading.enumerate():
        if thread.name == "mcgw-blocks":
            thread.join()


def halted(scene, path, surfaces):
    """A run that is ended when so many are done."""

    def progress(done, _):
        if done >= surfaces:
            raise HaltError

    with pytest.raises(HaltError):
        mcgw.run(scene, path, progress=progress)
    settle()
    assert parts_of(path).is_dir()


def begun(scene, path, jobs=1):
    """All blocks of a run, not merged yet."""
    for k in range(1, jobs + 1):
        mcgw.run(scene, path, shard=f"{k}/{jobs}")
    assert not path.exists()
    return sorted(parts_of(path).glob("shards/block-*.h5"))


def digest(path):
    problem, found = verify(path)
    assert problem == ""
    return found
