"""Ensembles that lie in memory, written to files; the schema stands in `mcgw.store`.

From shards to the file: written under a temporary name, read back, and given its trailer.

Chunks go from the shards into the file as they are, packed, where they line up (`mcgw.store.chunks`). What
the file then holds is read through HDF5, compared with the digest that each shard got from the numbers as
they were drawn, and gives the digest of the whole.
"""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import h5py

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Tables
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import check_output, state_of
from mcgw.formats.gate import open_h5
from mcgw.machine.in_threads import Items, one_ahead
from mcgw.scene.arguments import check_object
from mcgw.scene.scene import Scene
from mcgw.store.disk import SteadyFile, Trailer, head_digest, parts_of, sha256_of
from mcgw.store.ensembles import open_ensemble
from mcgw.store.identity import identity_of, versions
from mcgw.store.layout import body_of, describe, digest_of, file_pieces, fill, rows_of, stored_tables
from mcgw.store.lock import locked
from mcgw.store.place import finished, write_body
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import LIBVER, Shard, Span, content_digest, tables_in

_CACHE = 2**25  # of chunks that a shard fills only in part


def save(ensemble: Ensemble, path: str | Path, *, wall_seconds: float = 0.0) -> Ensemble:
    """Write an ensemble in memory to a file, in one atomic step; never over another one.

    Parameters
    ----------
    ensemble : Ensemble
        With all surfaces of its scene.
    path : str or Path
        The file.
    wall_seconds : float, optional
        What making it took.

    Returns
    -------
    Ensemble
        That reads from the file.

    Raises
    ------
    StoreError
        If the place cannot be written, another process writes there, or another ensemble, or a run that
        is not finished, has it.
    RunError
        If the disk does not take it.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> e = mcgw.simulate(scene)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     mcgw.save(e, f"{folder}/e.h5").n_surfaces
    20
    """
    check_object("save", ensemble, Ensemble)
    path = Path(path)
    check_output(path)
    with locked(parts_of(path)):
        if (parts_of(path) / "run.toml").exists():
            raise StoreError(
                f"{path}: a run that makes this file is not finished; finish it, choose another -o, "
                f"or remove {parts_of(path)}"
            )
        before, asked = state_of(path), (ensemble.scene, ensemble.sampler)
        finished(path, *asked)
        about = {"run": identity_of(*asked), "draws": versions(of_draws=True), "wall_seconds": wall_seconds}
        write = body_of
        if ensemble.scene.keep == "statistics":
            from mcgw.store.statistics_file import body_of_statistics as write  # for those scenes alone
        write_body(path, write(ensemble, **about), before)
    return open_ensemble(path)


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
    with open_h5(path) as file:
        if file.attrs["digest"] != digest:
            raise OSError(f"{path}: was not written correctly")
        notes = {"head": head_digest(file)}
    length = path.stat().st_size
    raw.trailer(Trailer(length, sha256_of(path, length), notes).to_bytes())


def _pieces(
    target: Path, shards: list[Shard], go_on: Callable[[], None]
) -> Items[tuple[Span, Mapping[str, h5py.Dataset]]]:
    """All surfaces in order, packed: first those of the finished file, then those of the shards."""
    if target.exists():
        with open_h5(target) as old:
            yield Span(0, len(old["surface"])), stored_tables(old)
    with closing(one_ahead((shard, shard.body()) for shard in shards)) as bodies:
        for shard, body in bodies:
            go_on()
            with tables_in(body, shard.path) as tables:
                yield shard.span, tables


def _expected(target: Path, shards: list[Shard]) -> Iterator[tuple[Span, str]]:
    """What the numbers of all surfaces, in order, give if they are the right ones."""
    if target.exists():
        with open_h5(target) as old:
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
    with open_h5(path) as file:

        def read() -> Items[tuple[str, Tables]]:
            for span, digest in expected:
                go_on()
                for _, arrays in rows_of(file, [span]):
                    yield digest, arrays

        def compared() -> Items[Tables]:
            with closing(one_ahead(read())) as pieces:
                for digest, arrays in pieces:
                    if content_digest(arrays) != digest:
                        raise OSError(f"{path}: was not written correctly")
                    yield arrays

        with closing(one_ahead(compared())) as pieces:
            return digest_of(file, scene, pieces)


def _before(target: Path) -> tuple[int, float]:
    """Surfaces of the finished file, and the seconds they took."""
    if not target.exists():
        return 0, 0.0
    with open_h5(target) as old:
        return len(old["surface"]), float(old.attrs["wall_seconds"])
