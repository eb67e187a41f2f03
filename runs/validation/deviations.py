"""How far each model is from boundary elements, solve by solve, and condensed over maps to one table."""

import csv
import hashlib
import io
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from models import INTERACTIONS, MODELS, Model, Summits, listed, summits_of
from rough_maps import CapsMap, GaussianMap
from solve_list import STEP
from solve_table import Row

QUANTITIES = ("area", "stiffness", "separation", "load")
COLUMNS = (
    "map", "model", "interaction", "x", "p", "area", "area_std", "stiffness", "stiffness_std",
    "separation", "separation_std", "load", "load_std", "maps", "contacts", "waves",
)  # fmt: skip


@dataclass(frozen=True)
class Deviation:
    """One model against one solve: area, stiffness, load as model/BEM - 1, separation over sqrt(m0)."""

    model: str
    interaction: str
    area: float
    stiffness: float
    separation: float
    load: float


def number(row: Row, key: str) -> float:
    """A number of a row."""
    return float(row[key])


def caps_of(row: Row) -> CapsMap:
    """The map of caps behind a row."""
    return CapsMap(
        number(row, "x"), int(number(row, "seed")), int(number(row, "n")), int(number(row, "waves"))
    )


def summits_behind(row: Row, model: str) -> Summits:
    """What a model makes of the map of a row."""
    if row["kind"] == "caps":
        return listed(caps_of(row))
    return summits_of(model, *(number(row, key) for key in ("m0", "m2", "m4")))


def deviations(row: Row) -> list[Deviation]:
    """Every model, with every interaction, against one solve."""
    p, gap, unit = number(row, "p"), number(row, "gap"), math.sqrt(number(row, "m0"))
    found = []
    for name in MODELS if row["kind"] == "gaussian" else MODELS[:1]:
        summits = summits_behind(row, name)
        x, beside = summits.separation(p), summits.separation((1 + STEP) / 2 * p)
        area = summits.at(x).area / number(row, "area") - 1
        for interaction in INTERACTIONS:
            model = Model(summits, interaction)
            found.append(
                Deviation(
                    model=name,
                    interaction=interaction,
                    area=area,
                    stiffness=model.stiffness(beside) / number(row, "stiffness") - 1,
                    separation=(model.gap(x) - gap) / unit,
                    load=model.load_at(gap) / p - 1,
                )
            )
    return found


def waves(row: Row) -> float:
    """Independent heights on the map of a row; nan of caps, which have no spectrum."""
    if row["kind"] == "caps":
        return math.nan
    alpha, hurst, shortest = (number(row, key) for key in ("x", "hurst", "waves"))
    return independent(alpha, hurst, int(shortest))


@lru_cache
def independent(alpha: float, hurst: float, shortest: int) -> float:
    """The same, for maps of one spectrum."""
    return GaussianMap(hurst, alpha, 0, shortest).independent()


def contacts(row: Row) -> float:
    """Loaded spots on the map of a row, by the model of one radius."""
    summits = summits_behind(row, MODELS[0])
    return summits.at(summits.separation(number(row, "p"))).spots


@dataclass(frozen=True)
class Condensed:
    """Mean and standard deviation, over the maps of one kind, of one model at one load."""

    map: str
    model: str
    interaction: str
    x: float
    p: float
    mean: dict[str, float]
    std: dict[str, float]
    maps: int
    contacts: float
    waves: float

    def error(self, quantity: str) -> float:
        """Standard error of the mean."""
        return self.std[quantity] / math.sqrt(self.maps)


Key = tuple[str, float, float]


def condensed(rows: Iterable[Row]) -> list[Condensed]:
    """All models, by kind of map, x and load; those for which a map is outside of the model are nan."""
    groups: dict[Key, list[Row]] = {}
    for row in rows:
        groups.setdefault((str(row["kind"]), number(row, "x"), number(row, "p")), []).append(row)
    order = sorted(groups, key=lambda key: (key[0] != "gaussian", *key[1:]))
    return [line for key in order for line in _of_group(key, groups[key])]


def _of_group(key: Key, rows: list[Row]) -> Iterable[Condensed]:
    spots = float(np.mean([contacts(row) for row in rows]))
    for same in zip(*(deviations(row) for row in rows), strict=True):
        values = {q: np.array([getattr(one, q) for one in same]) for q in QUANTITIES}
        yield Condensed(
            map=key[0],
            model=same[0].model,
            interaction=same[0].interaction,
            x=key[1],
            p=key[2],
            mean={q: float(v.mean()) for q, v in values.items()},
            std={q: float(v.std(ddof=1)) if len(v) > 1 else math.nan for q, v in values.items()},
            maps=len(rows),
            contacts=spots,
            waves=waves(rows[0]),
        )


def table_text(lines: list[Condensed], source: bytes, solves: int) -> str:
    """The condensed table as it is written: four digits after the point."""
    text, digest = io.StringIO(), hashlib.sha256(source).hexdigest()[:16]
    text.write(
        "# Models of asperities against boundary elements (runs/validation/README.md), made by build.py\n"
        f"# from {solves} solves of runs/validation/solves.csv, sha256 {digest}\n"
        "# x: Nayak's alpha (gaussian), eta R sigma (caps); p: p/(E* g), g rms slope; p/(E* sqrt(sigma/R))\n"
        "# area, stiffness: model/BEM - 1 at p; load: the same at the gap of BEM\n"
        "# separation: (model - BEM) at p, over the rms height of the map (gaussian), sigma (caps)\n"
        "# *_std: deviation between maps, not of their mean; nan: the model has no such state\n"
        "# contacts, waves: of a map, loaded spots and independent heights\n"
        "# maps = 0: lighter loads than were solved, by theory; *_std: how unsure that is (limits.py)\n"
    )
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for line in lines:
        pairs = [f"{value:.4f}" for q in QUANTITIES for value in (line.mean[q], line.std[q])]
        first = (line.map, line.model, line.interaction, f"{line.x:g}", f"{line.p:.4g}")
        writer.writerow((*first, *pairs, line.maps, f"{line.contacts:.4g}", f"{line.waves:.4g}"))
    return text.getvalue()


def write_table(lines: list[Condensed], solves_csv: Path, solves: int, path: Path) -> None:
    """Write the condensed table."""
    path.write_text(table_text(lines, solves_csv.read_bytes(), solves))
