"""From shards to the file: written under a temporary name, read back, and given its trailer.

Chunks go from the shards into the file as they are, packed, where they line up (`mcgw.store.chunks`). What
the file then holds is read through HDF5, compared with the digest that each shard got from the numbers as
they were drawn, and gives the digest of the whole.
"""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import h5py

from mcgw.errors import RunError, StoreError
from mcgw.machine.one_ahead import Items, one_ahead
from mcgw.scene.scene import Scene
from mcgw.store.disk import SteadyFile
from mcgw.store.layout import describe, digest_of, file_pieces, fill, rows_of, stored_tables, trailer_notes
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import LIBVER, Shard, Span, Tables, content_digest, tables_in
from mcgw.store.trailer import Trailer, sha256_of

__all__ = ["merge_into"]

_CACHE = 2**25  # of chunks that a shard fills only in part


def merge_into(run: RunFolder, target: Path, temporary: Path, check: Callable[[], None]) -> None:
    """Write the ensemble of a run under a temporary name: the surfaces of `target`, then those of the shards.

    `check` is called often, and raises if this is to end.

    Raises
    ------
    StoreError
        If a shard is missing or damaged.
    OSError, RuntimeError
        If the disk does not take it, or what was written reads otherwise.
    """
    held, _ = _before(target)
    shards = [shard for shard in run.shards(bodies=False) if shard.span.first >= held]
    with closing(SteadyFile(temporary)) as raw:

        def go_on() -> None:
            check()
            raw.check()

        try:
            _write(raw, temporary, run, target, shards, go_on)
        except (StoreError, RunError):
            raise
        except Exception:  # HDF5 reports a full disk as any of a dozen
            raw.check()
            for shard in shards:
                shard.arrays()
            raise


def _write(
    raw: SteadyFile, path: Path, run: RunFolder, target: Path, shards: list[Shard], go_on: Callable[[], None]
) -> None:
    with (
        h5py.File(raw, "w", libver=LIBVER, rdcc_nbytes=_CACHE) as file,
        closing(_pieces(target, shards, go_on)) as pieces,
    ):
        fill(file, run.scene, pieces)
    raw.check()
    with ThreadPoolExecutor(1) as thread:
        flushed = thread.submit(raw.sync)  # the disk is busy with it while this process reads
        digest = _read_back(path, run.scene, _expected(target, shards), go_on)
        flushed.result()
    with h5py.File(raw, "r+", libver=LIBVER) as file:
        seconds = sum(shard.seconds for shard in shards) + _before(target)[1]
        of_run = {"run": run.identity, "draws": run.drawn_with, "wall_seconds": seconds}
        describe(file, run.scene, run.sampler, digest, **of_run)
    raw.check()
    with h5py.File(path, "r") as file:
        if file.attrs["digest"] != digest:
            raise OSError(f"{path}: reads otherwise than written")
        notes = trailer_notes(file)
    length = path.stat().st_size
    raw.trailer(Trailer(length, sha256_of(path, length), notes).to_bytes())


def _pieces(
    target: Path, shards: list[Shard], go_on: Callable[[], None]
) -> Items[tuple[Span, Mapping[str, h5py.Dataset]]]:
    """All surfaces in order, packed: first those of the finished file, then those of the shards."""
    if target.exists():
        with h5py.File(target, "r") as old:
            yield Span(0, len(old["surface"])), stored_tables(old)
    with closing(one_ahead((shard, shard.body()) for shard in shards)) as bodies:
        for shard, body in bodies:
            go_on()
            with tables_in(body, shard.path) as tables:
                yield shard.span, tables


def _expected(target: Path, shards: list[Shard]) -> Iterator[tuple[Span, str]]:
    """What the numbers of all surfaces, in order, give if they are the right ones."""
    if target.exists():
        with h5py.File(target, "r") as old:
            for span, arrays in file_pieces(old):
                yield span, content_digest(arrays)
    for shard in shards:
        yield shard.span, shard.digest


def _read_back(
    path: Path, scene: Scene, expected: Iterator[tuple[Span, str]], go_on: Callable[[], None]
) -> str:
    """Digest of the file as HDF5 reads it, if all its numbers are as they should be.

    One thread reads, one compares, and this one adds up the digest of the whole.
    """
    with h5py.File(path, "r") as file:

        def read() -> Items[tuple[str, Tables]]:
            for span, digest in expected:
                go_on()
                for _, arrays in rows_of(file, [span]):
                    yield digest, arrays

        def compared() -> Items[Tables]:
            with closing(one_ahead(read())) as pieces:
                for digest, arrays in pieces:
                    if content_digest(arrays) != digest:
                        raise OSError(f"{path}: reads otherwise than written")
                    yield arrays

        with closing(one_ahead(compared())) as pieces:
            return digest_of(file, scene, pieces)


def _before(target: Path) -> tuple[int, float]:
    """Surfaces of the finished file, and the seconds they took."""
    if not target.exists():
        return 0, 0.0
    with h5py.File(target, "r") as old:
        return len(old["surface"]), float(old.attrs["wall_seconds"])
