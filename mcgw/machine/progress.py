"""How far a long call has come: told to a function, or drawn as a bar."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["Progress", "bar", "told"]

Tell = Callable[[float, float], Any]
Progress = bool | Tell | None


@contextmanager
def told(progress: Progress, unit: str, beside: str = "") -> Iterator[Tell]:
    """Whom to tell ``(done, total)``: the one meaning of ``progress=`` in every call that takes it.

    True draws a bar that counts in `unit`, with a line `beside` it as in `bar`; a function is called; None
    and False tell nobody.

    Raises
    ------
    ValueError
        If `progress` is something else.
    """
    if progress is True:
        with bar(unit, beside) as show:
            yield show
    elif callable(progress):
        yield progress
    elif progress in (None, False):
        yield _nobody
    else:
        raise ValueError(f"progress = {progress!r}: give True, or a function of (done, total)")


@contextmanager
def bar(unit: str, beside: str = "", *, terminal: bool = False) -> Iterator[Tell]:
    """A bar on standard error, if asked so on a terminal only; on one a line may be said `beside` it, once.

    Its rate is that of this call: what was done before counts as given.
    """
    from tqdm import tqdm

    bars: list[Any] = []
    if beside and sys.stderr.isatty():
        tqdm.write(beside, file=sys.stderr)

    def show(done: float, total: float) -> None:
        if not bars:
            options = {
                "unit": f" {unit}",
                "disable": None if terminal else False,
                "leave": False,
                "smoothing": 0,
            }
            bars.append(tqdm(total=total, initial=done, **options))
        bars[0].update(done - bars[0].n)

    try:
        yield show
    finally:
        for each in bars:
            each.close()


def _nobody(done: float, total: float) -> None:
    """Tell nobody."""
