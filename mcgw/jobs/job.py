"""A scene on its way into a file: asked by whoever runs it, draws a part of it, or merges it."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from analytic import PiecewiseSeries
from mcgw.ensemble.drawing import block_size, drawn_blocks, kept, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, MemoryResults, joined
from mcgw.errors import StoreError
from mcgw.formats.files import check_output
from mcgw.jobs.disk_space import check_disk, check_space
from mcgw.sampling.samplers import Sampler, sampler_of
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from
from mcgw.scene.storable import storable
from mcgw.store.chunks import CHUNK_ROWS
from mcgw.store.ensembles import finished, recorded_scene
from mcgw.store.layout import stored_text
from mcgw.store.plan import Plan
from mcgw.store.run_folder import RunFolder, parts_of
from mcgw.store.saving import write_ensemble
from mcgw.store.shards import Span, Tables

if TYPE_CHECKING:
    from mcgw.ensemble.bins import Bins

__all__ = ["Job", "Making", "as_recorded"]

_BYTES = 2**23  # of a shard: large enough that its flushing costs little
_DRAWS = 4e8  # numbers drawn for a shard: a second or so
_OUTSIDE = 3  # numbers kept of an asperity outside the cells: surface, height, weight


class Making(ABC):
    """A file in the making, of one scene or of the points of a sweep: what the loop over blocks asks."""

    path: Path

    @property
    @abstractmethod
    def plan(self) -> Plan:
        """Blocks of all surfaces that are asked for."""

    @property
    @abstractmethod
    def record(self) -> RunFolder:
        """What is drawn, and in which blocks, as its folder will say it."""

    @property
    def folder(self) -> Path:
        """Where its blocks lie while it runs."""
        return parts_of(self.path)

    @abstractmethod
    def done(self) -> int:
        """Surfaces that its file holds.

        Raises
        ------
        StoreError
            If the file is another's, damaged, or holds more than is asked.
        """

    @abstractmethod
    def draw(self, span: Span, threads: int | None) -> Tables:
        """What is kept of some surfaces, in pieces that fit the memory; it does not depend on `threads`."""

    @abstractmethod
    def write(self, tables: Tables, seconds: float) -> None:
        """Write the file in one step, of all surfaces drawn as one block. Only with the lock."""

    def work(self, span: Span) -> float:
        """What some surfaces take, in any unit."""
        return span.n


@dataclass(frozen=True)
class Job(Making):
    """One scene: what is drawn, by what, in which pieces, and where it goes.

    Parameters
    ----------
    scene : Scene
        With a number of surfaces, not a rule for it.
    sampler : Sampler
        The scene's.
    path : Path
        The file to be. Until it is there, blocks lie in `folder`.
    """

    scene: Scene
    sampler: Sampler
    path: Path

    @classmethod
    def of(cls, scene: Scene, path: Path) -> "Job":
        """Prepare a job, everything checked.

        Raises
        ------
        StoreError
            If the scene cannot be told by a file, the place belongs to something else, or the memory or the
            disk does not suffice.
        """
        _check_readable(scene, path)
        job = cls(scene, sampler_of(scene), path)
        check_output(path)
        job.done()
        job._check_space()
        return job

    def _check_space(self) -> None:
        """Refuse what does not fit the memory or the disk."""
        if self.scene.keep == "statistics":
            from mcgw.ensemble.summarising import check_width, stored_bytes  # for those scenes alone

            check_width(self.scene)
            check_disk(self.path, stored_bytes(self.scene, self.rows) - self._bytes())
        else:
            check_space(self.scene, self.path, rows=self.rows, columns=self.columns, held=self._bytes())

    @cached_property
    def record(self) -> RunFolder:
        """What is drawn, and in which blocks, as its folder will say it."""
        return RunFolder.of(self.folder, self.scene, self.sampler.name, self.plan)

    @cached_property
    def plan(self) -> Plan:
        """Blocks of all surfaces that are asked for."""
        return Plan(((self.scene.n_surfaces, self.rows),), whole=self.scene.keep == "statistics")

    @cached_property
    def rows(self) -> int:
        """Surfaces a block: a function of the scene alone, however many of them are asked; whole chunks."""
        if self.scene.keep == "statistics":
            from mcgw.ensemble.summarising import block_rows  # for those scenes alone

            return block_rows(self.scene, self.sampler)
        size, row = block_size(self.scene, self.sampler), 8 * self.columns
        fitting = min(_BYTES / (size * row), _DRAWS / (size * (self.sampler.draws + 1)))
        rows = size * int(max(fitting, 1))
        return rows - rows % CHUNK_ROWS if rows > CHUNK_ROWS else rows

    @property
    def columns(self) -> int:
        """Numbers kept of a surface."""
        sums = self.scene.width
        if self.scene.keep != "moments":
            return sums
        return sums + self.sampler.moments + self.sampler.cells + _OUTSIDE

    def done(self) -> int:
        """Surfaces that its file holds."""
        return finished(self.path, self.scene, self.sampler.name)

    def draw(self, span: Span, threads: int | None) -> Tables:
        """Results of some surfaces, in pieces that fit the memory; they do not depend on `threads`."""
        size = block_size(self.scene, self.sampler)
        with use_threads(threads):
            if self.scene.keep == "statistics":
                from mcgw.ensemble.summarising import summary_of  # for those scenes alone

                return summary_of(self.scene, self.sampler, self.bins, span.first, span.stop).tables()
            blocks = drawn_blocks(self.sampler, span.first, span.stop, size)
            return joined([kept(self.scene, block) for block in blocks])

    @cached_property
    def bins(self) -> "Bins":
        """In which values are counted where statistics are kept."""
        from mcgw.ensemble.bins import Bins  # for those scenes alone

        return Bins.of(self.scene)

    def write(self, tables: Tables, seconds: float) -> None:
        """Write the file in one step, of all surfaces drawn as one block. Only with the lock."""
        results: Held = MemoryResults(tables)
        if self.scene.keep == "statistics":
            from mcgw.ensemble.summarised import Summarised  # for those scenes alone
            from mcgw.ensemble.summary import Summary

            results = Summarised(self.scene, (Summary.from_tables(tables),))
        write_ensemble(Ensemble(self.scene, self.sampler.name, results), self.path, wall_seconds=seconds)

    def _bytes(self) -> int:
        """What lies there already: the file, and shards of a run."""
        files = [self.path, *self.folder.glob("shards/block-*.h5")]
        return sum(file.stat().st_size for file in files if file.is_file())


def as_recorded(scene: Scene, path: Path) -> Scene:
    """The scene with its functions resolved, or as they were when the run at this place began.

    Another processor, or another NumPy, may give other last digits to a Python function.
    """
    resolved = storable(scene)
    there = None if resolved is scene else recorded_scene(path)
    if there is None:
        return resolved
    mine, before = resolved.grading, there.grading
    if isinstance(mine, PiecewiseSeries) and isinstance(before, PiecewiseSeries) and mine.agrees(before):
        resolved = replace(resolved, grading=before)
    if resolved.law.agrees(there.law):
        resolved = replace(resolved, law=there.law)
    return resolved


def _check_readable(scene: Scene, path: Path) -> None:
    if scene_from(stored_text(scene)) != scene:
        raise StoreError(f"{path}: this scene would be read otherwise than it is; give the values it shows")
