"""The command line: ``mcgw COMMAND``. What a command needs is imported when it runs."""

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version

from mcgw.errors import RunError

COMMANDS = (
    "init",
    "run",
    "show",
    "compare",
    "converge",
    "tradeoff",
    "regrade",
    "merge",
    "solve",
    "figures",
    "report",
    "surface",
    "fit",
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    argv : sequence of str, optional
        Left out: those of the process.

    Returns
    -------
    int
        0: done; 1: a comparison or a run failed; 2: bad input; 130, 143: interrupted by a
        signal.
    """
    args = _parser().parse_args(argv)
    try:
        return int(args.execute(args))
    except KeyboardInterrupt:
        print("mcgw: interrupted", file=sys.stderr)
        return 130
    except RunError as error:
        print(f"mcgw: {error}", file=sys.stderr)
        return error.code
    except BrokenPipeError:  # the reader of our output has seen enough
        sys.stderr.close()
        return 0
    except (ValueError, OSError) as error:
        for line in str(error).splitlines():
            print(f"mcgw: {line}", file=sys.stderr)
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="mcgw",
        description="Monte-Carlo simulation of rough contacts with graded elasticity. SI units; "
        "separations and heights in units of sigma.",
    )
    parser.add_argument("--version", action="version", version=f"mcgw {_version()}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name in COMMANDS:
        command = import_module(f"mcgw.commands.{name}")
        sub = commands.add_parser(
            name, help=command.HELP, description=f"{command.HELP}.", epilog=f"example: {command.EXAMPLE}"
        )
        command.arguments(sub)
        sub.set_defaults(execute=command.execute)
    return parser


def _version() -> str:
    try:
        return version("mcgw")
    except PackageNotFoundError:
        return "unknown"


if __name__ == "__main__":
    sys.exit(main())
