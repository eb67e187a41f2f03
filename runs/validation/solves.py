"""Solve the listed maps by boundary elements and append what is found to solves.csv.

    python runs/validation/solves.py [--part K/N]     (needs tamaas: the extra ``bem``)

Solves that stand in the table are left out, so it goes on wherever it was stopped. Several processes may
work at once, each on its part of the maps; one thread each is quickest (OMP_NUM_THREADS=1).
"""

import argparse
import time
from collections.abc import Iterable

import solve_table
from boundary_elements import Solver
from rough_maps import CapsMap, GaussianMap
from solve_list import Job, jobs


def about(surface: GaussianMap | CapsMap) -> solve_table.Row:
    """What the table says of a map; of caps: points a sqrt(R sigma), and how many caps."""
    moments = dict(zip(("m0", "m2", "m4"), surface.moments(), strict=True))
    common: solve_table.Row = {"kind": surface.kind, "seed": surface.seed, "n": surface.n, **moments}
    if isinstance(surface, CapsMap):
        mine = {"x": surface.crowding, "pixels": surface.sigma * surface.n, "waves": surface.caps}
        return {**common, **mine, "hurst": float("nan")}
    mine = {"x": surface.alpha, "pixels": surface.pixels, "waves": surface.shortest}
    return {**common, **mine, "hurst": surface.hurst}


def solved(job: Job, loads: Iterable[tuple[str, float]]) -> Iterable[solve_table.Row]:
    """One row for each load, from light to heavy: the one before is where the next begins."""
    heights = job.map.heights()
    solver, what = Solver(heights, job.tolerance, job.step), about(job.map)
    for name, p in loads:
        found = solver.at(p)
        row = {"job": name, "purpose": job.purpose, "p": p, **what}
        row |= {key: getattr(found, key) for key in found.__slots__}
        row["gap"] = found.gap + float(heights.mean())  # of caps from the mean of the law of their heights
        yield row


def main() -> None:
    """Solve what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", default="1/1", help="which maps of how many parts, as 1/2")
    part, parts = map(int, parser.parse_args().part.split("/"))
    begun = time.perf_counter()
    for job in jobs()[part - 1 :: parts]:
        known = {row["job"] for row in solve_table.read()}
        missing = [(name, p) for name, p in job.solves() if name not in known]
        for row in solved(job, missing) if missing else ():
            solve_table.append(row)
            spent = (time.perf_counter() - begun) / 3600
            print(f"{spent:.2f} h  {row['job']}  {row['seconds']:.0f} s", flush=True)
    print(f"done: {sum(float(row['seconds']) for row in solve_table.read()) / 3600:.2f} h of solves in all")


if __name__ == "__main__":
    main()
