"""Rebuild all that follows from solves.csv.

    python runs/validation/build.py

Writes the README and the pictures of this folder, and the condensed table that the simulator reads,
mcgw/validity/table.csv. Takes a few minutes and needs no boundary-element solver.
"""

from pathlib import Path

import solve_table
from deviations import Condensed, condensed, write_table
from limits import limits
from page import page
from solve_table import Row
from validity_figures import chart, one_map

HERE = Path(__file__).resolve().parent
CONDENSED = HERE.parents[1] / "mcgw" / "validity" / "table.csv"
SHOWN_MAP = {"hurst": 0.8, "x": 5.0, "seed": 1.0, "purpose": "study"}


def charted_rows(rows: list[Row]) -> list[Row]:
    """Those that the condensed table is made of."""
    return [row for row in rows if row["purpose"] in ("study", "caps")]


def pictures(lines: list[Condensed], rows: list[Row]) -> None:
    """Draw all."""
    one, own = ("one radius", "none"), ("own radii", "none")
    chart(lines, "area", [one, own], HERE / "area.png")
    chart(lines, "stiffness", [one, own, ("own radii", "summits")], HERE / "stiffness.png")
    shown = [row for row in rows if all(row[key] == value for key, value in SHOWN_MAP.items())]
    one_map(sorted(shown, key=lambda row: float(row["p"])), HERE / "one_map.png")


def main() -> None:
    """Rebuild."""
    rows = solve_table.read()
    charted = charted_rows(rows)
    lines = condensed(charted)
    write_table([*lines, *limits(lines)], solve_table.PATH, len(charted), CONDENSED)
    pictures(lines, rows)
    (HERE / "README.md").write_text(page(lines, rows))


if __name__ == "__main__":
    main()
