"""Every number of the paper, and the paper itself: ``python docs/paper/paper_numbers.py`` writes both.

`numbers.json` holds them as they are printed, by the names that stand in braces in ``paper.md.in``. Timings
are ratios of ``runs/bench/history.csv``, with their machine; the errors of the model are
those of ``mcgw/validity/table.csv``, which ``runs/validation`` makes of boundary-element solves; all else is
computed here, the same on every machine. Takes a few seconds. A test compares what is written with it.
"""

import csv
import json
import math
from pathlib import Path

import numpy as np

import analytic
import mcgw
from analytic.laws import by_name
from mcgw.scene.laws import LAWS
from mcgw.statistics.verdict import FALSE_ALARM

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SOURCE, PAPER, NUMBERS = HERE / "paper.md.in", HERE / "paper.md", HERE / "numbers.json"

Numbers = dict[str, str]
Lines = list[dict[str, str]]


def numbers() -> Numbers:
    """All of them, by name."""
    return timings() | solves() | validity() | simulated() | exactness() | theory() | counted()


def paper(values: Numbers) -> str:
    """The paper with these numbers in the place of their names."""
    return SOURCE.read_text(encoding="utf-8").format_map(values)


def table(path: Path) -> Lines:
    """Rows of a CSV file with a line of names; # begins a comment."""
    lines = (ROOT / path).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def timings() -> Numbers:
    """How many times as fast as what a user would write instead, as last recorded."""
    last = table(Path("runs/bench/history.csv"))[-1]
    ratios = {
        "faster_numpy": "samplers: cells / NumPy script",
        "faster_loop": "samplers: cells / plain numba loop, all cores",
        "faster_whole": "setup: S1 / NumPy script",
        "faster_yielding": "contact_laws: Kogut, 0.05, gamma 2: drawing / NumPy script of Kogut",
    }
    cheap = float(last["samplers: h = 0 ... 4, 401 separations / h = 0 ... 4, 41 separations"]) - 1
    found = {name: f"{_two_digits(1 / float(last[column]))}" for name, column in ratios.items()}
    return found | {"machine": last["machine"], "more_separations": f"{100 * cheap:.0f} %"}


def _two_digits(x: float) -> str:
    """A number as no measurement of time tells better."""
    return f"{float(f'{x:.1e}'):.0f}" if x >= 10 else f"{x:.1f}"


def solves() -> Numbers:
    """How much was solved by boundary elements."""
    rows = table(Path("runs/validation/solves.csv"))
    seconds = [float(row["seconds"]) for row in rows]
    return {
        "solves": str(len(rows)),
        "solve_hours": f"{sum(seconds) / 3600:.1f}",
        "solve_seconds": f"{np.median(seconds):.0f}",
        "solve_points": str(max(int(float(row["n"])) for row in rows)),
    }


def validity() -> Numbers:
    """Errors of models against boundary elements: means over maps."""
    lines = [line for line in table(Path("mcgw/validity/table.csv")) if line["map"] == "gaussian"]

    def errors(quantity: str, model: str, interaction: str, alphas: str, loads: str) -> list[float]:
        return [
            100 * float(line[quantity])
            for line in lines
            if (line["model"], line["interaction"]) == (model, interaction)
            and line["x"] in alphas.split()
            and float(line["p"]) in map(float, loads.split())
        ]

    light, heavy = "1e-4 3e-4 1e-3 3e-3 1e-2", "1e-1"
    (alone,) = errors("stiffness", "own radii", "none", "2", heavy)
    (together,) = errors("stiffness", "own radii", "summits", "2", heavy)
    area = [
        x
        for model in ("one radius", "nayak", "own radii")
        for x in errors("area", model, "none", "10 20 50 100", "1e-2")
    ]
    mended = errors("stiffness", "own radii", "summits", "2 5", "3e-4 1e-3 3e-3 1e-2 3e-2")
    one = errors("area", "one radius", "none", "2", light)
    return {
        "alphas": ", ".join(sorted({line["x"] for line in lines}, key=float)),
        "area_narrow": _percent(max(map(abs, errors("area", "own radii", "none", "2", light)))),
        "area_middle": _percent(max(map(abs, errors("area", "own radii", "none", "5", light)))),
        "area_one_radius": _percent(max(map(abs, one))),
        "area_least": _percent(-max(area)),
        "area_most": _percent(-min(area)),
        "area_load": "$10^{-2}$",
        "stiffness_alone": _percent(abs(alone)),
        "stiffness_together": _percent(abs(together)),
        "stiffness_load": "$10^{-1}$",
        "stiffness_mended": _percent(max(map(abs, mended))),
        "mended_loads": "$3\\times10^{-4}$ to $3\\times10^{-2}$",
        "light_loads": "$10^{-4}$ to $10^{-2}$",
        "least_maps": str(min(int(line["maps"]) for line in lines if int(line["maps"]))),  # 0: by theory
    }


