"""What the boundary-element solves themselves depend on: mesh, size of the cell, tolerance, step."""

import math
from collections.abc import Callable

import numpy as np
from as_markdown import Sheet, load, percent, table
from deviations import deviations, number
from solve_list import HALF_STEP, TOLERANCE
from solve_table import Row

QUANTITIES = ("area", "gap", "stiffness")
Pairs = list[tuple[Row, Row]]


def same_map(rows: list[Row], purpose: str, p_factor: float = 1.0) -> Pairs:
    """Solves of a purpose, each with that of the study on the same map at the same load."""
    key: Callable[[Row, float], tuple] = lambda row, p: (row["hurst"], row["x"], row["seed"], f"{p:.6g}")  # noqa: E731
    study = {key(row, number(row, "p")): row for row in rows if row["purpose"] == "study"}
    tried = [row for row in rows if row["purpose"] == purpose]
    found = ((row, study.get(key(row, number(row, "p") / p_factor))) for row in tried)
    return [(row, other) for row, other in found if other is not None]


def mesh_table(rows: list[Row]) -> Sheet:
    """More points a wave, or fewer: change of what is compared, mean over maps."""
    groups: dict[tuple[float, float, float], Pairs] = {}
    for tried, usual in same_map(rows, "mesh"):
        key = (number(tried, "pixels"), number(tried, "x"), number(tried, "p"))
        groups.setdefault(key, []).append((tried, usual))
    lines = []
    for (pixels, alpha, p), pairs in sorted(groups.items()):
        changes = [percent(mean_change(pairs, q)) for q in ("area_raw", *QUANTITIES)]
        lines.append([f"{pixels:g}", f"{alpha:g}", load(p), str(len(pairs)), *changes])
    head = ["points a wave", "α", "p/(E* g)", "maps", "area, not corrected, %", "area, %", "gap, %"]
    return table([*head, "stiffness, %"], lines)


def mean_change(pairs: Pairs, quantity: str) -> float:
    """Mean of the new over the old, less 1."""
    return float(np.mean([number(a, quantity) / number(b, quantity) - 1 for a, b in pairs]))


def size_table(rows: list[Row]) -> Sheet:
    """Cells of twice the side: other maps, so errors of the same model are compared."""
    groups: dict[tuple[float, float], dict[str, list[Row]]] = {}
    for row in rows:
        if row["purpose"] in ("study", "size"):
            group = groups.setdefault((number(row, "x"), number(row, "p")), {"study": [], "size": []})
            group[str(row["purpose"])].append(row)
    lines = []
    for (alpha, p), group in sorted(groups.items()):
        if group["size"]:
            cells = [model_error(group[each], q) for q in ("area", "stiffness") for each in ("study", "size")]
            lines.append([f"{alpha:g}", load(p), *cells])
    head = [
        "α",
        "p/(E* g)",
        "area, %",
        "area, twice the side, %",
        "stiffness, %",
        "stiffness, twice the side, %",
    ]
    return table(head, lines)


def model_error(rows: list[Row], quantity: str) -> str:
    """Of summits of their own radii with interaction by all summits."""
    values = [
        getattr(one, quantity)
        for row in rows
        for one in deviations(row)
        if (one.model, one.interaction) == ("own radii", "summits")
    ]
    return percent(float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values)))


def tolerance_table(rows: list[Row]) -> Sheet:
    """Largest change by a tolerance a thousand times smaller, and by half the step of the stiffness."""
    tight = same_map(rows, "tolerance")
    half = same_map(rows, "step", HALF_STEP[0])
    most = [largest(tight, q) for q in QUANTITIES]
    lines = [
        [f"tolerance {TOLERANCE / 1000:g} for {TOLERANCE:g}", str(len(tight)), *most],
        ["half the step in load for stiffness", str(len(half)), "", "", largest(half, "stiffness")],
    ]
    return table(["", "solves", "area", "gap", "stiffness"], lines)


def largest(pairs: Pairs, quantity: str) -> str:
    """Largest relative change."""
    changes = (abs(number(a, quantity) / number(b, quantity) - 1) for a, b in pairs)
    return f"{max(changes, default=math.nan):.1e}"
