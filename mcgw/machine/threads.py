"""Calls side by side in threads, and how many of these there are.

No loop of the sampler is compiled to run in parallel: numba's threads take milliseconds to wake, and not all
of its kinds may be called from several threads at once.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import pairwise
from typing import TypeVar

import numpy as np

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")
_CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
# How many this thread may call at once: all that there are, unless Numba has been told to use fewer.
THREADS = ContextVar("THREADS", default=int(os.environ.get("NUMBA_NUM_THREADS", _CORES)))


@contextmanager
def use_threads(threads: int | None) -> Iterator[None]:
    """Set the number of threads that this thread calls, at most those available."""
    if threads is not None and not (isinstance(threads, int) and threads >= 1):
        raise ValueError(f"threads = {threads!r}: give a whole number >= 1")
    before = THREADS.get()
    THREADS.set(min(threads or before, before))
    try:
        yield
    finally:
        THREADS.set(before)


def in_threads(call: Callable[[_Item], _Result], items: Sequence[_Item]) -> list[_Result]:
    """Call for every item, on as many threads as there are; results in their order.

    Items are distributed in runs of equal length, of which the caller does the first itself. If it waited,
    the system would wake its helpers on the one core that has just come free, one after the other, and move
    them to another core only milliseconds later. What is called lets go of Python's lock while it computes;
    calls within a call run alone.
    """
    threads = min(THREADS.get(), len(items))
    if threads <= 1:
        return [call(item) for item in items]
    runs = [[items[i] for i in places] for places in np.array_split(np.arange(len(items)), threads)]
    with ThreadPoolExecutor(threads - 1, initializer=THREADS.set, initargs=(1,)) as pool:
        others = [pool.submit(list, map(call, some)) for some in runs[1:]]
        with use_threads(1):
            results = [call(item) for item in runs[0]]
        for one in others:
            results += one.result()
    return results


def pieces(n: int, least: int) -> list[tuple[int, int]]:
    """Cut ``0 ... n - 1`` for the threads there are, at multiples of `least`."""
    groups = -(-n // least)
    ends = np.linspace(0, groups, min(THREADS.get(), max(groups, 1)) + 1).astype(np.int64) * least
    return list(pairwise(np.minimum(ends, n).tolist()))
