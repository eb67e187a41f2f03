"""The command line: ``mcgw COMMAND``. What a command needs is imported when it runs."""

import argparse
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

from mcgw.errors import RunError
from mcgw.machine.leaving import leave
from mcgw.machine.terminal import drop_output, one_line, plain_output

COMMANDS = (
    "init",
    "run",
    "sweep",
    "show",
    "compare",
    "converge",
    "tradeoff",
    "regrade",
    "merge",
    "solve",
    "export",
    "figures",
    "report",
    "surface",
    "fit",
    "completion",
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    argv : sequence of str, optional
        Default: those of the process.

    Returns
    -------
    int
        0: done; 1: a comparison or a run failed; 2: bad input; 130, 143: interrupted by a
        signal.
    """
    with plain_output():
        return _main(argv)


def _main(argv: Sequence[str] | None) -> int:
    try:
        args = _parser().parse_args(argv)
        with warnings.catch_warnings():
            warnings.showwarning = _show_warning  # type: ignore[assignment]
            code = int(args.execute(args))
        sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        print("mcgw: interrupted", file=sys.stderr)
        return 130
    except RunError as error:
        print(f"mcgw: {error}", file=sys.stderr)
        return error.code
    except BrokenPipeError:  # the reader of our output has seen enough
        drop_output()
        return 0
    except MemoryError as error:
        print(f"mcgw: the memory does not suffice ({one_line(str(error))}); ask for less", file=sys.stderr)
        return 1
    except (ValueError, OSError) as error:
        if isinstance(error, OSError) and error.filename == "standard output":
            drop_output()
        for line in str(error).splitlines():
            print(f"mcgw: {one_line(line)}", file=sys.stderr)
        return 2


def _show_warning(message: Warning | str, *_: Any) -> None:
    """Warnings are for the user: one line, without the place in the code."""
    print(f"mcgw: warning: {one_line(str(message))}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="mcgw",
        description="Monte-Carlo simulation of rough contacts with graded elasticity. SI units; "
        "separations and heights in units of sigma.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show program's version number and exit")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name in COMMANDS:
        command = import_module(f"mcgw.commands.{name}")
        sub = commands.add_parser(
            name, help=command.HELP, description=f"{command.HELP}.", epilog=f"example: {command.EXAMPLE}"
        )
        command.arguments(sub)
        sub.set_defaults(execute=command.execute, parser=parser)
    return parser


class _Version(argparse.Action):
    """As the action "version", but looked up when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from importlib.metadata import PackageNotFoundError, version

        try:
            found = version("mcgw")
        except PackageNotFoundError:
            found = "unknown"
        print(f"mcgw {found}")
        parser.exit()


def process() -> NoReturn:
    """Run the command of this process, and end it."""
    leave(main())


if __name__ == "__main__":
    process()
