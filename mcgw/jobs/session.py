"""Blocks at work: who draws what is missing, which share of it, and who hears how far it has come.

The engine that a call asks for: by a word, an address, a client of dask or as it is.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

from mcgw.jobs.driver import Signals, drive, heed_signals
from mcgw.jobs.engines import Engine, Processes, Threads
from mcgw.machine.progress import Progress, Tell, told
from mcgw.store.shards import Span

_ENGINES = ("threads", "processes", "dask")


@dataclass(frozen=True)
class Part:
    """One of several jobs that share the blocks of a run.

    Parameters
    ----------
    number, of : int
        ``1 <= number <= of``.

    """

    number: int
    of: int

    def mine(self, block: int) -> bool:
        """Whether a block, by its number, is this job's."""
        return block % self.of == self.number - 1


def part_of(shard: str) -> Part:
    """The share that a text like "2/8" names.

    Raises
    ------
    ValueError
        If it names none.
    """
    number, _, of = str(shard).partition("/")
    if not (number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of)):
        raise ValueError(f"--shard {shard}: give i/n with 1 <= i <= n")
    return Part(int(number), int(of))


@dataclass(frozen=True)
class By:
    """Who draws blocks this time, and who hears of it.

    Parameters
    ----------
    engine : Engine, optional
        Who draws; default: threads of this process, of which one writes a block while others draw the next.
    threads : int, optional
        Of a block.
    progress : callable
        Told what is done.
    signals : Signals
        What has come.
    """

    engine: Engine | None
    threads: int | None
    progress: Callable[[Any], Any]
    signals: Signals = field(default_factory=Signals)

    def __post_init__(self) -> None:
        if self.threads is not None and self.threads < 1:
            raise ValueError(f"threads = {self.threads}: give a whole number >= 1")

    @contextmanager
    def at_work(self) -> Iterator["By"]:
        """With the engine given, left open, or with own threads; signals are heeded."""
        with heed_signals() as signals:
            if self.engine is not None:
                yield replace(self, threads=1, signals=signals)
                return
            with closing(Threads()) as own:
                yield replace(self, engine=own, signals=signals)

    def drive(
        self, spans: Sequence[Span], task: Any, arguments: Any, done: Callable[[Span, Any], None]
    ) -> None:
        """Have the engine draw blocks, as `mcgw.jobs.driver.drive`."""
        assert self.engine is not None
        drive(self.engine, spans, task, arguments, done, self.signals)


@contextmanager
def asked_of(
    engine: Any, threads: int | None, shard: str | None, progress: Progress
) -> Iterator[tuple[Engine | None, Part | None, Tell]]:
    """What a call says of who draws into a file: the engine, the share, and whom to tell.

    An engine that is made here, of a word or an address, is closed at the end; one that is given, a client of
    dask too, is left open. None stands for threads of this process.

    Raises
    ------
    ValueError
        If one of them is empty, or a share is given to an engine.
    """
    if shard is not None and engine is not None:
        raise ValueError(f"shard = {shard!r}: a share is drawn by threads; leave engine out")
    part = None if shard is None else part_of(shard)
    draws = _engine_of(engine, threads)
    try:
        with told(progress, "surfaces", dashboard_of(draws)) as tell:
            yield draws, part, tell
    finally:
        if draws is not None and draws is not engine:
            draws.close()


def dashboard_of(engine: Engine | None) -> str:
    """What to say of where an engine is seen at work; empty if there is no such page."""
    link = getattr(engine, "dashboard", "")
    return f"dashboard: {link}" if link else ""


def _engine_of(engine: Any, threads: int | None) -> Engine | None:
    from mcgw.jobs.dask_engine import Dask, is_client

    match engine:
        case None | "threads":
            return None
        case "processes":
            return Processes(_cores() if threads is None else threads)
        case str() if engine == "dask" or "://" in engine:
            return Dask(
                None if engine == "dask" else engine, workers=_cores() if threads is None else threads
            )
        case _ if is_client(engine):
            return Dask(engine)
        case _ if not isinstance(engine, str) and hasattr(engine, "submit") and hasattr(engine, "width"):
            return engine  # type: ignore[no-any-return]
    raise ValueError(
        f"engine = {engine!r}: give one of {', '.join(_ENGINES)}, tcp://ADDRESS of a scheduler, or a "
        "distributed.Client"
    )


def _cores() -> int:
    import numba

    return int(numba.get_num_threads())
