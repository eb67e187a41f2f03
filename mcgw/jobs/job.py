"""What is on its way into a file, asked by whoever runs it, draws a part of it, or merges it.

What a worker does: draw a block of surfaces. The same, whoever asks and however often.
"""

import hashlib
import shutil
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from analytic import PiecewiseSeries
from mcgw.ensemble.drawing import GoOn, Reducer, always, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Tables
from mcgw.ensemble.simulation import reducer_of
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import State, check_output, refuse_read_only, state_of
from mcgw.machine.memory import gibibytes
from mcgw.scene.scene import Scene, storable
from mcgw.store.ensembles import described
from mcgw.store.h5_writing import Contents
from mcgw.store.identity import Written, difference, now, versions
from mcgw.store.layout import contents_of
from mcgw.store.lock import parts_of
from mcgw.store.place import finished, recorded_scene, with_recorded_seed
from mcgw.store.run_folder import RECORD, Plan, RunFolder, Span, commit_shard

if TYPE_CHECKING:
    from mcgw.sweeps.points import Asked


@dataclass(frozen=True)
class Job:
    """A file being made: of one scene, or of groups of scenes that share their surfaces.

    Parameters
    ----------
    record : RunFolder
        What is drawn and in which blocks, as the folder beside the file will say it.
    reducers : tuple of Reducer
        What draws each group, and what of it is kept; a scene is one group.
    written : Written or None
        The scene of a run.
    """

    record: RunFolder
    reducers: tuple[Reducer, ...]
    written: Written | None = None

    @classmethod
    def of(cls, scene: Scene, path: Path) -> "Job":
        """Return that of a scene with a number of surfaces, not a rule for it.

        Raises
        ------
        StoreError
            If the scene cannot be told by a file, or none can be there.
        """
        check_output(path)
        one = reducer_of(scene)
        written = Written.of(scene, one.sampler.name)
        plan = Plan(((one.n_surfaces, one.rows),), whole=one.whole)
        known = written.identity, versions(of_draws=True), now()
        record = RunFolder(parts_of(path), written.text, "", written.sampler, plan, *known)
        return cls(record, (one,), written)

    @classmethod
    def of_sweep(cls, asked: "Asked", path: Path) -> "Job":
        """Return that of a sweep.

        Raises
        ------
        SceneError
            With the mistakes of all points.
        """
        check_output(path)
        from mcgw.sweeps.groups import Pooling  # of which most runs are none

        reducers, texts = tuple(map(Pooling, asked.groups)), asked.texts()
        plan = Plan(tuple((one.n_surfaces, one.rows) for one in reducers), whole=True)
        draws = versions(of_draws=True)
        identity = hashlib.sha256("\0".join((*texts, draws)).encode()).hexdigest()
        return cls(RunFolder(parts_of(path), *texts, "", plan, identity, draws, now()), reducers)

    @classmethod
    def again(cls, record: RunFolder) -> "Job":
        """Return what this process makes of the words of a folder, whoever wrote them."""
        if not record.axes:
            return cls.of(record.scene, record.path)
        from mcgw.sweeps.points import Asked  # of which most runs are none

        return cls.of_sweep(Asked.from_texts(record.text, record.axes), record.path)

    @cached_property
    def total(self) -> int:
        """Surfaces of all groups."""
        return sum(one.n_surfaces for one in self.reducers)

    def check(self) -> None:
        """Refuse what fits neither the place, nor the memory, nor the disk.

        Raises
        ------
        StoreError
            With the numbers, or with what is there.
        """
        path = self.record.path
        if self.done() < self.total:
            refuse_read_only(path)
        for one in self.reducers:
            one.check()
        there = [path, *self.record.folder.glob("shards/block-*.h5")]
        held = sum(file.stat().st_size for file in there if file.is_file())
        needed = sum(one.disk for one in self.reducers) - held
        free = shutil.disk_usage(path.parent).free
        if needed > free:
            raise StoreError(
                f"{path}: needs up to {gibibytes(needed)} more on the disk while made and {gibibytes(free)} "
                "are free; free some space, choose another -o, or reduce surfaces or separations"
            )

    def done(self) -> int:
        """Surfaces that its file holds; of a sweep all or none.

        Raises
        ------
        StoreError
            If the file is another's, damaged, or holds more than is asked.
        """
        run = self.record
        if self.written or not run.path.exists():
            return finished(run.path, self.written) if self.written else 0
        if described(run.path)[0].get("run") != run.identity:
            raise StoreError(
                f"{run.path}: holds something else than this sweep; choose another -o, or remove it"
            )
        return self.total

    def work(self, span: Span) -> float:
        """Return what some surfaces of one group take, in any unit."""
        return span.n * self.reducers[self.record.plan.group(span)[0]].work

    def draw(self, span: Span, threads: int | None, go_on: GoOn = always) -> Tables:
        """Return what is kept of some surfaces of one group; it does not depend on `threads`."""
        g, first = self.record.plan.group(span) if len(self.reducers) > 1 else (0, span.first)
        with use_threads(threads):
            return self.reducers[g].tables(first, first + span.n, go_on)

    def about(self, seconds: float) -> dict[str, Any]:
        """Root attributes of its file that tell of the run."""
        return {"run": self.record.identity, "draws": self.record.drawn_with, "wall_seconds": seconds}

    def contents(self, blocks: Iterable[tuple[int, Tables]], seconds: float) -> Contents:
        """Those of the file, of all blocks in their order, each with the number of its group."""
        groups = groupby(blocks, itemgetter(0))
        held = [
            one.held(tables for _, tables in some)
            for one, (_, some) in zip(self.reducers, groups, strict=True)
        ]
        run, about = self.record, self.about(seconds)
        if self.written:
            scene, sampler = self.written.scene, self.written.sampler
            return contents_of(Ensemble(scene, sampler, held[0]), self.written, **about)
        from mcgw.sweeps.file import contents_of_sweep  # of which most runs are none

        return contents_of_sweep(run, held, **about)


