"""Progress of long calls: a function to call, or a bar."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

_Item = TypeVar("_Item")
_WATCHED = ContextVar("_WATCHED", default=False)
_SHOWN: list[Any] = []  # the bar on the terminal: calls within a call draw none beside it
Tell = Callable[[float, float], Any]
Progress = bool | Tell | None


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
