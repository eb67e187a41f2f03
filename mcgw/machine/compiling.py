"""Compiled loops, kept on the disk by Numba.

A process that compiles holds a lock meanwhile: Numba numbers the files of a loop, and two processes that
compile at once may give two versions of it one number. Then one is loaded where the other is asked for, a
loop that sums fewer moments, without a word. Who waits for the lock finds the loops compiled.
"""

import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
from filelock import FileLock, SoftFileLock
from numba.core import event

from mcgw.errors import RunError
from mcgw.machine.process import waited_for

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
