"""What a process may use of memory, shows while it works and is ended by."""

import re
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any, TypeVar

from mcgw.errors import StoppedError, StoreError

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")
_REMEMBERED = 8  # results of a function
_NUMBERS = (int, float, bytes)
_WATCHED = ContextVar("_WATCHED", default=False)
_SHOWN: list[Any] = []  # the bar on the terminal: calls within a call draw none beside it
Tell = Callable[[float, float], Any]
Progress = bool | Tell | None


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


def kept(function: Callable[..., _Result]) -> Callable[..., _Result]:
    """As `functools.lru_cache` for numbers, bytes and frozen dataclasses; others are not cached.

    A user's height law may be any object and may have changed since the last call.
    """
    remembered = lru_cache(maxsize=_REMEMBERED)(function)

    @wraps(function)
    def call(*arguments: Any) -> _Result:
        for kind in set(map(type, arguments)):
            facts = getattr(kind, "__dataclass_params__", None)
            if not (facts.frozen if facts else issubclass(kind, _NUMBERS)):
                return function(*arguments)
        try:
            hash(arguments)
        except TypeError:  # one holds an array
            return function(*arguments)
        return remembered(*arguments)

    return call


@contextmanager
def told(progress: Progress, unit: str) -> Iterator[Tell]:
    """Give the function to call with ``(done, total)``, from ``progress=`` of any call.

    True draws a bar that counts in `unit`, at the rate of this call, without earlier work; None does so on a
    terminal that is `watched`; a function is called; False does nothing. Anything else is a ValueError.
    """
    if progress is None:
        progress = waited_for()
    if callable(progress):
        yield progress
        return
    if progress not in (True, False):
        raise ValueError(f"progress = {progress!r}: give True, or a function of (done, total)")
    if not progress:
        yield lambda *_: None
        return
    from tqdm import tqdm

    own: list[Any] = []

    def show(done: float, total: float) -> None:
        if not _SHOWN:
            own.append(tqdm(total=total, initial=done, unit=f" {unit}", leave=False, smoothing=0))
            _SHOWN.append(own[0])
        for bar in own:
            bar.update(done - bar.n)

    try:
        with watched():
            yield show
    finally:
        for bar in own:
            _SHOWN.clear()
            bar.close()


def waited_for() -> bool:
    """Whether a person waits at a terminal, who is shown what goes on."""
    return _WATCHED.get() and sys.stderr is not None and sys.stderr.isatty()


@contextmanager
def watched() -> Iterator[None]:
    """Let long calls draw bars of themselves: for commands and ``progress=True``."""
    before = _WATCHED.set(True)
    try:
        yield
    finally:
        _WATCHED.reset(before)


def steps(items: Sequence[_Item], unit: str, progress: Progress = None) -> Iterator[_Item]:
    """Iterate over long work; by default with a bar on a watched terminal."""
    with told(progress, unit) as tell:
        for number, item in enumerate(items):
            tell(number, len(items))
            yield item
        tell(len(items), len(items))


class Signals:
    """The signal that has arrived, if any."""

    number: int | None = None

    def check(self, kept: str) -> None:
        """Raise if a signal has arrived, with what is kept."""
        if self.number is not None:
            name = "interrupted" if self.number == signal.SIGINT else "terminated"
            raise StoppedError(f"{name}: {kept}", 128 + self.number)


@contextmanager
def heed_signals() -> Iterator[Signals]:
    """Record Ctrl-C and SIGTERM instead of dying; a second signal acts at once."""
    signals = Signals()
    if threading.current_thread() is not threading.main_thread():
        yield signals
        return

    def note(number: int, frame: Any) -> None:  # noqa: ARG001
        if signals.number is not None:
            raise KeyboardInterrupt
        signals.number = number

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield signals
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
