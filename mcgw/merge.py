"""From shards to the file, in a process of its own: the HDF5 library may crash on a full disk.

Run as a script: ``python -m mcgw.merge FOLDER TARGET TEMPORARY``. The file is written under the
temporary name, read back and compared with the shards, sealed and flushed; the caller gives it its
name. Exit code 3: a shard is damaged.
"""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

from mcgw.errors import StoreError
from mcgw.layout import build, file_pieces
from mcgw.rundir import Run
from mcgw.seal import Seal, sha256_of
from mcgw.shards import Arrays, Span, content_digest

__all__ = ["DAMAGED", "merge_into"]

DAMAGED = 3
_CACHE = 2**25  # of chunks that a shard fills only in part


def merge_into(folder: Path, target: Path, temporary: Path) -> None:
    """Write the ensemble of a run under a temporary name.

    Parameters
    ----------
    folder : Path
        Of the run; its shards hold every surface that `target` does not.
    target : Path
        The file as it is, if there is one: its surfaces come first.
    temporary : Path
        Where to write; must not exist.

    Raises
    ------
    StoreError
        If a shard is missing or damaged, or if what was written reads otherwise.
    OSError
        If the disk does not take it.
    """
    run = Run.open(folder)
    seconds = sum(shard.seconds for shard in run.shards()) + _seconds_of(target)
    with h5py.File(temporary, "x", libver=("v108", "v110"), rdcc_nbytes=_CACHE) as file:
        build(
            file,
            run.scene,
            run.sampler,
            _pieces(run, target),
            run=run.identity,
            draws=run.drawn_with,
            wall_seconds=seconds,
        )
    _read_back(run, target, temporary)
    length = temporary.stat().st_size
    with open(temporary, "r+b") as written:
        os.fsync(written.fileno())
        written.seek(length)
        written.write(Seal(length, sha256_of(temporary, length), {}).to_bytes())
        written.flush()
        os.fsync(written.fileno())


def _pieces(run: Run, target: Path) -> Iterator[tuple[Span, Arrays]]:
    """All surfaces in order: first those of the finished file, then those of the shards."""
    stop = 0
    if target.exists():
        with h5py.File(target, "r") as old:
            for span, arrays in file_pieces(old):
                yield span, arrays
                stop = span.stop
    for shard in run.shards():
        if shard.span.first >= stop:
            yield shard.span, shard.arrays()


def _read_back(run: Run, target: Path, temporary: Path) -> None:
    """Compare every number with where it came from; what HDF5 failed to write shows here."""
    with h5py.File(temporary, "r") as file:
        for span, arrays in _pieces(run, target):
            for name, values in arrays.items():
                found = file[name][span.first : span.stop] if name != "extras" else None
                if found is not None and content_digest({name: found}) != content_digest({name: values}):
                    raise OSError(f"{temporary}: {name} of {span} reads otherwise than written")
        _check_extras(file, run, target)


def _check_extras(file: h5py.File, run: Run, target: Path) -> None:
    if "extras" not in file:
        return
    written = [arrays["extras"] for _, arrays in _pieces(run, target)]
    if not np.array_equal(np.concatenate(written), file["extras"][()]):
        raise OSError("extras: read otherwise than written")


def _seconds_of(target: Path) -> float:
    if not target.exists():
        return 0.0
    with h5py.File(target, "r") as old:
        return float(old.attrs["wall_seconds"])


def _main(folder: str, target: str, temporary: str) -> int:
    try:
        merge_into(Path(folder), Path(target), Path(temporary))
    except StoreError as error:
        sys.stderr.write(f"{error}\n")
        return DAMAGED
    except (OSError, RuntimeError) as error:  # HDF5 reports a full disk as either
        sys.stderr.write(f"{error}".splitlines()[0] + "\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))
