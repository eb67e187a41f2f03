"""Solve two lines of solves.csv anew and compare with what stands there.

    python runs/validation/again.py     (needs tamaas: the extra ``bem``; a minute)

Every solve here begins from no contact, those in the table from the load before: what they share is the
map, drawn again from its seed, and the solution. A pixel at a rim may fall to either side.
"""

import sys

import solve_table
from deviations import number
from solve_list import jobs
from solves import solved

AGAIN = ("gaussian-H0.8-a5-s1-k64-x8-p0.01", "caps-0.06-s1-N100-n512-p0.01")
DIGITS = {"m0": 1e-9, "gap": 1e-6, "stiffness": 1e-4, "area_raw": 1e-3, "area": 1e-3}  # relative


def main() -> int:
    """Solve, compare, and say it; 1 if one differs."""
    stored, wrong = {row["job"]: row for row in solve_table.read()}, 0
    for job in jobs():
        for name, p in job.solves():
            if name in AGAIN:
                (found,) = solved(job, [(name, p)])
                for key, most in DIGITS.items():
                    off = number(found, key) / number(stored[name], key) - 1
                    wrong += not abs(off) <= most
                    print(
                        f"{name}  {key}: {number(found, key):.10g}, differs by {off:.1e} (allowed {most:g})"
                    )
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
