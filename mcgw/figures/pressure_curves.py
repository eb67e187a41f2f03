"""What an engineer looks up: separation, area, stiffness and conductance against the nominal pressure."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.equal_pressure import at_pressures, common_pressures, with_values
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.style import MONTE_CARLO, SAMPLE, STYLE, power_of_ten
from mcgw.scene.samplers import promise_of

__all__ = ["MOST_SURFACES", "PressureCurve", "pressure_curves", "pressure_figure"]

Array = NDArray[np.float64]

MOST_SURFACES = 2000  # that mean and band are of: more would move them by less than a line is wide
_POINTS = 60
_BAND = (0.05, 0.95)
_PER_AREA = (  # name, factor from SI, title, unit
    ("area", 100, "Real contact area", "%"),
    ("stiffness", 1e-12, "Normal stiffness", "MPa/µm"),
    ("conductance_si", 1, "Contact conductance", "W/(m² K), or S/m²"),
    ("conductance", 1, "Contact conductance times ρ", "1/m"),
)
_FEW = 1.5  # decades, below which powers of ten are too few ticks


@dataclass(frozen=True)
class PressureCurve:
    """A quantity per nominal area at equal pressure.

    Parameters
    ----------
    title, label : str
        Of its picture and its axis, with the unit.
    pressure : ndarray
        MPa, rising.
    mean : ndarray
        Over the surfaces, in the unit of the label.
    band : (ndarray, ndarray) or None
        5 % and 95 % of the surfaces; None for one surface, or where they are no surfaces.
    logarithmic : bool
        Whether its axis is one of powers of ten.
    """

    title: str
    label: str
    pressure: Array
    mean: Array
    band: tuple[Array, Array] | None
    logarithmic: bool


def pressure_curves(ensemble: Ensemble) -> list[PressureCurve]:
    """Of what an ensemble holds, each surface read off at the pressure; empty without a common one."""
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
        curves.append(
            PressureCurve(
                title, label, pressure / 1e6, values.mean(axis=0), (low, high) if banded else None,
                name != "separation",
            )
        )  # fmt: skip
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


def pressure_figure(curve: PressureCurve) -> Figure:
    """Draw one of them."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.0, 3.0), layout="constrained")
        axes: Any = figure.add_subplot()
        if curve.band is not None:
            axes.fill_between(
                curve.pressure, *curve.band, color=SAMPLE, alpha=0.6, lw=0, label="5 to 95 % of the surfaces"
            )
        axes.plot(curve.pressure, curve.mean, color=MONTE_CARLO, label="mean")
        axes.set_xscale("log")
        _label(axes.xaxis, curve.pressure)
        if curve.logarithmic:
            axes.set_yscale("log")
            _label(axes.yaxis, np.array([curve.mean, *(curve.band or ())]))
        axes.set(xlabel="nominal pressure P/Aₙ (MPa)", ylabel=curve.label)
        axes.set_title(curve.title, loc="left")
        axes.legend(fontsize=8)
    return figure


def _label(axis: Any, values: Array) -> None:
    """Ticks of a logarithmic axis: powers of ten, and where they are few 2 and 5 times them."""
    short = np.ptp(np.log10(values)) < _FEW
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if short else (1.0,)))
    axis.set_major_formatter(FuncFormatter(power_of_ten))
    axis.set_minor_formatter(NullFormatter())
