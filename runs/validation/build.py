"""Rebuild all that follows from solves.csv.

    python runs/validation/build.py

Writes the README and the pictures of this folder, and the condensed table that the simulator reads,
mcgw/scene/validity.csv. Takes a few minutes and needs no boundary-element solver.
"""

from pathlib import Path

import solve_table
from deviations import condensed, write_table

HERE = Path(__file__).resolve().parent
CONDENSED = HERE.parents[1] / "mcgw" / "scene" / "validity.csv"


def main() -> None:
    """Rebuild."""
    rows = solve_table.read()
    charted = [row for row in rows if row["purpose"] in ("study", "caps")]
    write_table(condensed(charted), solve_table.PATH, len(charted), CONDENSED)


if __name__ == "__main__":
    main()
