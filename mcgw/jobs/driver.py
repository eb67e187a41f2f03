"""The driver: gives blocks to an engine until none is missing, and heeds signals.

Arguments of a call: the engine by word, address, dask client or object; the share of the blocks; progress.
"""

import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, TypeVar

from mcgw.errors import RunError, StoppedError
from mcgw.jobs.engines import Engine, EngineLostError, Processes, WorkerDiedError
from mcgw.machine.progress import Progress, Tell, told

_Block = TypeVar("_Block")

_TRIES = 3
_GRACE = 2.0  # seconds for running blocks to finish when the run stops


class Signals:
    """The signal that has arrived, if any."""

    number: int | None = None

    def check(self, kept: str) -> None:
        """Raise if a signal has arrived.

        Raises
        ------
        StoppedError
            With what is kept.
        """
        if self.number is not None:
            name = "interrupted" if self.number == signal.SIGINT else "terminated"
            raise StoppedError(f"{name}: {kept}", 128 + self.number)


@contextmanager
def heed_signals() -> Iterator[Signals]:
    """Record Ctrl-C and SIGTERM instead of dying; a second signal acts at once."""
    signals = Signals()
    if threading.current_thread() is not threading.main_thread():
        yield signals
        return

    def note(number: int, frame: Any) -> None:  # noqa: ARG001
        if signals.number is not None:
            raise KeyboardInterrupt
        signals.number = number

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield signals
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def drive(
    engine: Engine,
    blocks: Sequence[_Block],
    task: Callable[..., Any],
    arguments: Callable[[_Block], tuple[Any, ...]],
    done: Callable[[_Block, Any], None],
    signals: Signals,
) -> None:
    """Have an engine draw every block, in any order, and call `done` with each block and its result.

    `task` is called with what `arguments` gives for a block. A block whose worker died is tried again,
    alone; after three times it is given up and the others are drawn all the same. When a signal has come,
    which is asked several times a second, this returns.

    Raises
    ------
    RunError
        If the engine is lost or a block kills its workers.
    Exception
        As the task raises.
    """
    todo, suspects = deque(blocks), deque[_Block]()
    tries: dict[_Block, int] = {}
    given_up: list[_Block] = []
    answers: SimpleQueue[tuple[_Block, Future[Any]]] = SimpleQueue()
    running: set[_Block] = set()

    def submit(block: _Block) -> None:
        running.add(block)
        future = engine.submit(task, *arguments(block))
        future.add_done_callback(lambda future: answers.put((block, future)))

    while todo or suspects or running:
        while todo and len(running) < engine.width and not suspects:
            submit(todo.popleft())
        if suspects and not running:
            submit(suspects.popleft())
        try:
            block, future = answers.get(timeout=0.2)
        except Empty:
            if signals.number is not None:
                break
            continue
        running.discard(block)
        try:
            result = future.result()
        except WorkerDiedError:
            tries[block] = tries.get(block, 0) + 1
            (given_up if tries[block] >= _TRIES else suspects).append(block)
            continue
        except EngineLostError as error:
            raise RunError(f"scheduler lost ({error}); start it again and repeat the command") from None
        done(block, result)
        if signals.number is not None:
            break
    if signals.number is not None:
        _last_answers(answers, running, done)
    elif given_up:
        lost = "1 block is" if len(given_up) == 1 else f"{len(given_up)} blocks are"
        raise RunError(f"{given_up[0]} killed the worker {_TRIES} times; {lost} not done, all others are")


def _last_answers(
    answers: "SimpleQueue[tuple[_Block, Future[Any]]]",
    running: set[_Block],
    done: Callable[[_Block, Any], None],
) -> None:
    """Wait briefly for running tasks; drop those that do not finish."""
    until = monotonic() + _GRACE
    while running and (left := until - monotonic()) > 0:
        try:
            block, future = answers.get(timeout=left)
        except Empty:
            return
        running.discard(block)
        if future.exception() is None:
            done(block, future.result())


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
        """Whether a block belongs to this job."""
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
    """Who draws blocks, and who hears of progress.

    Parameters
    ----------
    engine : Engine, optional
        Default: threads of this process; one writes a block while others draw the next.
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


@contextmanager
def asked_of(
    engine: Any, threads: int | None, shard: str | None, progress: Progress
) -> Iterator[tuple[Engine | None, Part | None, Tell]]:
    """Read the arguments of a call: engine, share and progress.

    An engine that is made here, of a word or an address, is closed at the end; one that is given, a client of
    dask too, is left open. None stands for threads of this process.

    Raises
    ------
    ValueError
        If one of them is wrong, or a share is given to an engine.
    """
    if threads is not None and threads < 1:
        raise ValueError(f"threads = {threads}: give a whole number >= 1")
    if shard is not None and engine is not None:
        raise ValueError(f"shard = {shard!r}: a share uses threads; leave engine out")
    part = None if shard is None else part_of(shard)
    draws = None if engine in (None, "threads") else _engine_of(engine, threads)
    try:
        with told(progress, "surfaces", dashboard_of(draws) if draws else "") as tell:
            yield draws, part, tell
    finally:
        if draws is not None and draws is not engine:
            draws.close()


def dashboard_of(engine: Engine | None) -> str:
    """A line with the address of the dashboard of an engine; empty if there is none."""
    link = getattr(engine, "dashboard", "")
    return f"dashboard: {link}" if link else ""


def _engine_of(engine: Any, threads: int | None) -> Engine:
    from mcgw.jobs.dask_engine import Dask, is_client

    match engine:
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
