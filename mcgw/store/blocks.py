"""Blocks of surfaces: which there are, and those that lie on the disk, each in a file of its own: a shard."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mcgw.ensemble.results import Labelled, Tables, Variable
from mcgw.errors import StoreError
from mcgw.formats.files import Expected, whole_file
from mcgw.store.h5_reading import look
from mcgw.store.h5_writing import BLOCK_TYPE, FORMAT, write


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


def blocks_of(groups: Iterable[tuple[int, int]]) -> dict[Span, tuple[int, int]]:
    """Cut the surfaces of groups, one group after the other, into blocks; the last one of each may be short.

    Of each group its number of surfaces is given, and how many of them make a block; of each block follow the
    group that it is of, and the number of its first surface in there.
    """
    found, first = dict[Span, tuple[int, int]](), 0
    for group, (n, size) in enumerate(groups):
        for start in range(0, n, size):
            found[Span(first + start, min(size, n - start))] = group, start
        first += n
    return found


class Shard(NamedTuple):
    """A shard that was looked at.

    Parameters
    ----------
    path : Path
        Where it lies.
    span : Span
        Its surfaces.
    seconds : float
        What drawing it took.
    """

    path: Path
    span: Span
    seconds: float


def commit_shard(path: Path, run: str, span: Span, tables: Tables, seconds: float) -> Shard:
    """Write a shard of a run in one atomic step, with the seconds that drawing it took.

    Raises
    ------
    StoreError
        If a number is not finite: nothing is written.
    OSError
        If the disk does not take it.
    """
    for name, values in tables.items():
        if not np.all(np.isfinite(values)):
            raise StoreError(f"{path}: {name} holds numbers that are not finite")
    about = {"filetype": BLOCK_TYPE, "format": FORMAT, "run": run, "first": span.first, "n": span.n}
    write_tables(path, tables, {**about, "wall_seconds": seconds})
    return Shard(path, span, seconds)


def write_tables(path: Path, tables: Tables, about: dict[str, Any], expected: Expected = "anything") -> None:
    """Write tables and attributes in one atomic step."""
    variables = {name: Variable((), values, "", "") for name, values in tables.items()}
    with whole_file(path, expected=expected) as temporary:
        write(temporary, Labelled(variables, {}, about))


def open_shard(path: Path, run: str, *, numbers: bool = True) -> Shard | None:
    """Return a shard of this run, if it is there and whole; `numbers`: and all of them are as written."""
    try:
        said = {} if path.is_symlink() else look(path, BLOCK_TYPE, numbers=numbers)
        shard = Shard(path, Span(said["first"], said["n"]), said["wall_seconds"])
    except (StoreError, KeyError):
        return None
    return shard if said["run"] == run and path.name == shard.span.file_name else None
