"""Numbers and tables as Markdown."""

import math
from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table, first row and lines below."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


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
