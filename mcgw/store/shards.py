"""A shard: the results of some consecutive surfaces as one HDF5 file with a trailer.

The file is made in memory and written by plain system calls: the HDF5 library never touches the disk
while a block is committed, so that a full disk is an error like any other. The trailer carries the
identity of the run, the numbers of the surfaces and a digest of the contents (names, types, shapes,
values), which does not depend on how HDF5 laid out the file.

Which surfaces are drawn together (`Plan`): blocks, numbered through all groups of surfaces that are asked
for.
"""

import hashlib
import io
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from pathlib import Path

import h5py
import numpy as np

from mcgw.ensemble.results import BLOCK, Tables
from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.store.chunks import stored
from mcgw.store.disk import Trailer, read_checked, read_trailer, trailer_of

LIBVER = ("v108", "v110")  # checksums on all metadata, and every HDF5 of the last decade reads it
_MOST_DATASETS = 64


@dataclass(frozen=True, order=True)
class Span:
    """Surfaces `first` ... `first + n - 1`."""

    first: int
    n: int

    @property
    def stop(self) -> int:
        """The surface after the last one."""
        return self.first + self.n

    @property
    def file_name(self) -> str:
        """Name of its shard."""
        return f"block-{self.first:013d}.h5"

    def __str__(self) -> str:
        return f"surfaces {self.first} ... {self.stop - 1}"


@dataclass(frozen=True)
class Shard:
    """A shard whose trailer was checked.

    Parameters
    ----------
    path : Path
        Where it lies.
    span : Span
        Its surfaces.
    digest : str
        Of its contents.
    seconds : float
        What drawing it took.
    """

    path: Path
    span: Span
    digest: str
    seconds: float

    def arrays(self) -> Tables:
        """Its contents, read and checked again.

        Raises
        ------
        StoreError
            If it was damaged or replaced since.
        """
        with tables_in(self.body(), self.path) as tables:
            try:
                arrays = {name: table[()] for name, table in tables.items()}
            except (OSError, RuntimeError) as error:
                raise StoreError(f"{self.path}: damaged ({error})") from None
        if content_digest(arrays) != self.digest:
            raise StoreError(f"{self.path}: damaged (checksum mismatch of its contents)")
        _check_rows(self, arrays)
        return arrays

    def body(self) -> bytes:
        """Its HDF5 file, read and checked again, bit by bit.

        Raises
        ------
        StoreError
            If it was damaged or replaced since.
        """
        return read_checked(self.path)[1]


def pack(arrays: Tables) -> bytes:
    """HDF5 file with these arrays, in memory.

    By a Python file object, as all files made in memory: in the file image of an HDF5 before 2.0 the checksum
    of the superblock does not hold, and the file cannot be opened.
    """
    body = io.BytesIO()
    with h5py.File(body, "w", libver=LIBVER) as file:
        for name in sorted(arrays):
            stored(file, name, arrays[name])
    return body.getvalue()


def commit_shard(path: Path, run: str, span: Span, arrays: Tables, seconds: float) -> Shard:
    """Write a shard of a run in one atomic step, with the seconds that drawing it took.

    Raises
    ------
    StoreError
        If a number is not finite: nothing is written.
    OSError
        If the disk does not take it.
    """
    shard = Shard(path, span, content_digest(arrays), seconds)
    _check_rows(shard, arrays)
    body = pack(arrays)
    notes = {"run": run, "first": span.first, "n": span.n, "content": shard.digest, "seconds": seconds}
    write_whole(path, (body, trailer_of(body, **notes)))
    return shard


def open_shard(path: Path, run: str, *, body: bool = True) -> Shard:
    """A shard of this run, its body checked bit by bit unless that is left out; HDF5 is not asked.

    Raises
    ------
    StoreError
        If it is not there, damaged, or belongs elsewhere.
    """
    shard, identity = _described(path, read_checked(path)[0] if body else read_trailer(path))
    if identity != run:
        raise StoreError(f"{path}: belongs to another run")
    if path.name != shard.span.file_name:
        raise StoreError(f"{path}: holds {shard.span}, unlike its name")
    return shard


