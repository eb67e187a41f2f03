"""The history of the ratios: one line of `history.csv` for each version and kind of machine.

Every ratio is seconds of `mcgw` to seconds of a peer of the same run, so lower is better, and the speed of
the machine cancels; not wholly, since processors differ in what they are good at. So ratios are held to the
last ones of the same kind of machine: the same processor and number of cores.
"""

import csv
from pathlib import Path

HISTORY = Path(__file__).with_name("history.csv")
ABOUT = ("version", "date", "machine")
WORSE = 1.2  # times the last ratio, and a bench has got worse

Line = dict[str, str]


def read(path: Path) -> list[Line]:
    """Lines of the history, oldest first; none if there is no file yet."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file, strict=True))


def written(lines: list[Line], about: Line, ratios: dict[str, float]) -> list[Line]:
    """The history with these ratios in the line of their version and machine, which becomes the last one."""
    own: Line = {}
    others = []
    for line in lines:
        if all(line[key] == about[key] for key in ("version", "machine")):
            own = line
        else:
            others.append(line)
    return [*others, own | about | {name: f"{value:.4g}" for name, value in ratios.items()}]


def write(lines: list[Line], path: Path) -> None:
    """Write the lines; a ratio that a line lacks is left empty."""
    names = {name: None for line in lines for name in line}
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(names), restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(lines)


def last(lines: list[Line], machine: str | None) -> dict[str, float]:
    """The last ratio of each name, on this kind of machine or, with None, on any."""
    found: dict[str, float] = {}
    for line in lines:
        if machine in (None, line["machine"]):
            found |= {name: float(text) for name, text in line.items() if name not in ABOUT and text}
    return found


def worse(now: dict[str, float], before: dict[str, float]) -> list[str]:
    """Names of the ratios that are more than 20 % higher than the last ones."""
    return [name for name, value in now.items() if name in before and value > WORSE * before[name]]
