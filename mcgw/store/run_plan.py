"""What is drawn into a file, points x blocks; and its folder, beside the file: ``demo.h5.parts/``.

::

    run.h5      the frozen scene, the axes of a sweep, the identity of both, the versions that draw
    lock.db     held by whoever writes the file, freed by the system when it dies (`lock`)
    holder      who that is
    shards/     block-0000000000042.h5: the surfaces from number 42 on

All are files of the one writer. A shard holds the results of some consecutive surfaces and is there whole or
not; its attributes are the identity of the run, the numbers of the surfaces, and how long these took. The set
of valid shards is the only record of progress.
"""

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property, partial
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import tomli_w

from mcgw.ensemble.drawing import GoOn, Values, reducer_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import GROUP, Labelled, Results, Rows, Tables, Variable
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import Expected, check_output, parts_of, sync, whole_file
from mcgw.machine.threads import use_threads
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_from
from mcgw.store.h5_reading import look, read_rows, read_tables
from mcgw.store.h5_writing import BLOCK_TYPE, FILETYPE, FORMAT, MOST_TEXT, RUN_TYPE, write
from mcgw.store.ownership import another, provenance, refuse_link, versions

if TYPE_CHECKING:
    from mcgw.sweeps.points import Points

RECORD = "run.h5"


@dataclass(frozen=True, order=True)
class Span:
    """Surfaces `first` ... `first + n - 1`: a block."""

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
    """Cut the surfaces of groups, of (surfaces, surfaces of a block), into blocks; the last may be short.

    Of each block follow the group that it is of, and the number of its first surface in there.
    """
    found, first = dict[Span, tuple[int, int]](), 0
    for group, (n, size) in enumerate(groups):
        for start in range(0, n, size):
            found[Span(first + start, min(size, n - start))] = group, start
        first += n
    return found


def commit_shard(path: Path, run: str, span: Span, tables: Tables, seconds: float) -> None:
    """Write a shard of a run in one atomic step, with the seconds that drawing it took."""
    for name, values in tables.items():
        if not np.all(np.isfinite(values)):
            raise StoreError(f"{path}: {name} holds numbers that are not finite")
    about = {"filetype": BLOCK_TYPE, "format": FORMAT, "run": run, "first": span.first, "n": span.n}
    _write(path, tables, {**about, "wall_seconds": seconds})


def _write(path: Path, tables: Tables, about: dict[str, Any], expected: Expected = "anything") -> None:
    variables = {name: Variable((), values, "", "") for name, values in tables.items()}
    with whole_file(path, expected=expected) as temporary:
        write(temporary, Labelled(variables, {}, about), chunked=False)


def in_files(files: Sequence[tuple[Path, int]], names: Iterable[str], together: int = 1) -> Results:
    """Return values that lie in files, of so many surfaces each; they are read when they are asked for."""
    total = sum(n for _, n in files)
    return Results({name: Rows(total, partial(read_rows, files, name), together) for name in names})


