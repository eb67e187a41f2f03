"""Compiled loops, kept on the disk by Numba; and calls of them side by side in threads.

A process that compiles holds a lock meanwhile: Numba numbers the files of a loop, and two processes that
compile at once may give two versions of it one number. Then one is loaded where the other is asked for, a
loop that sums fewer moments, without a word. Who waits for the lock finds the loops compiled.

No loop of the sampler is compiled to run in parallel: numba's threads take milliseconds to wake, and not all
of its kinds may be called from several threads at once.
"""

import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

import numba
import numpy as np
from filelock import FileLock, SoftFileLock
from numba.core import event

from mcgw.errors import RunError
from mcgw.machine.process import waited_for

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")

if numba.config.DISABLE_JIT:  # type: ignore[attr-defined, unused-ignore]
    raise RunError(
        "NUMBA_DISABLE_JIT is set, but the loops of mcgw need unsigned integers, which only compiled code "
        "has; unset it",
        code=2,
    )


def njit(**options: Any) -> Callable[[Any], Any]:
    """Return `numba.njit` of these options; where no compiled loop can be kept, that is only said.

    All loops let go of Python's lock and divide as NumPy does.
    """
    options["cache"] = bool(options.get("cache") and loops_folder())
    decorator: Callable[[Any], Any] = numba.njit(**{"nogil": True, "error_model": "numpy", **options})
    return decorator


@cache
def loops_folder() -> str:
    """Return the folder in which Numba keeps the loops of this package's folder; empty if it has none."""
    try:
        return str(numba.njit(cache=True)(lambda: None).stats.cache_path)
    except RuntimeError as error:
        warnings.warn(
            f"compiled loops cannot be kept ({error}), so every process takes 12 s to compile them; set "
            "NUMBA_CACHE_DIR to a folder that can be written",
            stacklevel=2,
        )
        return ""


class _OneCompiles(event.Listener):  # type: ignore[misc, unused-ignore]
    """Takes a lock of the machine with Numba's own, which is of this process."""

    _lock = FileLock(Path(loops_folder()) / "mcgw-loops.lock", thread_local=False)

    def on_start(self, event: Any) -> None:  # noqa: ARG002
        with suppress(OSError, NotImplementedError):  # a disk without locks, or one that is full
            self._lock.acquire()

    def on_end(self, event: Any) -> None:  # noqa: ARG002
        self._lock.release()


class _Told(event.Listener):  # type: ignore[misc, unused-ignore]
    """Says once to who waits that loops are being compiled."""

    _said = False

    def on_start(self, event: Any) -> None:  # noqa: ARG002
        if not self._said and waited_for():
            sys.stderr.write("mcgw: compiling the loops, once for this machine\n")
            self._said = True

    def on_end(self, event: Any) -> None:
        """Say nothing."""


if loops_folder() and FileLock is not SoftFileLock:  # a soft lock would outlive a process that is killed
    event.register("numba:compiler_lock", _OneCompiles())
event.register("numba:compile", _Told())


@contextmanager
def use_threads(threads: int | None) -> Iterator[None]:
    """Set the number of threads of the loops that this thread calls, at most those available."""
    if threads is not None and not (isinstance(threads, int) and threads >= 1):
        raise ValueError(f"threads = {threads!r}: give a whole number >= 1")
    before = numba.get_num_threads()
    numba.set_num_threads(min(threads or before, before))
    try:
        yield
    finally:
        numba.set_num_threads(before)


def in_threads(call: Callable[[_Item], _Result], items: Sequence[_Item], *, least: int = 2) -> list[_Result]:
    """Call for every item, on as many threads as numba has been told to use; results in their order.

    Items are distributed in runs of equal length, of which the caller does the first itself. If it waited,
    the system would wake its helpers on the one core that has just come free, one after the other, and move
    them to another core only milliseconds later. What is called lets go of Python's lock while it computes;
    calls within a call run alone. Fewer than `least` items are not worth waking a thread.
    """
    threads = min(numba.get_num_threads(), len(items)) if len(items) >= least else 1
    if threads <= 1:
        return [call(item) for item in items]
    runs = [[items[i] for i in places] for places in np.array_split(np.arange(len(items)), threads)]
    with ThreadPoolExecutor(threads - 1, initializer=numba.set_num_threads, initargs=(1,)) as pool:
        others = [pool.submit(list, map(call, some)) for some in runs[1:]]
        with use_threads(1):
            results = [call(item) for item in runs[0]]
        for one in others:
            results += one.result()
    return results


def pieces(n: int, least: int) -> list[tuple[int, int]]:
    """Cut ``0 ... n - 1`` for the threads there are, at multiples of `least`."""
    groups = -(-n // least)
    ends = np.linspace(0, groups, min(numba.get_num_threads(), max(groups, 1)) + 1).astype(np.int64) * least
    return list(pairwise(np.minimum(ends, n).tolist()))
