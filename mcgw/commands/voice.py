"""What a command says, and how much of it: the news; with -q errors alone; with -v everything."""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

from mcgw.machine.progress import watched
from mcgw.machine.terminal import without_passing

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.scene.scene import Scene
    from mcgw.sweeps.sweep import Sweep

QUIET, NEWS, ALL = range(3)
_AMOUNT = ContextVar("_AMOUNT", default=NEWS)


def add_amount_options(parser: argparse.ArgumentParser) -> None:
    """Add -q and -v."""
    amount = parser.add_mutually_exclusive_group()
    for letter, name, value, words in (
        ("-q", "--quiet", QUIET, "print only errors and requested output"),
        ("-v", "--verbose", ALL, "print everything: tables, cautions in full, sources"),
    ):
        amount.add_argument(
            letter, name, dest="amount", action="store_const", const=value, default=NEWS, help=words
        )


@contextmanager
def speaking(amount: int) -> Iterator[None]:
    """Say so much in the commands below; when quiet no bars and no warnings either."""
    before = _AMOUNT.set(amount)
    try:
        if amount == QUIET:
            with without_passing():
                yield
        else:
            with watched():
                yield
    finally:
        _AMOUNT.reset(before)


def says(amount: int = NEWS) -> bool:
    """Whether so much is to be said."""
    return _AMOUNT.get() >= amount


def news(*lines: object) -> None:
    """Say what was made, what came out, what to type next."""
    if says() and lines:
        print(*lines, sep="\n")


def details(*lines: object) -> None:
    """Say what only those want who gave -v."""
    if says(ALL) and lines:
        print(*lines, sep="\n")


def notes(*lines: str) -> None:
    """Say what a user should know, beside the output."""
    for line in lines if says() else ():
        print(f"mcgw: note: {line}", file=sys.stderr)


def tell_cautions(source: "Scene | Ensemble | Sweep", instead: str = "") -> None:
    """Say the cautions of a scene, of an ensemble or of all points of a sweep.

    Where they were said before, `instead` is the command that says them in full: then only their number is
    given, beside values that are perhaps in other units.
    """
    if not says():
        return
    lines = cautions_of(source)
    if instead and not says(ALL):
        from mcgw.scene.plausible import perhaps_other_units
        from mcgw.scene.scene import Scene

        scene = getattr(source, "scene", source)
        doubts = perhaps_other_units(scene) if isinstance(scene, Scene) else []
        number = len(lines) - len(doubts)
        lines = [*doubts, *([f"{number} caution{'s' * (number > 1)}: {instead}"] if number else [])]
    notes(*lines)


def cautions_of(source: "Scene | Ensemble | Sweep") -> list[str]:
    """What a reader should know of a scene, that of an ensemble, or all points of a sweep."""
    from mcgw.scene.cautions import cautions
    from mcgw.scene.scene import Scene

    if isinstance(source, Scene):
        return cautions(source)
    from mcgw.ensemble.ensemble import Ensemble  # with results, of which many commands have none

    if isinstance(source, Ensemble):
        return cautions(source.scene)
    from mcgw.sweeps.over_points import sweep_cautions

    return sweep_cautions(source)
