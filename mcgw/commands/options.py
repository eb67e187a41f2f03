"""Options shared by several commands: --set for keys, and the engine that draws the blocks."""

import argparse
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcgw.commands.voice import news

if TYPE_CHECKING:
    from mcgw.jobs.engines import Engine


def add_engine_options(parser: argparse.ArgumentParser) -> None:
    """Add --threads, --processes, --workers, --scheduler, --shard and --insecure."""
    parser.add_argument(
        "--threads",
        type=int,
        metavar="N",
        help="number of threads; default: all cores; does not change results",
    )
    engine = parser.add_mutually_exclusive_group()
    engine.add_argument("--processes", type=int, metavar="N", help="use N processes instead")
    engine.add_argument("--workers", type=int, metavar="N", help="use N dask workers on this machine")
    engine.add_argument(
        "--scheduler", metavar="ADDRESS", help="use the workers of a dask scheduler, tcp:// or tls://"
    )
    engine.add_argument(
        "--shard", metavar="I/N", help="draw the I-th of N shares, as one job of an array; then mcgw merge"
    )
    parser.add_argument("--insecure", action="store_true", help="allow a remote scheduler without encryption")


@contextmanager
def engine_asked(args: argparse.Namespace) -> Iterator["Engine | None"]:
    """The engine that the options name, closed at the end; None for threads of this process.

    Libraries log nothing meanwhile: mcgw itself reports a lost worker or scheduler, in one line.
    """
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        engine = _engine(args)
        try:
            yield engine
        finally:
            if engine:
                engine.close()
    finally:
        logging.disable(before)


@contextmanager
def drawing(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Engine arguments of `mcgw.run` and `mcgw.sweep`, with a progress bar."""
    from mcgw.jobs.driver import dashboard_of
    from mcgw.machine.progress import bar

    with engine_asked(args) as engine, bar("surfaces", dashboard_of(engine), terminal=True) as show:
        who = {"engine": engine} if args.shard is None else {"shard": args.shard}
        yield {"threads": args.threads, "progress": show, **who}


def tell_share(shard: str, path: Path, left: int) -> int:
    """Print that a share is done and what remains; return the exit code."""
    then = f"{left} surfaces are still missing" if left else f"all are done: mcgw merge {path}"
    news(f"{path}.parts: share {shard} is done; {then}")
    return 0


def _engine(args: argparse.Namespace) -> "Engine | None":
    if args.processes is not None:
        from mcgw.jobs.engines import Processes

        return Processes(args.processes)
    if args.workers is not None or args.scheduler is not None:
        from mcgw.jobs.dask_engine import Dask

        workers = 1 if args.workers is None else args.workers
        return Dask(args.scheduler, workers=workers, insecure=args.insecure, quiet=True)
    return None


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
