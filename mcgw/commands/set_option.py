"""The option ``--set``: other values of keys of a scene, for one call."""

import argparse
from typing import Any


def add_set_option(parser: argparse.ArgumentParser) -> None:
    """Add it."""
    parser.add_argument(
        "--set",
        action="append",
        metavar="KEY=VALUE",
        help="another value of a key of the scene, as grading.gamma=2 or contact.law=hertz; again for more",
    )


def changes_of(args: argparse.Namespace) -> dict[str, Any]:
    """Values by their keys: as TOML where they are such, else the text itself.

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
            raise ValueError(f"--set {text}: give KEY=VALUE, as grading.gamma=2")
        try:
            changes[key] = loads(f"value = {value}")["value"]
        except ValueError:
            changes[key] = value
    return changes
