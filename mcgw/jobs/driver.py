"""The driver: gives blocks to an engine until none is missing, and heeds signals."""

import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, TypeVar

from mcgw.errors import RunError, StoppedError
from mcgw.jobs.engines import Engine, EngineLostError, WorkerDiedError

_Block = TypeVar("_Block")

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
    """Give what is running a moment to finish; what does not is dropped."""
    until = monotonic() + _GRACE
    while running and (left := until - monotonic()) > 0:
        try:
            block, future = answers.get(timeout=left)
        except Empty:
            return
        running.discard(block)
        if future.exception() is None:
            done(block, future.result())
