"""The option ``--csv`` of commands that print a table."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from mcgw.commands.outputs import CSV, Output
from mcgw.formats.csv_table import Row, write_csv

__all__ = ["table_output", "write_table"]


def table_output(path: Path | None) -> list[Output]:
    """The file that the option asks for, if it is given."""
    return [Output(path, CSV, "--csv")] if path else []


def write_table(path: Path | None, header: Sequence[str], rows: Iterable[Row]) -> None:
    """Write it, and say where it is."""
    if path:
        write_csv(path, header, rows)
        print(f"{path}: the table")
