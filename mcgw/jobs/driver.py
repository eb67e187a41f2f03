"""The driver: gives blocks to an engine until none is missing, and heeds signals."""

import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any

from mcgw.errors import RunError, StoppedError
from mcgw.jobs.engines import Engine, EngineLostError, WorkerDiedError
from mcgw.store.shards import Span

__all__ = ["Signals", "drive", "heed_signals"]

_TRIES = 3
_GRACE = 2.0  # seconds a running block has to finish when the run is asked to stop


class Signals:
    """Which signal has come, if any."""

    number: int | None = None

    def check(self, kept: str) -> None:
        """Raise if one has come.

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
    """Take note of Ctrl-C and SIGTERM instead of dying; a second one acts at once."""
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
    spans: Sequence[Span],
    task: Callable[..., Any],
    arguments: Callable[[Span], tuple[Any, ...]],
    done: Callable[[Span, Any], None],
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
    todo, suspects = deque(spans), deque[Span]()
    tries: dict[Span, int] = {}
    given_up: list[Span] = []
    answers: SimpleQueue[tuple[Span, Future[Any]]] = SimpleQueue()
    running: set[Span] = set()

    def submit(span: Span) -> None:
        running.add(span)
        future = engine.submit(task, *arguments(span))
        future.add_done_callback(lambda future: answers.put((span, future)))

    while todo or suspects or running:
        while todo and len(running) < engine.width and not suspects:
            submit(todo.popleft())
        if suspects and not running:
            submit(suspects.popleft())
        try:
            span, future = answers.get(timeout=0.2)
        except Empty:
            if signals.number is not None:
                break
            continue
        running.discard(span)
        try:
            result = future.result()
        except WorkerDiedError:
            tries[span] = tries.get(span, 0) + 1
            (given_up if tries[span] >= _TRIES else suspects).append(span)
            continue
        except EngineLostError as error:
            raise RunError(f"scheduler lost ({error}); start it again and repeat the command") from None
        done(span, result)
        if signals.number is not None:
            break
    if signals.number is not None:
        _last_answers(answers, running, done)
    elif given_up:
        blocks = "1 block is" if len(given_up) == 1 else f"{len(given_up)} blocks are"
        raise RunError(f"{given_up[0]} killed the worker {_TRIES} times; {blocks} not done, all others are")


def _last_answers(
    answers: "SimpleQueue[tuple[Span, Future[Any]]]", running: set[Span], done: Callable[[Span, Any], None]
) -> None:
    """Give what is running a moment to finish; what does not is dropped."""
    until = monotonic() + _GRACE
    while running and (left := until - monotonic()) > 0:
        try:
            span, future = answers.get(timeout=left)
        except Empty:
            return
        running.discard(span)
        if future.exception() is None:
            done(span, future.result())
