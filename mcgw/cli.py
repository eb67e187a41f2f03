"""The command line: ``mcgw COMMAND``. What a command needs is imported when it runs."""

import argparse
import errno
import gc
import os
import signal
import sys
import warnings
from collections.abc import Sequence
from typing import Any, NoReturn

from mcgw.commands.declared import COMMANDS as COMMANDS, all_commands, execute, parser_of
from mcgw.commands.outputs import QUIET, speaking
from mcgw.errors import RunError, in_one_line
from mcgw.machine.terminal import one_line, plain_output

_PRINTED = ("", "show", "solve", "elastic", "completion")  # their product is what they print


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command, by default that of this process, and return its exit code.

    0: done; 1: a comparison or a run failed, or a full disk does not take the output of a command that has no
    other product; 2: bad input; 130, 143: interrupted by a signal.
    """
    asked = argparse.Namespace(command="")  # help, or the version
    with plain_output() as output:
        code = _main(argv, asked)
        output.flush()
        lost = output.lost
        if code or lost is None or isinstance(lost, BrokenPipeError) or asked.command not in _PRINTED:
            return code  # a closed pipe is no error
        print(f"mcgw: {in_one_line(lost)}", file=sys.stderr)
        return 1


def _main(argv: Sequence[str] | None, asked: argparse.Namespace) -> int:
    try:
        words = sys.argv[1:] if argv is None else argv
        args = parser_of([word for word in words[:1] if word in all_commands()]).parse_args(words, asked)
        with warnings.catch_warnings():
            warnings.showwarning = _show_warning  # type: ignore[assignment]
            warnings.filterwarnings("ignore", module=r"mcgw\.scene\.surface")  # shown as notes
            if args.amount == QUIET:
                warnings.simplefilter("ignore")
            with speaking(args.amount):
                return execute(args.function, args)
    except SystemExit as end:  # of argparse: help, the version, or words that are none
        if isinstance(end.code, str):  # of somebody's own code
            raise
        return end.code or 0
    except _Terminated:
        lines, code = "terminated", 143
    except KeyboardInterrupt:
        lines, code = "interrupted", 130
    except RunError as error:
        lines, code = str(error), error.code
    except MemoryError as error:
        lines, code = f"not enough memory ({one_line(str(error))}); reduce the scene", 1
    except OSError as error:
        lines, code = in_one_line(error), 1 if error.errno in (errno.ENOSPC, errno.EDQUOT) else 2
    except ValueError as error:
        lines, code = str(error), 2
    for line in lines.splitlines():
        print(f"mcgw: {one_line(line)}", file=sys.stderr)
    return code


class _Terminated(KeyboardInterrupt):
    """SIGTERM, which ends a command as Ctrl-C does."""


def terminate(*_: object) -> NoReturn:
    """Heed SIGTERM; runs and sweeps heed signals in their own way meanwhile."""
    raise _Terminated


def _show_warning(message: Warning | str, *_: Any) -> None:
    """Show a warning in one line, without its place in the code."""
    print(f"mcgw: warning: {one_line(str(message))}", file=sys.stderr)


def process() -> NoReturn:
    """Run the command of this process; skip the last garbage collection, which takes 0.2 s.

    Products of matrices are small: more threads of BLAS than one would only wait for each other, at work.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when NumPy is imported
    signal.signal(signal.SIGTERM, terminate)
    code = main()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # nobody catches what it raises from here on
    gc.freeze()
    sys.exit(code)