def _percent(x: float) -> str:
    return f"{x:.1f} %" if x < 10 else f"{x:.0f} %"


def simulated() -> Numbers:
    """The demo: its surfaces against the exact theory of them."""
    scene = mcgw.load_scene(ROOT / "runs" / "demo.toml")
    ensemble = mcgw.simulate(scene)
    found = mcgw.compare(ensemble)
    many, at = mcgw.simulate(scene, n_surfaces=20_000, separations=[3.0]), [3.0]
    spread, exact = (x.std("load", *y) / x.mean("load", *y) for x, y in ((many, ()), (scene.theory, (at,))))
    return {
        "demo_surfaces": str(scene.n_surfaces),
        "demo_asperities": str(scene.n_asperities),
        "demo_separations": str(len(scene.separations)),
        "demo_p": f"{found.verdict.p:.2f}",
        "demo_degrees": str(found.verdict.degrees),
        "false_alarms": f"{1 / FALSE_ALARM:.0f}",
        "spread_surfaces": str(many.n_surfaces),
        "spread_drawn": f"{100 * float(spread[0]):.1f} %",
        "spread_exact": f"{100 * float(exact[0]):.1f} %",
        "spread_at": "$3\\sigma$",
    }


def exactness() -> Numbers:
    """Sums of moments against plain sums over the very same asperities: the power of ten that bounds them."""
    surface = mcgw.load_scene(ROOT / "runs" / "demo.toml").surface
    h = np.linspace(0, 4, 9)
    scene = mcgw.Scene(
        surface,
        separations=h,
        grading=mcgw.Exponential(2.0),
        ensemble=mcgw.Sampling(n_asperities=10**6, sampler="cells"),
        n_surfaces=2,
        seed=1,
    )
    load, worst = mcgw.simulate(scene)["load"], 0.0
    for k in range(scene.n_surfaces):
        s = np.asarray(mcgw.heights(scene, k))
        each = [np.sum(np.maximum(s - x, 0) ** 1.5 * scene.grading(s)) for x in h]
        scale = 4 / 3 * surface.E_star * math.sqrt(surface.radius) * surface.sigma**1.5
        worst = max(worst, float(np.max(np.abs(load[k] / (scale * np.array(each)) - 1))))
    bound = "$10^{-12}$" if worst < 1e-12 else f"{worst:.0e}"
    return {"exact_to": bound, "scene_asperities": "$10^6$"}


def theory() -> Numbers:
    """What stiff and soft tips conduct at the load that the homogeneous surface has at 2 sigma."""
    stiff, soft = (
        float(analytic.ratio_at_equal_load("conductance", 2.0, analytic.Exponential(gamma)))
        for gamma in (2.0, 0.2)
    )
    return {"stiff": "2", "soft": "0.2", "conducts_stiff": f"{stiff:.2f}", "conducts_soft": f"{soft:.1f}"}


def counted() -> Numbers:
    """How many there are of each."""
    errata = (ROOT / "runs" / "ERRATA.md").read_text(encoding="utf-8")
    rows = [line for line in errata.splitlines() if line.startswith("| ")]
    return {
        "contact_laws": str(len(by_name)),
        "height_laws": str(len(LAWS["heights"])),
        "errata": str(len(rows) - 1),
    }


def main() -> None:
    """Write the numbers and the paper."""
    found = numbers()
    NUMBERS.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    PAPER.write_text(paper(found), encoding="utf-8")
    print(f"{NUMBERS}\n{PAPER}")


if __name__ == "__main__":
    main()