def content_digest(arrays: Tables) -> str:
    """SHA-256 over names, types, shapes and values."""
    sha = hashlib.sha256()
    for name in sorted(arrays):
        values = np.ascontiguousarray(arrays[name])
        sha.update(f"{name} {values.dtype.str} {values.shape}\n".encode())
        sha.update(values.data.cast("B") if values.size else b"")
    return sha.hexdigest()


def _described(path: Path, trailer: Trailer) -> tuple[Shard, str]:
    try:
        notes = trailer.notes
        span = Span(int(notes["first"]), int(notes["n"]))
        shard = Shard(path, span, str(notes["content"]), float(notes["seconds"]))
        identity = str(notes["run"])
    except (KeyError, TypeError, ValueError):
        raise StoreError(f"{path}: is not a shard") from None
    if span.first < 0 or span.n < 1:
        raise StoreError(f"{path}: is not a shard")
    return shard, identity


@contextmanager
def tables_in(body: bytes, path: Path) -> Iterator[dict[str, h5py.Dataset]]:
    """Tables of an HDF5 file in memory that must be as `pack` makes it; errors name `path`.

    Raises
    ------
    StoreError
        If it is not.
    """
    from mcgw.store.structure import RefusedError, check_plain

    with ExitStack() as opened:
        try:
            file = opened.enter_context(h5py.File(io.BytesIO(body), "r"))
            tables = {name: file[name] for name in check_plain(file, most=_MOST_DATASETS)}
        except (OSError, RuntimeError, ValueError, RefusedError) as error:
            raise StoreError(f"{path}: is not a shard ({error})") from None
        yield tables


def _check_rows(shard: Shard, arrays: Tables) -> None:
    for name, values in arrays.items():
        if len(values) != (1 if name.startswith(BLOCK) else shard.span.n):
            raise StoreError(f"{shard.path}: {name} does not have the rows of {shard.span}")
        if not np.all(np.isfinite(values)):
            raise StoreError(f"{shard.path}: {name} holds numbers that are not finite")


@dataclass(frozen=True)
class Plan:
    """Surfaces of one or more groups, one group after the other, cut into blocks.

    Parameters
    ----------
    groups : tuple of (int, int)
        Of each group its number of surfaces, and how many of them make a block; a run has one group.
    whole : bool
        Whether a block is of use as a whole only, since nothing is kept of a single surface.
    """

    groups: tuple[tuple[int, int], ...]
    whole: bool = False

    @cached_property
    def _starts(self) -> list[int]:
        """First surfaces of the groups."""
        return list(accumulate((n for n, _ in self.groups[:-1]), initial=0))

    @property
    def total(self) -> int:
        """Number of surfaces of all groups."""
        return self._starts[-1] + self.groups[-1][0]

    def group(self, span: Span) -> tuple[int, int]:
        """The group that some surfaces are of, and the number of the first one within it."""
        g = bisect_right(self._starts, span.first) - 1
        return g, span.first - self._starts[g]

    def number(self, span: Span) -> int:
        """The number of the block, of all, that some surfaces are of."""
        g, first = self.group(span)
        return sum(-(-n // size) for n, size in self.groups[:g]) + first // self.groups[g][1]

    def missing(self, held: Iterable[Span]) -> list[Span]:
        """Blocks that fill what is not held, cut where a block ends."""
        gaps, stop, total = list[Span](), 0, self.total
        for span in (*sorted(held), Span(total, 1)):
            while stop < min(span.first, total):
                g, first = self.group(Span(stop, 1))
                n, size = self.groups[g]
                end = min(span.first, self._starts[g] + min((first // size + 1) * size, n))
                gaps.append(Span(stop, end - stop))
                stop = end
            stop = max(stop, span.stop)
        return gaps

    def kept(self, done: int) -> int:
        """Of the first surfaces, that a file holds, those that it need not be given again."""
        if not self.whole or done >= self.total:
            return done
        return done - self.group(Span(done, 1))[1] % self.groups[0][1]

    def takes(self, span: Span) -> bool:
        """Whether a shard of these surfaces is of use."""
        if not self.whole:
            return True
        g, first = self.group(span)
        n, size = self.groups[g]
        return first % size == 0 and (span.n == size or first + span.n == n)
