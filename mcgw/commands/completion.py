"""``mcgw completion``: tab completion for a shell."""

from typing import Literal


def completion(shell: Literal["bash", "zsh", "fish"]) -> None:
    """Print a shell script that completes commands, options and files.

    Parameters
    ----------
    shell : SHELL
        bash, zsh, fish

    Examples
    --------
    mcgw completion bash
    """
    from argparse import _SubParsersAction
    from pathlib import Path

    from mcgw.commands.declared import parser_of
    from mcgw.errors import extra

    try:
        import shtab  # an extra
    except ImportError:
        raise ValueError(f"shtab is not installed: {extra('completion')}") from None
    whole = parser_of()
    (commands,) = (x for x in whole._actions if isinstance(x, _SubParsersAction))
    for parser in (whole, *commands.choices.values()):
        for action in parser._actions:
            if action.type is Path:
                action.complete = shtab.FILE
    print(shtab.complete(whole, shell))
