"""How much a command prints: the news; with -q only errors; with -v everything."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from contextvars import ContextVar
from typing import Any

from mcgw.machine.progress import watched

QUIET, NEWS, ALL = range(3)
_AMOUNT = ContextVar("_AMOUNT", default=NEWS)


@contextmanager
def speaking(amount: int) -> Iterator[None]:
    """Print this much; when quiet, no progress bars and no warnings either."""
    before = _AMOUNT.set(amount)
    try:
        with nullcontext() if amount == QUIET else watched():
            yield
    finally:
        _AMOUNT.reset(before)


def says(amount: int = NEWS) -> bool:
    """Whether this much is printed."""
    return _AMOUNT.get() >= amount


def news(*lines: object) -> None:
    """Print what was made, the result, and what to type next."""
    if says() and lines:
        print(*lines, sep="\n")


def details(*lines: object) -> None:
    """Print details, with -v only."""
    if says(ALL) and lines:
        print(*lines, sep="\n")


def notes(*lines: str) -> None:
    """Print notes on standard error."""
    for line in lines if says() else ():
        print(f"mcgw: note: {line}", file=sys.stderr)


def tell_cautions(source: Any, instead: str = "") -> None:
    """Print the cautions of a scene, an ensemble or all points of a sweep.

    With `instead`, which says how to see them in full, only their number is printed, and doubts about units.
    """
    if not says():
        return
    from mcgw.scene.scene import Scene

    scene = getattr(source, "scene", source)
    doubts: list[str] = []
    if isinstance(scene, Scene):
        from mcgw.scene.cautions import cautions
        from mcgw.scene.plausible import perhaps_other_units

        lines, doubts = cautions(scene), perhaps_other_units(scene)
    else:
        from mcgw.sweeps.points import sweep_cautions

        lines = sweep_cautions(source)
    if instead and not says(ALL):
        number = len(lines) - len(doubts)
        lines = [*doubts, *([f"{number} caution{'s' * (number > 1)}: {instead}"] if number else [])]
    notes(*lines)
