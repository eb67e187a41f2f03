"""The table of all solves: one line each, appended as it is found; a line torn by a kill does not count."""

import csv
import io
import os
from pathlib import Path

from filelock import FileLock

PATH = Path(__file__).with_name("solves.csv")
COLUMNS = (
    "kind", "job", "purpose", "hurst", "x", "seed", "n", "pixels", "waves", "m0", "m2", "m4",
    "p", "area_raw", "area", "gap", "stiffness", "spots", "error", "seconds",
)  # fmt: skip
TEXT = ("kind", "job", "purpose")

Row = dict[str, str | float]


def read(path: Path = PATH) -> list[Row]:
    """Every whole line, of each job the first: words as they are, numbers as floats."""
    if not path.exists():
        return []
    whole = path.read_bytes().rpartition(b"\n")[0].decode()
    found: dict[str, Row] = {}
    for row in csv.DictReader(io.StringIO(whole)):
        found.setdefault(row["job"], {key: text if key in TEXT else float(text) for key, text in row.items()})
    return list(found.values())


def append(row: Row, path: Path = PATH) -> None:
    """Add a line, in one piece, after the last whole one."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    with FileLock(f"{path}.lock"):
        _mend(path)
        if not path.exists() or path.stat().st_size == 0:
            writer.writeheader()
        writer.writerow({key: written(value) for key, value in row.items()})
        with path.open("a") as file:
            file.write(text.getvalue())
            file.flush()
            os.fsync(file.fileno())


def written(value: str | float) -> str:
    """Ten digits, which is more than solvers agree on."""
    return value if isinstance(value, str) else f"{value:.10g}"


def _mend(path: Path) -> None:
    """Cut off what follows the last line break."""
    if path.exists():
        data = path.read_bytes()
        if not data.endswith(b"\n"):
            os.truncate(path, data.rfind(b"\n") + 1)
