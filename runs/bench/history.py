"""All ratios of the benches, now and when last recorded: ``python runs/bench/history.py [--record]``.

Each is seconds of `mcgw` to seconds of a peer, both measured in this run: lower is better. What is more than
20 % above the last record of the same kind of machine is measured again; if it still is, the exit status is
1. Where this kind of machine has no record, the latest of any is shown, and nothing fails. Takes a quarter
of an hour of a machine that does nothing else.
"""

import sys
import tomllib
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path

import records
from timing import parser_of

from mcgw.store.ownership import provenance

BENCHES = (
    "bench_analytic",
    "commands",
    "contact_laws",
    "file",
    "interaction",
    "kept_statistics",
    "crowds",
    "maps",
    "random_radii",
    "samplers",
    "setup",
    "sweep",
)
PROJECT = Path(__file__).parents[2] / "pyproject.toml"


def about() -> records.Line:
    """Which version is measured, when and where."""
    version = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["version"]
    return {"version": version, "date": datetime.now(UTC).date().isoformat(), "machine": provenance()["cpu"]}


def ratios_of(bench: str, rounds: int) -> dict[str, float]:
    """Ratios of one bench, each by the name of its column in the history."""
    return {f"{bench}: {name}": value for name, value in import_module(bench).ratios(rounds).items()}


def measured(bench: str, rounds: int, before: dict[str, float]) -> dict[str, float]:
    """Ratios of a bench; the lower of two where one seems worse, since a busy machine makes none better."""
    found = ratios_of(bench, rounds)
    if records.worse(found, before):
        again = ratios_of(bench, rounds)
        found = {name: min(value, again[name]) for name, value in found.items()}
    return found


def show(now: dict[str, float], before: dict[str, float]) -> None:
    """A line for each ratio: now, last recorded, change."""
    for name, value in now.items():
        change = (
            f"{before[name]:10.4g} {value / before[name] - 1:+7.0%}" if name in before else f"{'new':>10}"
        )
        print(f"{value:10.4g} {change:18}  {name}", flush=True)


def main() -> int:
    """Measure, print, compare, and record if asked."""
    parser = parser_of(__doc__)
    parser.add_argument("--record", action="store_true", help="write the line of this version and machine")
    parser.add_argument("--only", nargs="+", choices=BENCHES, default=BENCHES, help="these benches")
    asked = parser.parse_args()
    here, lines = about(), records.read(records.HISTORY)
    own = records.last(lines, here["machine"])
    before = own or records.last(lines, None)
    print(
        f"{'now':>10} {'recorded':>10} {'change':>7}  seconds of mcgw to those of the peer: lower is better"
    )
    now: dict[str, float] = {}
    for bench in asked.only:
        new = measured(bench, asked.rounds, own)
        show(new, before)
        now |= new
    if asked.record:
        records.write(records.written(lines, here, now), records.HISTORY)
    if not own:
        print(f"no record of {here['machine']}: compared with other machines, where ratios differ")
    for name in records.worse(now, own):
        print(f"worse by more than {records.WORSE - 1:.0%}: {name}")
    return 1 if records.worse(now, own) else 0


if __name__ == "__main__":
    sys.exit(main())
