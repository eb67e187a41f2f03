"""How far a long call has come: told to a function, or drawn as a bar."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["Progress", "bar", "told"]

Tell = Callable[[float, float], Any]
Progress = bool | Tell | None


@contextmanager
def told(progress: Progress, unit: str) -> Iterator[Tell]:
    """Whom to tell ``(done, total)``: the one meaning of ``progress=`` in every call that takes it.

    True draws a bar that counts in `unit`; a function is called; None and False tell nobody.

    Raises
    ------
    ValueError
        If `progress` is something else.
    """
    if progress is True:
        with bar(unit) as show:
            yield show
    elif callable(progress):
        yield progress
    elif progress in (None, False):
        yield _nobody
    else:
        raise ValueError(f"progress = {progress!r}: give True, or a function of (done, total)")


@contextmanager
def bar(unit: str, *, terminal: bool = False) -> Iterator[Tell]:
    """A bar on standard error, if asked so on a terminal only.

    Its rate is that of this call: what was done before counts as given.
    """
    from tqdm import tqdm

    bars: list[Any] = []

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
