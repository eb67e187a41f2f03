"""``mcgw completion``: tab completion for a shell."""

import argparse
import sys
from pathlib import Path

from mcgw.errors import extra

HELP = "print a shell script that completes commands, options and files"
EXAMPLE = "mcgw completion bash"

_SHELLS = ("bash", "zsh", "fish")


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("shell", choices=_SHELLS, metavar="SHELL", help=", ".join(_SHELLS))


def execute(args: argparse.Namespace) -> int:
    """Print the completion script, made from the parser of all commands."""
    try:
        import shtab  # an extra
    except ImportError:
        raise ValueError(f"shtab is not installed: {extra('completion')}") from None
    (commands,) = (x for x in args.parser._actions if isinstance(x, argparse._SubParsersAction))
    for parser in (args.parser, *commands.choices.values()):
        for action in parser._actions:
            if action.type is Path:
                action.complete = shtab.FILE
    sys.stdout.write(shtab.complete(args.parser, args.shell) + "\n")
    return 0
