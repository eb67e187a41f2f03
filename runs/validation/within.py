"""Where each model is within 10 % of boundary elements: loads, by spectrum."""

from itertools import groupby

from as_markdown import Sheet, load, table
from charted import CLAIMED, VALID
from deviations import Condensed
from models import SHOWN


def within_table(lines: list[Condensed]) -> Sheet:
    """Ranges of load in which the mean error of a quantity is within 10 %."""
    rows = []
    for x in sorted({line.x for line in lines}):
        cells = []
        for model, interaction, quantity in CLAIMED:
            own = [one for one in lines if (one.x, one.model, one.interaction) == (x, model, interaction)]
            cells.append(ranges([(one.p, abs(one.mean[quantity]) <= VALID) for one in own]))
        rows.append([f"{x:g}", *cells])
    head = [f"{quantity}, {model}{SHOWN[interaction]}" for model, interaction, quantity in CLAIMED]
    return table(["α", *head], rows)


def ranges(valid: list[tuple[float, bool]]) -> str:
    """Runs of neighbouring loads, as "1e-4 … 3e-3"."""
    runs = [[p for p, _ in run] for inside, run in groupby(valid, key=lambda pair: pair[1]) if inside]
    return ", ".join(load(run[0]) + (f" … {load(run[-1])}" if run[1:] else "") for run in runs) or "none"
