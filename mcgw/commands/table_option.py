"""The option ``--csv`` of commands that print a table."""

from collections.abc import Callable
from pathlib import Path

from mcgw.commands.outputs import CSV, Output
from mcgw.formats.table import Table

__all__ = ["table_output", "write_table"]


def table_output(path: Path | None) -> list[Output]:
    """The file that the option asks for, if it is given."""
    return [Output(path, CSV, "--csv")] if path else []


def write_table(path: Path | None, table: Callable[[], Table]) -> None:
    """Write it if it is asked for, and say where it is."""
    if path:
        table().write(path)
        print(f"{path}: the table")
