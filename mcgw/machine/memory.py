"""Available memory, checked before anything is computed; arrays that begin with a line of the cache.

Results that are kept for the next call with the same arguments.
"""

import math
from collections.abc import Callable
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mcgw.errors import StoreError

_Result = TypeVar("_Result")
_MOST = 2**63 - 1
_SMALL = 2**24  # bytes; looking up what is available takes half a millisecond
_LINE = 8  # words


def check_memory(what: str, size: int) -> None:
    """Refuse work that needs more memory than there is.

    Raises
    ------
    StoreError
        With both numbers.
    """
    if size < _SMALL:
        return
    memory = memory_available()
    if size > memory:
        raise StoreError(
            f"{what} needs {gibibytes(size)} of memory but only {gibibytes(memory)} is available; reduce the "
            "request"
        )


def memory_available() -> int:
    """Bytes that this process may still use: of the machine, its control group and `ulimit -v`."""
    limits = [_number(line.split()[1]) * 1024 for line in _lines("/proc/meminfo") if "MemAvailable" in line]
    used = [_number(line) for line in _lines("/sys/fs/cgroup/memory.current")]
    most = [_number(line) for line in _lines("/sys/fs/cgroup/memory.max") if line.strip() != "max"]
    if used and most:
        limits.append(max(most[0] - used[0], 0))
    if (limit := memory_limit()) is not None:
        taken = [_number(line.split()[1]) * 1024 for line in _lines("/proc/self/status") if "VmSize" in line]
        limits.append(max(limit - sum(taken), 0))
    return min(limits, default=_MOST)


def memory_limit() -> int | None:
    """Bytes of address space that this process and each child may have; None: no limit, or not known."""
    try:
        import resource
    except ImportError:
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if soft == resource.RLIM_INFINITY else soft


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []


def _number(text: str) -> int:
    return int(text) if text.strip().isdecimal() else _MOST


def gibibytes(size: int) -> str:
    """Display a number of bytes."""
    return f"{size / 2**30:.4g} GiB"


def aligned(*shape: int) -> NDArray[np.float64]:
    """Memory for an array of this shape, not filled: its first word begins a line of the cache.

    A full vector that straddles two lines takes twice as long to load.
    """
    words = math.prod(shape)
    memory = np.empty(words + _LINE)
    start = -(memory.ctypes.data // memory.itemsize) % _LINE
    return memory[start : start + words].reshape(shape)


def kept(most: int) -> Callable[[Callable[..., _Result]], Callable[..., _Result]]:
    """As `functools.lru_cache` for numbers, bytes and frozen dataclasses; others are not cached.

    A user's height law may be any object and may have changed since the last call.
    """

    def decorate(function: Callable[..., _Result]) -> Callable[..., _Result]:
        remembered = lru_cache(maxsize=most)(function)

        @wraps(function)
        def call(*arguments: Any) -> _Result:
            return (remembered if all(map(_never_changes, arguments)) else function)(*arguments)

        call.cache_clear = remembered.cache_clear  # type: ignore[attr-defined]
        return call

    return decorate


def _never_changes(argument: Any) -> bool:
    facts = getattr(type(argument), "__dataclass_params__", None)
    if not (facts.frozen if facts else isinstance(argument, int | float | bytes)):
        return False
    try:
        hash(argument)
    except TypeError:  # it holds an array
        return False
    return True