class Plan:
    """What is drawn into a file: a scene of so many surfaces, or groups of scenes that share their surfaces.

    `sampler` is what has drawn the scene, by default its own; `recorded` the identity of a run that began,
    and the versions that drew then.
    """

    def __init__(
        self, asked: "Scene | Points", path: Path, sampler: str = "", recorded: tuple[str, str] | None = None
    ) -> None:
        if not recorded:
            check_output(path)
        self.asked, self.path, self.folder = asked, path, parts_of(path)
        self.shards_folder, draws = self.folder / "shards", versions()
        if isinstance(asked, Scene):
            document = scene_document(asked)
            self.scene, self.axes, self.text = asked, "", tomli_w.dumps(document)
            if len(self.text.encode()) > MOST_TEXT:
                raise StoreError(
                    f"scene: its lists need {len(self.text)} characters, but a file of results holds at most "
                    f"{MOST_TEXT}; list fewer summits, or simulate in memory"
                )
            document["ensemble"] |= {"n_asperities": asked.n_asperities}  # whoever gave it
            del document["ensemble"]["n_surfaces"]
            key = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
            self.sampler = sampler or self.reducers[0].sampler.name
            words, self.of_all = (key, self.sampler), f"{key} {asked.n_surfaces}"
        else:
            self.text, self.axes = words = asked.texts()
            self.scene, self.sampler, self.of_all = scene_from(self.text), "", "\0".join(words)
        now = hashlib.sha256("\0".join((*words, draws)).encode()).hexdigest()
        self.identity, self.drawn_with = recorded or (now, draws)
        self.question = self.text, self.axes, self.drawn_with  # what its numbers depend on, in words
        self.statistics = bool(self.axes) or self.scene.keep == "statistics"  # of no surface anything is kept

    @classmethod
    def open(cls, folder: Path) -> "Plan":
        """Return the one that a folder records."""
        refuse_link(folder)
        file, path = folder / RECORD, folder.with_name(folder.name.removesuffix(".parts"))  # of `parts_of`
        if not file.is_file():
            raise StoreError(f"{file}: there is none")
        try:
            said = look(file, RUN_TYPE)
            text, sampler, run, draws = (str(said[key]) for key in ("scene", "sampler", "run", "draws"))
            if "axes" not in said:
                return cls(scene_from(text), path, sampler, (run, draws))
            from mcgw.sweeps.points import Points  # of which most runs are none

            return cls(Points.from_texts(text, str(said["axes"])), path, sampler, (run, draws))
        except (KeyError, ValueError) as error:
            what = str(error).splitlines()[0].removeprefix(f"{file}: ")
            raise StoreError(
                f"{file}: {what}; the blocks beside it are kept: resume with mcgw run or mcgw sweep, with "
                f"their scene and seed, or remove {folder}"
            ) from None

    @cached_property
    def reducers(self) -> tuple[Values, ...]:
        """What draws each group, and what of it is kept; a scene is one group."""
        if not isinstance(self.asked, Scene):
            return tuple(self.asked.groups)
        return (reducer_of(self.asked),)

    @cached_property
    def blocks(self) -> dict[Span, tuple[int, int]]:
        """Blocks of the surfaces that are asked for, of which group each is and where it begins there."""
        return blocks_of((one.scene.n_surfaces, one.rows) for one in self.reducers)

    @cached_property
    def total(self) -> int:
        """Surfaces of all groups."""
        return sum(one.scene.n_surfaces for one in self.reducers)

    def draw(self, span: Span, threads: int | None, *go_on: GoOn) -> Tables:
        """Return what is kept of some surfaces of one group; it does not depend on `threads`."""
        group, first = self.blocks[span] if self.axes else (0, span.first)
        with use_threads(threads):
            return self.reducers[group].tables(first, first + span.n, *go_on)

    def held(
        self, spans: Iterable[Span], kept: int = 0, check: Callable[[], None] | None = None
    ) -> list[Any]:
        """Return what is held of each group in blocks, after the first surfaces of the file that are kept."""
        if not self.statistics:
            files = [(self.path, kept)] * (kept > 0) + [(self.shard_path(x), x.n) for x in spans]
            return [in_files(files, self.scene.tables, self.reducers[0].rows)]

        def blocks() -> Iterator[tuple[int, Tables]]:
            """Statistics, each with the group that they are of."""
            if kept:
                yield 0, read_tables(self.path, GROUP)
            for span in spans:
                if check:
                    check()
                yield self.blocks[span][0] if self.axes else 0, read_tables(self.shard_path(span))

        groups = zip(self.reducers, groupby(blocks(), itemgetter(0)), strict=True)
        return [one.held(tables for _, tables in some) for one, (_, some) in groups]

    def contents(self, held: list[Any], seconds: float) -> Labelled:
        """Return those of the file, of what is held of each group, with how long it took."""
        if isinstance(self.asked, Scene):
            found = Ensemble(self.scene, self.sampler, *held).labelled()
        else:
            found = self.asked.answered(held).labelled().numbered()
        about = {**self._about(FILETYPE), "title": self.scene.title, "seed": np.uint64(self.scene.seed)}
        about |= {**provenance(), "wall_seconds": seconds}
        if self.scene.accuracy:
            from mcgw.sampling.samplers import distance_of  # for those scenes alone

            about["accuracy_spent"] = distance_of(self.scene)  # how far from the exact laws it went
        return replace(found, attributes={**found.attributes, **about})

    def _about(self, filetype: str) -> dict[str, Any]:
        about = {"filetype": filetype, "format": FORMAT, "scene": self.text, "sampler": self.sampler}
        date = datetime.now(UTC).isoformat(timespec="seconds")
        about |= {"run": self.identity, "draws": self.drawn_with, "date": date}
        return {**about, "axes": self.axes} if self.axes else about

    def begin(self) -> None:
        """Begin, or go on in the folder that is there; if more is wanted, that is recorded. With the lock."""
        refuse_link(self.folder)
        self.shards_folder.mkdir(parents=True, exist_ok=True)
        sync(self.folder.parent)
        record = partial(_write, self.folder / RECORD, {}, self._about(RUN_TYPE))
        with suppress(FileExistsError):
            return record(None)
        try:
            old = Plan.open(self.folder)
        except StoreError:
            if not self.shards(numbers=False):
                raise
            return record()  # its blocks say that they are of this very run
        if old.identity != self.identity:
            raise another(self.folder, "sweep" if self.axes else "run", old.question, self.question)
        more = self.scene.n_surfaces > old.scene.n_surfaces
        return record() if more else None

    def shards(self, *, numbers: bool = True) -> dict[Span, float]:
        """Return the blocks in valid shards, and seconds of each; without `numbers` by their heads alone."""
        if not self.shards_folder.is_dir():
            raise RunError(f"{self.folder}: is missing or incomplete; run the command again")
        looked = (self.shard(path, numbers=numbers) for path in sorted(self.shards_folder.glob("block-*.h5")))
        return dict(shard for shard in looked if shard)

    def shard(self, path: Path, *, numbers: bool = True) -> tuple[Span, float] | None:
        """Return the block of a shard and its seconds, if it is there, whole, of this run and of use."""
        try:
            said = {} if path.is_symlink() else look(path, BLOCK_TYPE, numbers=numbers)
            span, seconds, run = Span(said["first"], said["n"]), said["wall_seconds"], said["run"]
        except (StoreError, KeyError):
            return None
        rows, its_own = self.reducers[0].rows, run == self.identity and path.name == span.file_name
        of_more = not self.axes and span.n == rows and span.first % rows == 0  # the scene with more surfaces
        return (span, seconds) if its_own and (span in self.blocks or of_more) else None

    def shard_path(self, span: Span) -> Path:
        """Where the shard of a block lies, or would."""
        return self.shards_folder / span.file_name

    def kept(self, done: int) -> int:
        """Of the first surfaces, that a file holds, those in whole blocks: any others are drawn again."""
        return max((span.stop for span in self.blocks if span.stop <= done), default=0)

    def missing(self, done: int, shards: Iterable[Span]) -> list[Span]:
        """Blocks that neither the file, of `done` surfaces, nor one of the shards holds."""
        done, held = self.kept(done), {span.first for span in shards}
        return [span for span in self.blocks if span.stop > done and span.first not in held]
