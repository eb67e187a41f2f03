"""Python calls side by side in threads; and the end of worker processes with their parent.

The caller does the first share itself. If it waited, the system would wake its helpers on the one core
that has just come free, one after the other, and move them to another core only milliseconds later.

No loop of the sampler is compiled to run in parallel: numba's threads take as long to wake, and not all of
its kinds may be called from several threads at once.
"""

import os
import signal
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import chain, pairwise
from typing import TypeVar

import numpy as np
from numba import get_num_threads, set_num_threads

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


def in_threads(call: Callable[[_Item], _Result], items: Sequence[_Item], *, least: int = 2) -> list[_Result]:
    """Call for every item, on as many threads as numba has been told to use; results in their order.

    Items are distributed in runs of equal length. What is called lets go of Python's lock while it computes;
    calls within a call run alone. Fewer than `least` items are not worth waking a thread.
    """

    def run_alone(places: Iterable[int]) -> list[_Result]:
        before = get_num_threads()
        set_num_threads(1)  # set for this thread: nested calls find the others busy
        try:
            return [call(items[i]) for i in places]
        finally:
            set_num_threads(before)

    threads = min(get_num_threads(), len(items)) if len(items) >= least else 1
    if threads <= 1:
        return [call(item) for item in items]
    own, *others = np.array_split(np.arange(len(items)), threads)
    with ThreadPoolExecutor(len(others)) as pool:
        theirs = [pool.submit(run_alone, places) for places in others]
        return list(chain(run_alone(own), *(one.result() for one in theirs)))


def pieces(n: int, least: int) -> list[tuple[int, int]]:
    """Cut ``0 ... n - 1`` for the threads there are, at multiples of `least`."""
    groups = -(-n // least)
    ends = np.linspace(0, groups, min(get_num_threads(), max(groups, 1)) + 1).astype(np.int64) * least
    return list(pairwise(np.minimum(ends, n).tolist()))


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
