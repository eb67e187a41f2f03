"""Tables as CSV: one row of names, then numbers that read back to the last bit."""

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from mcgw.formats.files import whole_file
from mcgw.machine.terminal import one_line

__all__ = ["Row", "write_csv"]

Row = Sequence[float | str]


def write_csv(path: str | Path, header: Sequence[str], rows: Iterable[Row], *, comment: str = "") -> None:
    """Write a table: text as it is, numbers with as many digits as they have; a comment stands above it."""
    with whole_file(Path(path)) as unfinished, open(unfinished, "w", newline="", encoding="utf-8") as file:
        file.write(f"# {one_line(comment)}\n" if comment else "")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([x if isinstance(x, str) else repr(float(x)) for x in row] for row in rows)
