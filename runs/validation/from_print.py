"""Numbers from print beside those of mcgw; ``python runs/validation/from_print.py`` prints all of them.

What is printed, by whom and where it was seen stands in ``print.csv``, claims without a number in
``print_claims.csv``; ours are computed here each time. A figure that nobody could look up says so:
"from memory, paper not at hand". All in half a minute, without a boundary-element solver.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import from_print_asperities as asperities
import from_print_conductance as conductance
import from_print_joints as joints
import from_print_summits as summits
from as_markdown import table

HERE = Path(__file__).parent
MISSED = 10.0  # per cent beyond which a figure is listed on the page
PARTS = {
    "Gaussian surfaces": summits,
    "Conductance of contacts": conductance,
    "Joints with gas": joints,
    "Asperities and their sums": asperities,
}
NOT_DONE = (
    "specimens of MIT report 76361-43 (1966), Hegazy (1985), Antonetti (1983) and Milanez et al. (2003)",
    "coefficients of Yastrebov et al. (2017) for the area at a given α",
    "tables of Greenwood and Williamson (1966), Greenwood (2006) and McCool (1986)",
    "curves, of which nothing was read off a plot",
)


@dataclass(frozen=True)
class Row:
    """A figure from print and ours."""

    name: str
    source: str
    printed: float
    unit: str
    seen_at: str
    ours: float
    note: str

    @property
    def deviation(self):
        """Ours over the printed one, in per cent beyond it."""
        return 100 * (self.ours / self.printed - 1)


@dataclass(frozen=True)
class Claim:
    """What a paper says without a number, whether it is so here, and in which figures."""

    name: str
    source: str
    claim: str
    seen_at: str
    holds: bool
    ours: str


def read(file):
    """The lines of a table as dictionaries."""
    with (HERE / file).open(newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def rows(part, printed):
    """Those lines of ``print.csv`` that a part computes, with what it computes."""
    for line in printed:
        if compute := part.FIGURES.get(line["name"]):
            note = compute.__doc__.removeprefix("Ours is ")
            yield Row(**{**line, "printed": float(line["printed"])}, ours=compute(), note=note)


def claims(part):
    """The claims that a part looks into."""
    for line in read("print_claims.csv"):
        if check := part.CLAIMS.get(line["name"]):
            holds, ours = check()
            yield Claim(**line, holds=holds, ours=ours)


def _per_cent(deviation):
    if abs(deviation) < 0.01:
        return "0"
    return f"{deviation:+.2g}" if abs(deviation) < 100 else f"{deviation:+.0f}"


def sheet():
    """Every printed figure and ours."""
    printed = read("print.csv")
    head = [
        "part",
        "figure",
        "unit",
        "printed",
        "mcgw",
        "deviation, %",
        "mcgw's is, and means",
        "source",
        "seen at",
    ]
    found = []
    for title, part in PARTS.items():
        for row in rows(part, printed):
            numbers = [f"{row.printed:.6g}", f"{row.ours:.6g}", _per_cent(row.deviation)]
            found.append([title, row.name, row.unit, *numbers, row.note, row.source, row.seen_at])
    return table(head, found)


def claims_sheet():
    """Every claim without a number, and whether it is so here."""
    found = [one for part in PARTS.values() for one in claims(part)]
    head = ["claim", "so here", "ours", "source", "seen at"]
    return table(head, [[x.claim, "yes" if x.holds else "no", x.ours, x.source, x.seen_at] for x in found])


def summary(printed, claimed):
    """How many published figures are near, in a sentence."""
    off = _deviations(printed)
    remembered = sum("memory" in row[printed.head.index("seen at")] for row in printed.rows)
    holds = sum(row[1] == "yes" for row in claimed.rows)
    return (
        f"{len(off)} published figures, {remembered} of them recalled and not yet compared with the papers: "
        f"{sum(x < 1 for x in off)} are met within 1 %, {sum(x > MISSED for x in off)} missed by more than "
        f"{MISSED:g} %. Of {len(claimed.rows)} claims without a number {holds} hold here."
    )


def page(printed, claimed):
    """The page of published figures: all joints with gas, and every other miss."""
    rows = [dict(zip(printed.head, row, strict=True)) for row in printed.rows]
    shown = [
        row
        for row, deviation in zip(rows, _deviations(printed), strict=True)
        if row["part"] == "Joints with gas" or deviation > MISSED
    ]
    head = ["figure", "printed", "mcgw", "deviation, %", "mcgw's is, and means"]
    body = [[_named(row), *(row[key] for key in head[1:])] for row in shown]
    return (
        f"# Published numbers\n{summary(printed, claimed)} Below: all joints with gas, and every miss; all "
        "others are in [table_printed.csv](table_printed.csv) and [table_claims.csv](table_claims.csv).\n\n"
        f"{table(head, body)}\nNot to be had: {'; '.join(NOT_DONE)}.\n"
    )


def _deviations(printed):
    return [abs(float(row[printed.head.index("deviation, %")])) for row in printed.rows]


def _named(row):
    return row["figure"] if row["unit"] == "1" else f"{row['figure']}, in {row['unit']}"
