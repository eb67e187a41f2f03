"""Kinds of tables and their curves: mean and quantiles over surfaces against gap or pressure, SI."""

from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.at_load import pressures_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.ensemble.solution import solutions
from mcgw.formats.table import evenly
from mcgw.scene.scene import Scene

_MOST = 2000  # surfaces drawn again where an ensemble keeps statistics alone


@dataclass(frozen=True)
class Kind:
    """A table of "pressure", "conductance" or "stiffness" against "gap" or "pressure"."""

    quantity: str
    against: str

    @property
    def name(self) -> str:
        """Quantity and argument."""
        return f"{self.quantity}-{self.against}"

    @property
    def needs(self) -> tuple[str, ...]:
        """Quantities of an ensemble that the table needs."""
        own = {"pressure": (), "conductance": ("conductance_si",)}
        return ("load", *own.get(self.quantity, (self.quantity,)))

    def answer(self, scene: Scene) -> str:
        """Return the tabulated answer of a scene; the conductance is that of the joint, if there is one."""
        if self.quantity != "conductance":
            return self.quantity
        return "contact_conductance" if scene.gas is None else "joint_conductance"

    def stays(self, scene: Scene) -> bool:
        """Whether gas still conducts at zero load."""
        return self.quantity == "conductance" and scene.filled is not None and scene.filled.gas is not None


_ALL = (("pressure", "gap"), ("conductance", "pressure"), ("conductance", "gap"), ("stiffness", "pressure"))
KINDS = {kind.name: kind for kind in (Kind(*each) for each in _ALL)}


@dataclass(frozen=True)
class Curve:
    """One curve of a table: "mean" or a quantile such as "q05"; x rises."""

    name: str
    x: Array
    y: Array


def curves_at_gaps(
    ensemble: Ensemble, kind: Kind, bounds: Array | None, points: int, quantiles: tuple[float, ...]
) -> list[Curve]:
    """Mean and quantiles over surfaces at equal gap, m.

    Parameters
    ----------
    ensemble : Ensemble
        Its own separations are the gaps.
    kind : Kind
        Of which table.
    bounds : ndarray or None
        The first and the last pressure bound the gaps. Default: all there are.
    points : int
        How many rows.
    quantiles : tuple of float
        Between 0 and 1; empty for the mean alone.

    Raises
    ------
    ValueError
        If there are too few points, or something that is no function.
    """
    order = np.argsort(ensemble.separations, kind="stable")
    mean = ensemble.mean("pressure")[order]
    if np.any(mean < 0):
        worst = ensemble.separations[order][int(np.argmin(mean))]
        raise ValueError(
            f"contact.law: surfaces attract each other (mean pressure {mean.min():.3g} Pa at d/sigma = "
            f"{worst:g}), and a contact table has no negative pressures; give a law without adhesion"
        )
    if bounds is not None:
        order = order[(mean >= bounds[0] * (1 - 1e-9)) & (mean <= bounds[-1] * (1 + 1e-9))]
    order = order[evenly(len(order), points)] if len(order) else order
    h, first = np.unique(ensemble.separations[order], return_index=True)
    order = order[first]
    name = kind.answer(ensemble.scene)
    some = ensemble
    if quantiles and ensemble.scene.keep == "statistics":  # its first surfaces are drawn again
        drawn = ensemble.scene.drawn_by(ensemble.sampler)
        some = simulate(drawn, keep="sums", n_surfaces=min(ensemble.n_surfaces, _MOST))
    values = [ensemble.mean(name)[order], *(some.quantile(name, q)[order] for q in quantiles)]
    return _named(kind, quantiles, h * ensemble.scene.surface.sigma, values)


def curves_at_pressures(
    scene: Scene, kind: Kind, pressures: Array | None, points: int, quantiles: tuple[float, ...]
) -> list[Curve]:
    """Mean and quantiles over specimens that all carry the same load: those of `mcgw.solve`.

    Parameters and errors are those of `curves_at_gaps`; default pressures are those that the scene's
    separations span.
    """
    if pressures is None:
        pressures = pressures_of(scene, points)
    area, name = scene.surface.nominal_area, kind.answer(scene)
    solved = solutions(scene, "load", (area * pressures).tolist())
    per = area if kind.quantity == "stiffness" else 1.0
    values = [[each.value[name] for each in solved]]
    values += [[float(np.quantile(each.surfaces[name], q)) for each in solved] for q in quantiles]
    return _named(kind, quantiles, pressures, [np.array(each) / per for each in values])


def _named(kind: Kind, quantiles: tuple[float, ...], x: Array, values: list[Array]) -> list[Curve]:
    """Name curves, without points that carry nothing; refuse what is not monotonic."""
    curves = []
    for name, every in zip(["mean", *map(quantile_name, quantiles)], values, strict=True):
        at, y = x[every > 0], every[every > 0]
        if at.size < 2:
            raise ValueError(
                f"{kind.name}, {name}: {at.size} point(s) with load; give more or smaller separations, or a "
                "wider range of pressures"
            )
        steps = np.diff(y) * (-1 if kind.against == "gap" else 1)
        if np.any(steps <= 0):
            worst = at[int(np.argmin(steps))]
            raise ValueError(
                f"{kind.name}, {name}: is not monotone at {kind.against} = {worst:.4g}, as programs require; "
                "give fewer points, or a contact law without jumps"
            )
        curves.append(Curve(name, at, y))
    return curves


def quantile_name(quantile: float) -> str:
    """Name of a quantile in file names: q05 for 0.05."""
    digits = f"{100 * quantile:.6g}"
    return f"q{digits.zfill(2)}" if "." not in digits else f"q{digits}"
