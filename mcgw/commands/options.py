"""Options shared by several commands: --set for keys, and what draws the blocks."""

import argparse
import logging
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcgw.commands.voice import news

if TYPE_CHECKING:
    from concurrent.futures import Executor


def add_drawing_options(parser: argparse.ArgumentParser) -> None:
    """Add --threads, --jobs, --dask and --shard."""
    parser.add_argument(
        "--threads",
        type=int,
        metavar="N",
        help="number of threads; default: all cores; does not change results",
    )
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--jobs", type=int, metavar="N", help="use N processes instead")
    how.add_argument(
        "--dask", metavar="ADDRESS", help="use the workers of a dask scheduler, tcp:// or tls://"
    )
    how.add_argument(
        "--shard", metavar="I/N", help="draw the I-th of N shares, as one job of an array; then mcgw merge"
    )


@contextmanager
def _executor(args: argparse.Namespace) -> Iterator["Executor | None"]:
    """Yield the executor that the options name, ended at the end; None for threads of this process.

    Libraries log nothing meanwhile: mcgw itself reports a lost worker or scheduler, in one line.
    """
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with _made(args) as executor:
            yield executor
    finally:
        logging.disable(before)


def _made(args: argparse.Namespace) -> "AbstractContextManager[Executor | None]":
    if args.jobs is None is args.dask:
        return nullcontext()
    from mcgw.jobs.executors import Jobs, dask_executor

    return dask_executor(args.dask) if args.jobs is None else Jobs(args.jobs)


@contextmanager
def drawing(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Yield the arguments of `mcgw.run` and `mcgw.sweep` that say how, with a progress bar."""
    from mcgw.machine.progress import bar

    with _executor(args) as executor, bar("surfaces", terminal=True) as show:
        who = {"executor": executor} if args.shard is None else {"shard": args.shard}
        yield {"threads": args.threads, "progress": show, **who}


def tell_shard(shard: str, path: Path, left: int) -> int:
    """Print that a shard is done and what remains; return the exit code."""
    then = f"{left} surfaces are still missing" if left else f"all are done: mcgw merge {path}"
    news(f"{path}.parts: shard {shard} is done; {then}")
    return 0


def add_set_option(parser: argparse.ArgumentParser) -> None:
    """Add --set."""
    parser.add_argument(
        "--set",
        action="append",
        metavar="KEY=VALUE",
        help="change a key of the scene, such as grading.gamma=2 or contact.law=hertz; repeat for more keys",
    )


def changes_of(args: argparse.Namespace) -> dict[str, Any]:
    """Values of --set by key: TOML where they parse as TOML, otherwise text.

    Raises
    ------
    ValueError
        If one is no ``table.key=value``.
    """
    from mcgw.formats.named_files import loads

    changes: dict[str, Any] = {}
    for text in args.set or ():
        key, equals, value = (part.strip() for part in text.partition("="))
        if not (equals and key and value):
            raise ValueError(f"--set {text}: give KEY=VALUE, such as grading.gamma=2")
        try:
            changes[key] = loads(f"value = {value}")["value"]
        except ValueError:
            changes[key] = value
    return changes


RANGE = "A:B:N for N of them from A to B"
GEOMETRIC = ("Pa", "N")  # pressures and loads are at a constant ratio, all else evenly


def ranged(text: str, option: str, unit: str = "") -> list[float]:
    """Return the N numbers from A to B of a text A:B:N.

    Pressures and loads are at a constant ratio, all else at equal steps.

    Parameters
    ----------
    text : str
        A and B are numbers with a unit, where one is given.
    option : str
        Name of the option, for messages.
    unit : str, optional
        SI unit of the numbers; default: plain numbers.

    Raises
    ------
    ValueError
        If it is none, N is not from 2 to 1e6, or a ratio would not be positive and rising.
    """
    import numpy as np

    from mcgw.formats.units import parse

    begin, _, rest = text.partition(":")
    end, _, number = rest.partition(":")
    if not number.isdigit() or not 2 <= int(number) <= 1e6:
        example = {"Pa": "10kPa:20MPa:30", "N": "1N:100N:30"}.get(unit, "0.2:2:10")
        raise ValueError(f"{option} {text}: give A:B:N, such as {example}, with N from 2 to 1e6")
    first, last = (parse(each, unit, option) if unit else float(each) for each in (begin, end))
    if unit not in GEOMETRIC:
        return [float(x) for x in np.linspace(first, last, int(number))]
    if not 0 < first < last:
        raise ValueError(f"{option} {text}: give the lower one first, above 0")
    return [float(x) for x in np.geomspace(first, last, int(number))]
