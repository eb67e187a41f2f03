"""Available memory, checked before anything is computed; results kept for calls with the same arguments."""

import re
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any, TypeVar

from mcgw.errors import StoreError

_Result = TypeVar("_Result")


def check_memory(what: str, size: int) -> None:
    """Refuse work that needs more memory than there is."""
    # Bytes: looking up what is available takes half a millisecond.
    if size >= 2**24 and size > (memory := memory_available()):
        raise StoreError(
            f"{what} needs {gibibytes(size)} of memory but only {gibibytes(memory)} is available; reduce the "
            "request"
        )


def memory_available() -> int:
    """Bytes that this process may still use: of the machine, its control group and `ulimit -v`."""
    limits = [1024 * free for free in _numbers("/proc/meminfo", "MemAvailable")]
    used, most = _numbers("/sys/fs/cgroup/memory.current"), _numbers("/sys/fs/cgroup/memory.max")
    if used and most:
        limits.append(max(most[0] - used[0], 0))
    with suppress(ImportError):  # not Windows
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            limits.append(max(limit - 1024 * sum(_numbers("/proc/self/status", "VmSize")), 0))
    return min(limits, default=2**63 - 1)


def _numbers(path: str, name: str = "") -> list[int]:
    """Numbers behind a name in a file of the system; none of "max", nor of a file that is not there."""
    return [int(found[1]) for line in _lines(path) if (found := re.match(rf"{name}\D*(\d+)", line))]


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []


def gibibytes(size: int) -> str:
    """Display a number of bytes."""
    return f"{size / 2**30:.4g} GiB"


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
