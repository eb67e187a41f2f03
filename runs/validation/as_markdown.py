"""Numbers and tables as text: Markdown where they are short, CSV where they are long."""

import csv
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Sheet:
    """A table of texts; as a string it is Markdown."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def __str__(self) -> str:
        lines = [self.head, ["---"] * len(self.head), *self.rows]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"

    def write(self, path: Path) -> None:
        """Write it as CSV."""
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([self.head, *self.rows])


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> Sheet:
    """A table of a head and rows."""
    return Sheet(head, list(rows))


def percent(value: float, error: float = math.nan) -> str:
    """In per cent with its standard error, digits as the error has them; a dash where there is none."""
    return signed(100 * value, 100 * error, 1)


def signed(value: float, error: float = math.nan, digits: int = 3) -> str:
    """With sign and standard error."""
    if not math.isfinite(value):
        return "–"
    text = f"{value:+.{digits}f}".replace("-", "−")
    return text if not math.isfinite(error) else f"{text} ± {error:.{digits}f}"


def load(p: float) -> str:
    """A load as 3e-4."""
    return f"{p:.0e}".replace("e-0", "e-")
