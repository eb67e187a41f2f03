"""Executors of the command line: worker processes of this machine, and those of a dask scheduler.

From Python any `concurrent.futures.Executor` draws blocks. A worker may die at any time and a block may be
drawn twice: tasks are idempotent, and what counts is what lies on the disk.
"""

import multiprocessing
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from mcgw.errors import RunError, extra
from mcgw.machine.in_threads import end_with


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
