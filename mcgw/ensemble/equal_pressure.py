"""What each surface of an ensemble has at given nominal pressures: read off its own curve."""

from dataclasses import replace

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.storable import drawn_by

_DRAWS = 1e9  # numbers drawn for it: a second or two
_FEWEST = 20


def at_pressures(ensemble: Ensemble, pressures: Array, quantities: tuple[str, ...]) -> dict[str, Array]:
    """Quantities of every surface at its own separation for each pressure.

    Between two separations of the ensemble a quantity follows a power of the pressure, of which it nearly is
    one; the separation follows the logarithm of the pressure.

    Parameters
    ----------
    ensemble : Ensemble
        That holds the load and the quantities.
    pressures : ndarray
        Load per nominal area, Pa, shape (pressures,).
    quantities : tuple of str
        Names, or "separation" (d/sigma).

    Returns
    -------
    dict of str to ndarray
        SI, shape (surfaces, pressures); nan where the curve of a surface does not reach.
    """
    order = np.argsort(-ensemble.separations, kind="stable")
    h, wanted = ensemble.separations[order], np.log(pressures)
    loads = ensemble.values("pressure")[:, order]
    found = {}
    for name in quantities:
        values = None if name == "separation" else ensemble.values(name)[:, order]
        rows = [
            _on_one(load, h if values is None else values[i], wanted, name == "separation")
            for i, load in enumerate(loads)
        ]
        found[name] = np.array(rows)
    return found


def _on_one(load: Array, values: Array, wanted: Array, linear: bool) -> Array:
    part = loaded_part(load)
    x, y = load[part], values[part]
    if x.size < 2 or (not linear and np.any(y <= 0)):
        return np.full(wanted.shape, np.nan)
    read = np.interp(wanted, np.log(x), y if linear else np.log(y), left=np.nan, right=np.nan)
    return read if linear else np.exp(read)


def loaded_part(load: Array) -> slice:
    """Where a load along falling separations is positive and rises, up to the end; empty if nowhere."""
    falls = np.flatnonzero((load[1:] <= load[:-1]) | (load[:-1] <= 0))
    start = int(falls[-1]) + 1 if falls.size else 0
    return slice(start, len(load) if load[-1] > 0 else start)


def common_pressures(ensemble: Ensemble) -> tuple[float, float] | None:
    """Lowest and highest pressure that the curves of all surfaces reach, Pa; None if there is none."""
    order = np.argsort(-ensemble.separations, kind="stable")
    loads = ensemble.values("pressure")[:, order]
    parts = [load[loaded_part(load)] for load in loads]
    if any(part.size < 2 for part in parts):
        return None
    low, high = max(float(p[0]) for p in parts), min(float(p[-1]) for p in parts)
    return (low, high) if low < high else None


def with_values(ensemble: Ensemble, most: int) -> Ensemble:
    """The ensemble itself; or if it keeps statistics alone, so many of its first surfaces, drawn again."""
    if ensemble.scene.keep != "statistics":
        return ensemble
    scene = replace(drawn_by(ensemble.scene, ensemble.sampler), keep="sums")
    fitting = int(_DRAWS / (sampler_of(scene).draws + 1))
    return simulate(replace(scene, n_surfaces=min(ensemble.n_surfaces, most, max(fitting, _FEWEST))))
