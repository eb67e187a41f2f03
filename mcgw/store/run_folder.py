"""The folder of a run or a sweep, beside its file: ``demo.h5.parts/``.

::

    run.h5      the frozen scene, the axes of a sweep, the identity of both, the versions that draw, the
                surfaces and the size of a block of each group
    lock.db     held by whoever writes the file, freed by the system when it dies (`lock`)
    holder      who that is
    shards/     block-0000000000042.h5: the surfaces from number 42 on

All are files of the one writer. A shard holds the results of some consecutive surfaces and is there whole or
not; its attributes are the identity of the run, the numbers of the surfaces, and how long these took. The set
of valid shards is the only record of progress.
"""

import shutil
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.labelled import Variable
from mcgw.ensemble.results import BLOCK, Tables
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import Expected, sync, whole_file
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from
from mcgw.scene.section import SceneError
from mcgw.store.h5_reading import look, read_tables
from mcgw.store.h5_writing import BLOCK_TYPE, FORMAT, RUN_TYPE, Contents, write
from mcgw.store.identity import difference
from mcgw.store.lock import refuse_link


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
        """Return the group that some surfaces are of, and the number of the first one within it."""
        g = bisect_right(self._starts, span.first) - 1
        return g, span.first - self._starts[g]

    def number(self, span: Span) -> int:
        """Return the number of the block, of all, that some surfaces are of."""
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


RECORD = "run.h5"


@dataclass(frozen=True)
class Shard:
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

    def tables(self, *wanted: str) -> Tables:
        """Its tables, all or some, read and compared with their checksums.

        Raises
        ------
        StoreError
            If it was damaged or removed since.
        """
        if not self.path.exists():
            raise StoreError(f"{self.path}: no longer exists; its run has ended, open the file again")
        return read_tables(self.path, wanted or None)


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
        if len(values) != (1 if name.startswith(BLOCK) else span.n):
            raise StoreError(f"{path}: {name} does not have the rows of {span}")
        if not np.all(np.isfinite(values)):
            raise StoreError(f"{path}: {name} holds numbers that are not finite")
    about = {"filetype": BLOCK_TYPE, "format": FORMAT, "run": run, "first": span.first, "n": span.n}
    _write_tables(path, tables, {**about, "wall_seconds": seconds})
    return Shard(path, span, seconds)


def _write_tables(path: Path, tables: Tables, about: dict[str, Any], expected: Expected = "anything") -> None:
    variables = {name: Variable((), values, "", "") for name, values in tables.items()}
    with whole_file(path, expected=expected) as temporary:
        write(temporary, Contents(variables, about))


def open_shard(path: Path, run: str, *, numbers: bool = True) -> Shard:
    """Return a shard of this run; its numbers are compared with their checksums unless that is left out.

    Raises
    ------
    StoreError
        If it is not there, damaged, or belongs elsewhere.
    """
    said = look(path, BLOCK_TYPE, numbers=numbers)
    if said["run"] != run:
        raise StoreError(f"{path}: belongs to another run")
    shard = Shard(path, Span(said["first"], said["n"]), said["wall_seconds"])
    if path.name != shard.span.file_name:
        raise StoreError(f"{path}: holds {shard.span}, unlike its name")
    return shard


