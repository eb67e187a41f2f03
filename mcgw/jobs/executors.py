"""Executors give blocks to workers until none is missing.

From Python any `concurrent.futures.Executor` draws blocks; here are those of the command line: worker
processes of this machine, and those of a dask scheduler. A worker may die at any time and a block may be
drawn twice: tasks are idempotent, and what counts is what lies on the disk.
"""

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent import futures
from contextlib import contextmanager
from importlib import import_module
from typing import Any, TypeVar

from mcgw.errors import RunError, extra
from mcgw.machine.process import Signals

_Block = TypeVar("_Block")

_IN_HAND = 1024  # blocks given at a time to an executor that does not say how many it takes
_RESUME = "finished blocks are kept; the same command resumes"


def outcome(task: Callable[..., Any], *arguments: Any) -> tuple[Any, Exception | None]:
    """Return the result of a task, or its error: what is raised in place of both is its executor's."""
    try:
        return task(*arguments), None
    except Exception as error:
        return None, error


def drive(
    executor: futures.Executor,
    blocks: Sequence[_Block],
    task: Callable[..., Any],
    arguments: Callable[[_Block], tuple[Any, ...]],
    done: Callable[[_Block, Any], None],
    signals: Signals,
    in_hand: int = _IN_HAND,
) -> None:
    """Have an executor draw every block, in any order, and call `done` with each block and its result.

    `task` is called with what `arguments` gives for a block. A block that the executor lost, as with its
    worker, is submitted once more, alone. At most `in_hand` blocks are submitted at a time. When a signal has
    come, which is asked several times a second, this returns; blocks in hand are dropped.
    """
    todo, lost, running = deque(blocks), set[_Block](), dict[futures.Future[Any], _Block]()
    in_hand = getattr(executor, "in_hand", in_hand)
    try:
        while (todo or running) and signals.number is None:
            while todo and len(running) < (1 if todo[0] in lost else in_hand):
                block = todo.popleft()
                try:
                    running[executor.submit(outcome, task, *arguments(block))] = block
                except Exception as refusal:
                    raise _no_more(_in_words(refusal)) from None
            futures.wait(running, timeout=0.2, return_when=futures.FIRST_COMPLETED)
            for future in [one for one in running if one.done()]:
                block = running.pop(future)
                try:
                    result, error = future.result()
                except futures.CancelledError:  # by nobody here: not a worker, but its executor is lost
                    raise _no_more(f"it dropped {block}") from None
                except Exception as failure:
                    if block in lost:
                        told = f"{block} were lost twice by the executor ({_in_words(failure)}); {_RESUME}"
                        raise RunError(told) from None
                    lost.add(block)
                    todo.appendleft(block)
                    continue
                if error is not None:
                    raise error
                done(block, result)
    finally:
        for future in running:
            future.cancel()


def _no_more(why: str) -> RunError:
    return RunError(f"the executor takes no more work ({why}); {_RESUME}")


def _in_words(error: BaseException) -> str:
    """Return kind and first line of an error of an executor."""
    return ": ".join([type(error).__name__, *str(error).splitlines()[:1]])


class Jobs(futures.Executor):
    """So many worker processes on this machine, one thread each; if one dies, all are replaced."""

    def __init__(self, n: int) -> None:
        if n < 1:
            raise ValueError(f"--jobs {n}: give a whole number >= 1")
        self.n, self.in_hand = n, n + 1
        self._pool = self._new_pool()

    def _new_pool(self) -> futures.ProcessPoolExecutor:
        # Spawned: a fork would inherit locks of threads that it does not have.
        context = multiprocessing.get_context("spawn")
        return futures.ProcessPoolExecutor(self.n, mp_context=context, initializer=_begin_worker)

    def submit(self, task: Callable[..., Any], /, *arguments: Any, **options: Any) -> "futures.Future[Any]":
        """Submit a task to the next free process, of a new pool if the last one broke."""
        try:
            return self._pool.submit(task, *arguments, **options)
        except futures.BrokenExecutor:
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


def end_with(pipe: int, gone: Callable[[], object] | None = None) -> None:
    """End this process at once when the other end of a pipe is closed; nothing may ever be written into it.

    On Linux the kernel kills it, whatever it is busy with: a call into a C library that holds Python's
    global lock does not delay it. Elsewhere a thread does, as soon as it can take that lock: when `gone`
    returns, or reading from the pipe.
    """
    try:
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
        fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
    except (ImportError, AttributeError, OSError):
        pass  # not Linux

    # Also there: the parent may have died before the kernel was asked.
    def follow() -> None:
        gone() if gone else os.read(pipe, 1)
        os._exit(1)

    threading.Thread(target=follow, daemon=True, name="mcgw-lifeline").start()


@contextmanager
def dask_executor(address: str) -> Iterator[futures.Executor]:
    """Yield the executor of a dask scheduler; it stays at work."""
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
