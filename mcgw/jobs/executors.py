"""Executors: worker processes of this machine, those of a dask scheduler, and two threads of this process.

From Python any `concurrent.futures.Executor` draws blocks. A worker may die at any time and a block may be
drawn twice: tasks are idempotent, and what counts is what lies on the disk.
"""

import multiprocessing
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from importlib import import_module
from threading import Event
from typing import Any

from mcgw.errors import RunError, StoppedError, extra
from mcgw.machine.child_process import end_with


class Jobs(Executor):
    """Worker processes on this machine, one thread each; if one dies, all are replaced.

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
            raise ValueError(f"--jobs {n}: give a whole number >= 1")
        self.n, self.in_hand = n, n + 1
        self._pool = self._new_pool()

    def _new_pool(self) -> ProcessPoolExecutor:
        # Spawned: a fork would inherit locks of threads that it does not have.
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(self.n, mp_context=context, initializer=_begin_worker)

    def submit(self, task: Callable[..., Any], /, *arguments: Any, **options: Any) -> "Future[Any]":
        """Submit a task to the next free process, of a new pool if the last one broke."""
        try:
            return self._pool.submit(task, *arguments, **options)
        except BrokenExecutor:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = self._new_pool()
            return self._pool.submit(task, *arguments, **options)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:  # noqa: ARG002
        """Kill the workers: a block is there or not, never half."""
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


@contextmanager
def dask_executor(address: str) -> Iterator[Executor]:
    """Yield the executor of a dask scheduler; it stays at work.

    Raises
    ------
    RunError
        If dask is not installed or nobody answers.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise RunError(f"dask is not installed: {extra('dask')}") from None
    try:
        client = distributed.Client(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError) as error:
        raise RunError(
            f"--dask {address}: no scheduler answers ({str(error).splitlines()[0]}); start it (dask "
            "scheduler), then repeat the command"
        ) from None
    try:
        yield client.get_executor(pure=False)
    finally:
        client.close(timeout=2)


class Overlapped(Executor):
    """One thread of this process draws block after block, another one writes what is drawn."""

    in_hand = 3  # one waits, one is drawn, one is written

    def __init__(self, threads: int | None) -> None:
        self._draws, self._writes = (ThreadPoolExecutor(1, thread_name_prefix="mcgw-blocks") for _ in "12")
        self._threads, self._ended = threads, Event()

    def submit(self, attempt: Callable[..., Any], draw: Callable[..., Any], /, *block: Any) -> Future[Any]:  # type: ignore[override]
        """Submit the drawing of a block, and the writing that this returns."""
        drawn = self._draws.submit(draw, *block, self._threads, self._go_on)
        return self._writes.submit(attempt, lambda: drawn.result()())

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End both; a long block does not keep an interrupted run alive."""
        self._ended.set()
        for pool in (self._draws, self._writes):
            pool.shutdown(wait=wait, cancel_futures=cancel_futures)

    def _go_on(self, _: int) -> bool:
        if self._ended.is_set():
            raise StoppedError("the run has ended")
        return True
