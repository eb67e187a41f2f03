"""Whether a smooth law of the errors in alpha and p/(E* g) tells more than the table between its rows.

    python runs/validation/smooth_law.py     (five minutes)

Each law is fitted to all rows of the Gaussian maps, in logarithms of alpha and of the load, weighted by what
eight maps tell. Two trials: each alpha between the first and the last in turn left out and told from the
others; and all fresh maps, of other seeds, exponents and bandwidths, that are in no row. Printed is the root
mean square of what is left, of area and stiffness over the right value, of the gap over the rms height.

No law is better than the table throughout, so the table stays. Of summits with radii of their own, in this
order, alphas left out: the table 0.052, 0.060, 0.046; powers up to the fourth 0.057, 0.048, 0.040; a spline
0.053, 0.053, 0.050. Fresh, 233 solves: 0.071, 0.124, 0.077; 0.077, 0.123, 0.074; 0.071, 0.124, 0.077.
"""

from typing import Any

import numpy as np
import solve_table
from deviations import deviations, number
from fresh_maps import PATH
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator

from mcgw.validity.error_table import Grid, packaged

Array = NDArray[np.float64]
MODELS = (("one radius", "none"), ("own radii", "none"), ("own radii", "summits"))
QUANTITIES = ("area", "stiffness", "separation")
ORDERS = ((2, 2), (3, 3), (4, 4))  # of ln(alpha) and ln(p), in all
NOISE = 0.01  # that no number of maps lowers


def reduced(x: Array, p: Array) -> Array:
    """Both logarithms, from about -1 to 1."""
    return np.column_stack([np.log(x / 14) / 2, np.log(p / 3e-3) / 3.5])


def powers(at: Array, orders: tuple[int, int]) -> Array:
    """Products of powers whose orders, each over its highest, add up to one at most."""
    most, high = orders
    pairs = [(i, j) for i in range(most + 1) for j in range(high + 1) if i / most + j / high <= 1 + 1e-9]
    return np.column_stack([at[:, 0] ** i * at[:, 1] ** j for i, j in pairs])


def told(law: object, known: Any, name: str, x: Array, p: Array) -> Array:
    """The bias that a law of some rows tells."""
    if law == "table":
        grid = Grid(known, along_separation=False)
        return np.array(
            [float(grid.expected(a, np.array([b])).bias[name][0]) for a, b in zip(x, p, strict=True)]
        )
    a, b, bias, std, maps = (known[key] for key in ("x", "p", name, f"{name}_std", "maps"))
    use = np.isfinite(bias) & (maps > 0)
    at, y = reduced(a[use], b[use]), (bias if name == "separation" else np.log1p(bias))[use]
    sure = 1 / np.hypot(std[use] / np.sqrt(maps[use]), NOISE)
    if law == "spline":
        found = RBFInterpolator(at, y, smoothing=0.01, degree=1)(reduced(x, p))
    else:
        assert isinstance(law, tuple)
        columns = powers(at, law)
        of = np.linalg.lstsq(columns * sure[:, None], y * sure, rcond=None)[0]
        found = powers(reduced(x, p), law) @ of
    return found if name == "separation" else np.expm1(found)


def left(name: str, real: Array, said: Array) -> Array:
    """Of errors what is not told."""
    return real - said if name == "separation" else (1 + real) / (1 + said) - 1


def main() -> None:
    """Print both trials."""
    fresh = [row for row in solve_table.read() if row["purpose"] == "fresh"] + solve_table.read(PATH)
    alpha = np.array([number(row, "m0") * number(row, "m4") / number(row, "m2") ** 2 for row in fresh])
    inside = (alpha >= 2) & (alpha <= 100)
    fresh, alpha = [row for row, ok in zip(fresh, inside, strict=True) if ok], alpha[inside]
    at = np.array([number(row, "p") for row in fresh])
    found = [{(d.model, d.interaction): d for d in deviations(row)} for row in fresh]
    laws: tuple[object, ...] = ("table", *ORDERS, "spline")
    print("".join(f"{word!s:>14}" for word in ("left out", "model", "", "quantity", *laws)))
    rows = packaged()
    for model in MODELS:
        kind = [rows[key] == word for key, word in zip(("model", "interaction"), model, strict=True)]
        known = rows[np.all([rows["map"] == "gaussian", *kind, rows["maps"] > 0], axis=0)]
        alphas = np.unique(known["x"])
        for name in QUANTITIES:
            of_alphas, of_maps = [], []
            for law in laws:
                off = []
                for out in alphas[1:-1]:
                    here = known[known["x"] == out]
                    said = told(law, known[known["x"] != out], name, here["x"], here["p"])
                    off.append(left(name, here[name], said))
                of_alphas.append(np.sqrt(np.mean(np.concatenate(off) ** 2)))
                real = np.array([getattr(each[model], name) for each in found])
                of_maps.append(np.sqrt(np.mean(left(name, real, told(law, known, name, alpha, at)) ** 2)))
            for what, numbers in (("alphas", of_alphas), (f"{len(fresh)} solves", of_maps)):
                words = (what, *model, name, *(f"{x:.4f}" for x in numbers))
                print("".join(f"{word:>14}" for word in words))


if __name__ == "__main__":
    main()