@dataclass(frozen=True)
class RunFolder:
    """The folder of a run, open.

    Parameters
    ----------
    folder : Path
        Where it lies.
    text : str
        The scene, frozen but for the number of surfaces; of a sweep what all points have in common.
    axes : str
        Of a sweep, as JSON; empty for a run.
    sampler : str
        Never "auto"; empty for a sweep.
    plan : Plan
        Blocks of the surfaces that are asked for.
    identity : str
        See `identity_of`.
    drawn_with : str
        Versions that draw.
    date : str
        When it began.
    """

    folder: Path
    text: str
    axes: str
    sampler: str
    plan: Plan
    identity: str
    drawn_with: str
    date: str

    @cached_property
    def scene(self) -> Scene:
        """What is drawn; of a sweep what its points come from."""
        return scene_from(self.text)

    @cached_property
    def path(self) -> Path:
        """The file that it makes."""
        return self.folder.with_name(self.folder.name.removesuffix(".parts"))  # of `parts_of`

    @property
    def shards_folder(self) -> Path:
        """Where the shards lie."""
        return self.folder / "shards"

    def begin(self) -> "RunFolder":
        """Begin this run, or go on with the one that is there. Only with the lock.

        Raises
        ------
        StoreError
            If it belongs to another scene, seed or version, or is not a folder of a run.
        """
        refuse_link(self.folder)
        self.shards_folder.mkdir(parents=True, exist_ok=True)
        sync(self.folder.parent)
        with suppress(FileExistsError):
            self._write(expected=None)
            return self
        try:
            old = RunFolder.open(self.folder)
        except StoreError:
            if not self.shards(numbers=False):
                raise
            self._write(expected="anything")  # its blocks say that they are of this very run
            return self
        if old.identity != self.identity:
            there, here = ((run.text, run.axes, run.drawn_with) for run in (old, self))
            raise StoreError(
                f"{self.folder}: holds a different {'sweep' if self.axes else 'run'}: "
                f"{difference(there, here)}; choose another -o, or remove it"
            )
        sizes = zip(self.plan.groups, old.plan.groups, strict=True)
        plan = replace(self.plan, groups=tuple((n, size) for (n, _), (_, size) in sizes))
        return replace(self, plan=plan, date=old.date)

    def _write(self, *, expected: Expected) -> None:
        about = {
            "filetype": RUN_TYPE,
            "format": FORMAT,
            "run": self.identity,
            "sampler": self.sampler,
            "draws": self.drawn_with,
            "date": self.date,
            "axes": self.axes,
            "scene": self.text,
        }
        blocks = {"blocks": np.array(self.plan.groups, dtype=np.int64)}
        _write_tables(self.folder / RECORD, blocks, about, expected)

    def freeze(self) -> None:
        """Record how many surfaces are wanted now."""
        if RunFolder.open(self.folder).text != self.text:
            self._write(expected="anything")

    @classmethod
    def open(cls, folder: Path) -> "RunFolder":
        """Read what a run is.

        Raises
        ------
        StoreError
            If there is none, or it cannot be read.
        """
        refuse_link(folder)
        file = folder / RECORD
        try:
            said, blocks = look(file, RUN_TYPE), read_tables(file)["blocks"].tolist()
            scene, axes = str(said["scene"]), str(said["axes"])
            whole = bool(axes) or scene_from(scene).keep == "statistics"
            known = (str(said[key]) for key in ("run", "draws", "date"))
            plan = Plan(tuple((int(n), int(size)) for n, size in blocks), whole)
            return cls(folder, scene, axes, str(said["sampler"]), plan, *known)
        except (StoreError, SceneError, KeyError, ValueError) as error:
            if not file.is_file():
                raise StoreError(f"{file}: there is none") from None
            what = str(error).splitlines()[0].removeprefix(f"{file}: ")
            raise StoreError(
                f"{file}: {what}; the blocks beside it are kept: resume with mcgw run or mcgw sweep, with "
                f"their scene and seed, or remove {folder}"
            ) from None

    def shards(self, *, numbers: bool = True) -> list[Shard]:
        """Return valid shards in order, each looked at; or its head alone, without the `numbers`."""
        return [shard for shard, _ in self._looked_at(numbers=numbers) if shard]

    def sweep(self) -> list[Shard]:
        """As `shards`; whatever else lies there is put aside. Only with the lock."""
        for left in (*self.folder.glob(".*.tmp"), *self.shards_folder.glob(".*.tmp")):
            left.unlink(missing_ok=True)
        valid = []
        for shard, path in self._looked_at():
            if shard:
                valid.append(shard)
            else:
                path.rename(path.with_name(f"{path.name}.bad"))
        return valid

    def _looked_at(self, *, numbers: bool = True) -> Iterator[tuple[Shard | None, Path]]:
        if not self.shards_folder.is_dir():
            raise RunError(f"{self.folder}: is missing or incomplete; run the command again")
        for path in sorted(self.shards_folder.glob("block-*.h5")):
            try:
                shard = None if path.is_symlink() else open_shard(path, self.identity, numbers=numbers)
                yield (shard if shard and self.plan.takes(shard.span) else None), path
            except StoreError:
                yield None, path

    def held(self, span: Span) -> Shard | None:
        """Return the valid shard of a block, if there is one."""
        path = self.shards_folder / span.file_name
        if path.is_symlink() or not path.is_file():
            return None
        try:
            shard = open_shard(path, self.identity)
        except StoreError:
            return None
        return shard if shard.span == span else None

    def missing(self, done: int, shards: Iterable[Shard]) -> list[Span]:
        """Blocks that neither the file, of `done` surfaces, nor one of the shards holds."""
        done = self.plan.kept(done)
        held = [*([Span(0, done)] if done else []), *(shard.span for shard in shards)]
        return self.plan.missing(held)


def remove_run(folder: Path) -> None:
    """Remove a run, readable or not; its lock stays, and with it the folder. Only with the lock."""
    shutil.rmtree(folder / "shards", ignore_errors=True)  # a worker that lost its driver may add to it
    for left in (*folder.glob(".*.tmp"), folder / RECORD):
        left.unlink(missing_ok=True)
