"""What a worker does for a sweep: draw a chunk of its surfaces. The same, whoever asks and however often."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from time import perf_counter

from mcgw.ensemble.drawing import use_threads
from mcgw.formats.files import State, state_of
from mcgw.sampling.shared import Alone, Shared, shared
from mcgw.sweeps.drawing import Chunk, pooled_chunk
from mcgw.sweeps.folder import ASKED, SweepFolder

__all__ = ["Drawer", "commit_chunk"]


def commit_chunk(folder: str, chunk: Chunk, threads: int | None = 1) -> str:
    """Draw a chunk of a sweep into its folder, unless a valid shard is there; returns its digest."""
    return _drawer(folder, state_of(Path(folder) / ASKED)).draw(chunk, threads)()


@lru_cache(maxsize=1)
def _drawer(folder: str, _state: State | None) -> "Drawer":
    """As long as asked.toml is the same: preparing one may take as long as a chunk."""
    return Drawer(SweepFolder.open(Path(folder)))


class Drawer:
    """Draws chunks of a sweep.

    Parameters
    ----------
    folder : SweepFolder
        Where they go.
    """

    def __init__(self, folder: SweepFolder) -> None:
        self._folder = folder
        self._source = lru_cache(maxsize=1)(self._new_source)  # chunks come group after group

    def draw(self, chunk: Chunk, threads: int | None) -> Callable[[], str]:
        """Draw a chunk; what is returned commits it, which another thread may do."""
        if held := self._folder.held(chunk):
            digest = held[1].digest
            return lambda: digest
        started, group = perf_counter(), self._folder.asked.groups[chunk.group]
        with use_threads(threads):
            pooled = pooled_chunk(group, self._source(chunk.group), chunk)
        seconds = perf_counter() - started
        return lambda: self._folder.keep(chunk, pooled, seconds).digest

    def _new_source(self, group: int) -> Shared | Alone:
        return shared(self._folder.asked.groups[group].computed)
