"""Progress of long calls: a function to call, or a bar."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import count
from typing import Any, TypeVar

_Item = TypeVar("_Item")
_WATCHED = ContextVar("_WATCHED", default=False)
Tell = Callable[[float, float], Any]
Progress = bool | Tell | None


@contextmanager
def told(progress: Progress, unit: str) -> Iterator[Tell]:
    """Give the function to call with ``(done, total)``, from ``progress=`` of any call.

    True draws a bar that counts in `unit`; a function is called; None and False do nothing.

    Raises
    ------
    ValueError
        If `progress` is something else.
    """
    if progress is True:
        with watched(), bar(unit) as show:
            yield show
    elif callable(progress):
        yield progress
    elif progress in (None, False):
        yield lambda *_: None
    else:
        raise ValueError(f"progress = {progress!r}: give True, or a function of (done, total)")


@contextmanager
def bar(unit: str, *, terminal: bool = False) -> Iterator[Tell]:
    """Give a bar on standard error, with `terminal` only on one that is `watched`.

    Its rate is that of this call, without earlier work.
    """
    if terminal and not (sys.stderr.isatty() and _WATCHED.get()):
        yield lambda *_: None
        return
    from tqdm import tqdm

    bars: list[Any] = []

    def show(done: float, total: float) -> None:
        if not bars:
            options = {"unit": f" {unit}", "leave": False, "smoothing": 0}
            bars.append(tqdm(total=total, initial=done, **options))
        bars[0].update(done - bars[0].n)

    try:
        yield show
    finally:
        for each in bars:
            each.close()


@contextmanager
def watched() -> Iterator[None]:
    """Let `steps` and `stages` draw bars: for commands and ``progress=True``."""
    before = _WATCHED.set(True)
    try:
        yield
    finally:
        _WATCHED.reset(before)


def steps(items: Sequence[_Item], unit: str) -> Iterator[_Item]:
    """Iterate over long work; with a bar on a watched terminal."""
    with stages(len(items), unit) as done:
        for item in items:
            yield item
            done()


@contextmanager
def stages(number: int, unit: str = "steps") -> Iterator[Callable[[], Any]]:
    """As `steps`, for consecutive stages: the yielded function is called after each."""
    if not _WATCHED.get():
        yield lambda: None
        return
    with bar(unit, terminal=True) as tell:
        tell(0, number)
        finished = count(1)
        yield lambda: tell(next(finished), number)
