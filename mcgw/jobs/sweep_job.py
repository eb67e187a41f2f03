"""A sweep on its way into a file: groups of points that share their surfaces, drawn block by block."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

from mcgw.ensemble.drawing import use_threads
from mcgw.formats.files import check_output
from mcgw.jobs.job import Making
from mcgw.sampling.samplers import name_of
from mcgw.sampling.shared import Alone, Shared, shared
from mcgw.store.arithmetic import drawn_with
from mcgw.store.ensembles import held_by
from mcgw.store.plan import Plan
from mcgw.store.provenance import now
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Span, Tables
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.drawing import check_memory_of, plan_of, pooled_of, work_of
from mcgw.sweeps.file import write_sweep
from mcgw.sweeps.pooled import Pooled

__all__ = ["SweepJob"]


@dataclass(frozen=True)
class SweepJob(Making):
    """What is asked of many points at once, and where it goes.

    Parameters
    ----------
    asked : Asked
        The question.
    path : Path
        The file to be.
    """

    asked: Asked
    path: Path

    @classmethod
    def of(cls, asked: Asked, path: Path) -> "SweepJob":
        """Prepare it, everything checked.

        Raises
        ------
        SceneError
            With the mistakes of all points.
        StoreError
            If the place belongs to something else, or the memory does not suffice.
        """
        check_memory_of(asked.groups)
        check_output(path)
        job = cls(asked, path)
        job.done()
        return job

    @cached_property
    def plan(self) -> Plan:
        """Blocks of all surfaces that are asked for."""
        return plan_of(self.asked.groups)

    @cached_property
    def record(self) -> RunFolder:
        """What is drawn, and in which blocks, as its folder will say it."""
        known = {drawn_with(scene, name_of(scene)) for group in self.asked.groups for scene in group.computed}
        draws, texts = max(known, key=len), self.asked.texts()  # with the kind of processor, if any has it
        identity = hashlib.sha256("\0".join((*texts, draws)).encode()).hexdigest()
        return RunFolder(self.folder, *texts, "", self.plan, identity, draws, now())

    def done(self) -> int:
        """Surfaces that its file holds: all or none."""
        return held_by(self.path, self.record)

    def draw(self, span: Span, threads: int | None) -> Tables:
        """What is kept of some surfaces of one group."""
        g, first = self.plan.group(span)
        with use_threads(threads):
            return pooled_of(self.asked.groups[g], self._source(g), first, span.n).shard()

    def write(self, tables: Tables, seconds: float) -> None:
        """Write the file in one step, of all surfaces drawn as one block. Only with the lock."""
        write_sweep(self.record, self.asked, [Pooled.from_shard(tables)], self.path, wall_seconds=seconds)

    def work(self, span: Span) -> float:
        """What some surfaces of one group take, in asperities drawn."""
        return span.n * work_of(self.asked.groups[self.plan.group(span)[0]])

    @cached_property
    def _source(self) -> Callable[[int], Shared | Alone]:
        return lru_cache(maxsize=1)(self._new_source)  # blocks come group after group

    def _new_source(self, group: int) -> Shared | Alone:
        return shared(self.asked.groups[group].computed)
