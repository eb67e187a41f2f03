"""Numbers from print beside those of mcgw: ``python runs/validation/from_print.py`` prints the section.

What is printed, by whom and where it was seen stands in ``print.csv``, claims without a number in
``print_claims.csv``; ours are computed here each time. A figure that nobody could look up says so:
"from memory, paper not at hand". All in half a minute, without a boundary-element solver.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import from_print_asperities as asperities
import from_print_conductance as conductance
import from_print_summits as summits

HERE = Path(__file__).parent
PARTS = {
    "Gaussian surfaces": summits,
    "Conductance of contacts": conductance,
    "Asperities and their sums": asperities,
}
NOT_DONE = (
    'The measurements of MIT report 76361-43 (Mikic, Yovanovich, Rohsenow 1966, "The effect of surface '
    'roughness and waviness upon the overall thermal contact resistance"): title and abstract can be read at '
    "<https://studylib.net/doc/11135078>, its table of specimens was not to be had.",
    "The coefficients of Yastrebov, Anciaux and Molinari (2017) for the area at a given α: only the abstract "
    "was to be had, so only its claim is checked.",
    "The levels of truncation of Milanez, Yovanovich and Culham (2003), and the pressures at which they "
    "matter: abstract only.",
    "Curves: stiffness against pressure of Pastewka et al. (2013), the statistical models of Kogut and "
    "Etsion (2003) and Jackson and Green (2006), Fig. 2 to 6 of the seed paper. Nothing was read off a plot.",
    "Tables of Greenwood and Williamson (1966; measured surfaces, onset of plastic contact at 2 % of the "
    "area), of Greenwood (2006) and of McCool (1986): not to be had, and not remembered well enough.",
    "The coefficients of Thomas and Probert (1972): their dimensionless groups hold the nominal area, so "
    "they belong to the size of the specimens; only the exponents can be compared.",
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


def _table(found):
    lines = ["| figure | printed | mcgw | deviation, % | mcgw's is, and means | source; seen at |"]
    lines.append("|---|---|---|---|---|---|")
    for row in found:
        numbers = f"{row.printed:.6g} | {row.ours:.6g} | {_per_cent(row.deviation)}"
        name = row.name if row.unit == "1" else f"{row.name}, in {row.unit}"
        lines.append(f"| {name} | {numbers} | {row.note} | {row.source}; {row.seen_at} |")
    return lines


def _claimed(found):
    lines = ["| claim | so here | ours | source; seen at |", "|---|---|---|---|"]
    for one in found:
        lines.append(
            f"| {one.claim} | {'yes' if one.holds else 'no'} | {one.ours} | {one.source}; {one.seen_at} |"
        )
    return lines


def section():
    """The section as Markdown: tables, and what could not be had."""
    printed = read("print.csv")
    text = ["## Numbers from print", ""]
    remembered = sum("memory" in line["seen_at"] for line in printed)
    text.append(
        f"{len(printed)} published figures (`print.csv`), {remembered} of them from memory and still to be "
        "compared with the papers; of those seen in public code it is the number that was seen, and no paper "
        "but the seed paper was at hand. E* is the composite modulus, g = √(2 m2) the rms slope of the "
        "surface, κ = (A/A_n) E* g/p; m0, m2, m4 are moments of profiles, α = m0 m4/m2²."
    )
    for title, part in PARTS.items():
        text += ["", f"### {title}", "", *_table(rows(part, printed))]
    text += ["", "### Claims without a number", ""]
    text += _claimed([one for part in PARTS.values() for one in claims(part)])
    text += ["", "### Not done", "", *(f"- {line}" for line in NOT_DONE)]
    return "\n".join(text) + "\n"


if __name__ == "__main__":
    print(section(), end="")
