"""Available memory, checked before anything is computed; results kept for calls with the same arguments."""

from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any, TypeVar

from mcgw.errors import StoreError

_Result = TypeVar("_Result")
_MOST = 2**63 - 1


def check_memory(what: str, size: int) -> None:
    """Refuse work that needs more memory than there is."""
    if size < 2**24:  # bytes; looking up what is available takes half a millisecond
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
    with suppress(ImportError):  # not Windows
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            taken = (_number(line.split()[1]) for line in _lines("/proc/self/status") if "VmSize" in line)
            limits.append(max(limit - 1024 * sum(taken), 0))
    return min(limits, default=_MOST)


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
