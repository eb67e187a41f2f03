"""From shards to the file, in a process of its own: the HDF5 library may crash on a full disk.

Run as a script: ``python -m mcgw.store.merged_file FOLDER TARGET TEMPORARY``. The file is written under the
temporary name, read back, compared with the digest of the shards, given its trailer and flushed; the
caller gives it its name. Exit code 3: a shard is damaged.
"""

import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import h5py

from mcgw.errors import StoreError
from mcgw.store.disk import SteadyFile
from mcgw.store.layout import build, file_pieces, trailer_notes, values_digest
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import LIBVER, Shard, Span, Tables
from mcgw.store.trailer import Trailer, sha256_of

__all__ = ["DAMAGED", "merge_into"]

DAMAGED = 3
_CACHE = 2**25  # of chunks that a shard fills only in part


def merge_into(folder: Path, target: Path, temporary: Path) -> None:
    """Write the ensemble of a run under a temporary name: the surfaces of `target`, then those of the shards.

    Raises
    ------
    StoreError
        If a shard is missing or damaged, or if what was written reads otherwise.
    OSError
        If the disk does not take it.
    """
    run = RunFolder.open(folder)
    shards = run.shards()
    seconds = sum(shard.seconds for shard in shards) + _seconds_of(target)
    with closing(SteadyFile(temporary)) as raw:
        with h5py.File(raw, "w", libver=LIBVER, rdcc_nbytes=_CACHE) as file:
            digest = build(
                file,
                run.scene,
                run.sampler,
                _checked(raw, _pieces(shards, target)),
                run=run.identity,
                draws=run.drawn_with,
                wall_seconds=seconds,
            )
        raw.check()
        with h5py.File(temporary, "r") as file:
            if file.attrs["digest"] != digest or values_digest(file, run.scene) != digest:
                raise OSError(f"{temporary}: reads otherwise than written")
            notes = trailer_notes(file)
        length = temporary.stat().st_size
        raw.trailer(Trailer(length, sha256_of(temporary, length), notes).to_bytes())


def _checked(raw: SteadyFile, pieces: Iterator[tuple[Span, Tables]]) -> Iterator[tuple[Span, Tables]]:
    """End with the first error of the disk, not after all shards."""
    for piece in pieces:
        raw.check()
        yield piece


def _pieces(shards: list[Shard], target: Path) -> Iterator[tuple[Span, Tables]]:
    """All surfaces in order: first those of the finished file, then those of the shards."""
    stop = 0
    if target.exists():
        with h5py.File(target, "r") as old:
            for span, arrays in file_pieces(old):
                yield span, arrays
                stop = span.stop
    for shard in shards:
        if shard.span.first >= stop:
            yield shard.span, shard.arrays()


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
