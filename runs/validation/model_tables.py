"""Tables of the README: every model against boundary elements, by spectrum and load."""

from collections.abc import Iterable

from as_markdown import load, percent, signed, table
from deviations import Condensed
from models import INTERACTIONS, MODELS

Lines = list[Condensed]
SHOWN = {"none": "", "summits": " + interaction (summits)", "contacts": " + interaction (contacts)"}


def loads_of(lines: Iterable[Condensed]) -> list[float]:
    """All loads, in order."""
    return sorted({line.p for line in lines})


def by_load(lines: Lines, quantity: str, axis: str) -> str:
    """One quantity: a row for each spectrum and model, a column for each load."""
    loads = loads_of(lines)
    rows = []
    for x in sorted({line.x for line in lines}):
        for model in MODELS:
            for interaction in INTERACTIONS if quantity != "area" else INTERACTIONS[:1]:
                here = {
                    line.p: line
                    for line in lines
                    if (line.x, line.model, line.interaction) == (x, model, interaction)
                }
                if here:
                    cells = [cell(here[p], quantity) if p in here else "" for p in loads]
                    rows.append([f"{x:g}", f"{model}{SHOWN[interaction]}", *cells])
    return table([axis, "model", *(load(p) for p in loads)], rows)


def cell(line: Condensed, quantity: str) -> str:
    """Mean and its standard error: per cent, but of separations."""
    show = (lambda v, e: signed(v, e, 3)) if quantity == "separation" else percent
    return show(line.mean[quantity], line.error(quantity))


def maps_table(lines: Lines) -> str:
    """How many maps, and how many spots they have by the model of one radius."""
    loads = loads_of(lines)
    rows = []
    for x in sorted({line.x for line in lines}):
        first = {line.p: line for line in reversed(lines) if line.x == x}
        cells = [f"{first[p].maps}: {first[p].contacts:.3g}" if p in first else "" for p in loads]
        rows.append([f"{x:g}", *cells])
    return table(["", *(load(p) for p in loads)], rows)