def as_recorded(scene: Scene, path: Path) -> Scene:
    """Return the scene with seed and functions resolved, or as they were when the run at this place began.

    Another processor, or another NumPy, may give other last digits to a Python function.
    """
    scene = with_recorded_seed(scene, path)
    resolved = storable(scene)
    there = None if resolved is scene else recorded_scene(path)
    if there is None:
        return resolved
    mine, before = resolved.grading, there.grading
    if isinstance(mine, PiecewiseSeries) and isinstance(before, PiecewiseSeries) and mine.agrees(before):
        resolved = resolved.replace(grading=before)
    if resolved.law.agrees(there.law):
        resolved = resolved.replace(law=there.law)
    return resolved


def commit_block(folder: str, first: int, n: int) -> None:
    """Draw a block of a run into its folder, unless a valid shard is there."""
    draw_block(folder, first, n)()


def draw_block(
    folder: str, first: int, n: int, threads: int | None = 1, go_on: GoOn = always
) -> Callable[[], object]:
    """Do the first half of `commit_block`; what it returns is the second, to be done beside the next."""
    run, job = _prepared(folder, state_of(Path(folder) / RECORD))
    span = Span(first, n)
    if run.held(span):
        return lambda: None
    started = perf_counter()
    tables = job.draw(span, threads, go_on)
    path, seconds = run.shards_folder / span.file_name, perf_counter() - started
    return lambda: commit_shard(path, run.identity, span, tables, seconds)


@lru_cache(maxsize=1)
def _prepared(folder: str, _state: State | None) -> tuple[RunFolder, Job]:
    """Return a run and its job, kept while its record is the same: preparing may take as long as a block."""
    run = RunFolder.open(Path(folder))
    job = Job.again(run)
    if job.record.identity != run.identity:
        there, here = ((x.text, x.axes, x.drawn_with) for x in (run, job.record))
        raise RunError(f"{folder}: this worker cannot draw for that run: {difference(there, here)}")
    return run, job
