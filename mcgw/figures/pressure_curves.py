"""What an engineer looks up: separation, area, stiffness and conductance against the nominal pressure."""

from collections.abc import Iterator

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.at_load import at_pressures, common_pressures, with_values
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.data import FigureData, Panel, Series
from mcgw.scene.samplers import promise_of

MOST_SURFACES = 2000  # that mean and band are of: more would move them by less than a line is wide
_POINTS = 60
_BAND, _OF_BAND = (0.05, 0.95), " Band: 5 to 95 % of the surfaces."
_PER_AREA = (  # name, factor from SI, title, unit
    ("area", 100, "Real contact area", "%"),
    ("stiffness", 1e-12, "Normal stiffness", "MPa/µm"),
    ("conductance_si", 1, "Contact conductance", "W/(m² K), or S/m²"),
    ("conductance", 1, "Contact conductance times ρ", "1/m"),
)


def pressure_curves(ensemble: Ensemble) -> list[FigureData]:
    """Of what an ensemble holds, each surface read off at the pressure; empty without a common one.

    Mean over the surfaces, in the unit of the label, over rising pressures in MPa; the band holds 90 % of the
    surfaces, if there are several.
    """
    if "load" not in ensemble.scene.quantities:
        return []
    first = _first(with_values(ensemble, MOST_SURFACES))
    reach = common_pressures(first)
    if reach is None:
        return []
    pressure = np.geomspace(*reach, _POINTS)
    pressure[[0, -1]] = reach  # to the last bit: beyond them there is nothing
    asked = list(_asked(ensemble))
    found = at_pressures(first, pressure, tuple(name for name, *_ in asked))
    banded = first.n_surfaces > 1 and promise_of(ensemble.sampler).real_surfaces
    curves = []
    for name, factor, title, label in asked:
        values = factor * found[name]
        if np.isnan(values).any():
            continue
        low, high = np.quantile(values, _BAND, axis=0)
        band = (low, high) if banded else None
        series = Series("mean", pressure / 1e6, values.mean(axis=0), band=band)
        scales = ("log", "linear" if name == "separation" else "log")
        panel = Panel(title, "nominal pressure P/Aₙ (MPa)", label, (series,), scales)
        curves.append(FigureData("", f"Line: mean.{_OF_BAND * banded}", (panel,)))
    return curves


def _first(ensemble: Ensemble) -> Ensemble:
    """The first surfaces, in memory."""
    names = {name for name, *_ in _asked(ensemble)} - {"separation"} | {"load"}
    rows = {name: ensemble.sums.read(name, 0, min(MOST_SURFACES, ensemble.n_surfaces)) for name in names}
    return Ensemble(ensemble.scene, ensemble.sampler, MemoryResults(rows))


def _asked(ensemble: Ensemble) -> Iterator[tuple[str, float, str, str]]:
    """Name, factor from SI, title and label of what there is."""
    scene = ensemble.scene
    per_area, held = 1 / scene.surface.nominal_area, scene.quantities
    yield "separation", 1.0, "Load: pressure at a separation", "separation d/σ"
    for name, factor, title, unit in _PER_AREA:
        if name in held and not (name == "conductance" and "conductance_si" in held):
            yield name, factor * per_area, title, f"{quantity_of(name).symbol}/Aₙ ({unit})"
