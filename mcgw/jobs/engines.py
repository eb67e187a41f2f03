"""Engines: where blocks are drawn. One interface: submit a call, get a future of its answer.

A worker may die at any time and a block may be drawn twice: tasks are idempotent, and what counts is
what lies on the disk.
"""

import multiprocessing
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from queue import SimpleQueue
from typing import Any, Protocol

from mcgw.machine.child_process import end_with


class WorkerDiedError(Exception):
    """The worker that had a block died; the block may be tried again."""


class EngineLostError(Exception):
    """No worker is left."""


class Engine(Protocol):
    """Draws blocks."""

    @property
    def width(self) -> int:
        """Number of blocks to submit in advance."""
        ...

    def submit(self, task: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Begin a task; its future fails as the task, with `WorkerDiedError` or with `EngineLostError`."""
        ...

    def close(self) -> None:
        """Drop unfinished tasks and end the workers."""
        ...


class Threads:
    """All threads of this process on one block after the other.

    A task may return a function of no arguments for the rest of its work, which gives the answer: another
    thread calls it, in the order of the tasks, while the next task is begun. The caller's thread stays free,
    so that signals are heeded while a block is drawn.
    """

    width = 3  # one waits, one is drawn, one is written

    def __init__(self) -> None:
        self._tasks: SimpleQueue[Any] = SimpleQueue()
        self._begun: SimpleQueue[Any] = SimpleQueue()
        for work in (self._begin, self._finish):
            # A daemon: a long block does not keep an interrupted program alive.
            threading.Thread(target=work, daemon=True, name="mcgw-blocks").start()

    def submit(self, task: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Queue a task."""
        future: Future[Any] = Future()
        self._tasks.put((future, partial(task, *arguments)))
        return future

    def close(self) -> None:
        """Finish the running task and stop."""
        while not self._tasks.empty():
            self._tasks.get()
        self._tasks.put(None)

    def _begin(self) -> None:
        while (item := self._tasks.get()) is not None:
            future, task = item
            try:
                self._begun.put((future, task()))
            except BaseException as error:
                future.set_exception(error)
        self._begun.put(None)

    def _finish(self) -> None:
        while (item := self._begun.get()) is not None:
            future, answer = item
            try:
                future.set_result(answer() if callable(answer) else answer)
            except BaseException as error:
                future.set_exception(error)


class Processes:
    """Worker processes on this machine, one thread each.

    Parameters
    ----------
    n : int
        Number of processes.

    Raises
    ------
    ValueError
        If `n` is not positive.
    """

    def __init__(self, n: int) -> None:
        if n < 1:
            raise ValueError(f"processes = {n}: give a whole number >= 1")
        self.width = n + 1
        self._n = n
        self._pool = self._new_pool()

    def _new_pool(self) -> ProcessPoolExecutor:
        # Spawned: a fork would inherit locks of threads that it does not have.
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(self._n, mp_context=context, initializer=_begin_worker)

    def submit(self, task: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Submit a task to the next free process; replace a broken pool."""
        try:
            inner = self._pool.submit(task, *arguments)
        except BrokenProcessPool:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = self._new_pool()
            inner = self._pool.submit(task, *arguments)
        outer: Future[Any] = Future()
        inner.add_done_callback(lambda done: pass_on(done, outer, BrokenProcessPool, ()))
        return outer

    def close(self) -> None:
        """Kill the workers: a shard is there or not, never half."""
        workers = list((self._pool._processes or {}).values())
        self._pool.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.kill()


def _begin_worker() -> None:
    """Ignore Ctrl-C, which the driver handles, and end together with the driver."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        end_with(parent.sentinel, parent.join)


def pass_on(done: Any, outer: "Future[Any]", died: Any, lost: Any) -> None:
    """Give a future the outcome of another, with the errors of an engine in our words."""
    try:
        outer.set_result(done.result())
    except died as error:
        outer.set_exception(WorkerDiedError(str(error)))
    except lost as error:
        outer.set_exception(EngineLostError(type(error).__name__))
    except BaseException as error:
        outer.set_exception(error)
