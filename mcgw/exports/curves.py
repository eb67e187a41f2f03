"""Kinds of tables and their curves: mean and quantiles over surfaces against gap or pressure, SI."""

from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.at_load import pressures_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.ensemble.solution import solutions
from mcgw.formats.table import evenly
from mcgw.scene.scene import Scene, drawn_by

_MOST = 2000  # surfaces drawn again where an ensemble keeps statistics alone
_FEWEST = 2  # points of a curve


@dataclass(frozen=True)
class Kind:
    """A table.

    Parameters
    ----------
    name : str
        Its name: quantity and argument.
    quantity : {"pressure", "conductance", "stiffness", "contact", "conducting"}
        The tabulated quantity; the last two stand for all columns of a contact table as JSON.
    against : {"gap", "pressure"}
        Its argument.
    """

    name: str
    quantity: str
    against: str

    @property
    def needs(self) -> tuple[str, ...]:
        """Quantities of an ensemble that the table needs."""
        known = {"pressure": (), "contact": ("area",), "conducting": ("area", "conductance_si")}
        return ("load", *known.get(self.quantity, (self.dataset,)))

    @property
    def dataset(self) -> str:
        """Name of the quantity in an ensemble, a sum over asperities."""
        return {"conductance": "conductance_si"}.get(self.quantity, self.quantity)

    def answer(self, scene: Scene) -> str:
        """The tabulated answer of a scene; the conductance is that of the joint, if there is one."""
        if self.quantity != "conductance":
            return self.quantity
        return "contact_conductance" if scene.joint is None else "joint_conductance"

    def stays(self, scene: Scene) -> bool:
        """Whether gas still conducts at zero load."""
        return self.quantity == "conductance" and scene.filled is not None and scene.filled.gas is not None


_ALL = (("pressure", "gap"), ("conductance", "pressure"), ("conductance", "gap"), ("stiffness", "pressure"))
KINDS = {f"{what}-{against}": Kind(f"{what}-{against}", what, against) for what, against in _ALL}
CONTACT, CONDUCTING = (Kind("contact table", what, "gap") for what in ("contact", "conducting"))


@dataclass(frozen=True)
class Curve:
    """One curve of a table.

    Parameters
    ----------
    name : str
        "mean", or a quantile such as "q05".
    x : ndarray
        Gap (m) or pressure (Pa), rising.
    y : ndarray
        Pressure (Pa), or conductance or stiffness per nominal area, SI.
    """

    name: str
    x: Array
    y: Array


def curves_at_gaps(
    ensemble: Ensemble, kind: Kind, pressures: Array | None, points: int, quantiles: tuple[float, ...]
) -> list[Curve]:
    """Mean and quantiles over surfaces at equal gap.

    Parameters
    ----------
    ensemble : Ensemble
        Its own separations are the gaps.
    kind : Kind
        Of which table.
    pressures : ndarray or None
        The first and the last bound the gaps. Default: all there are.
    points : int
        How many rows.
    quantiles : tuple of float
        Between 0 and 1; empty for the mean alone.

    Raises
    ------
    ValueError
        If there are too few points, or something that is no function.
    """
    x, mean, some = _at_gaps(ensemble, kind, pressures, points, quantiles)
    return _named(kind, quantiles, x, mean, some)


def curves_at_pressures(
    scene: Scene, kind: Kind, pressures: Array | None, points: int, quantiles: tuple[float, ...]
) -> list[Curve]:
    """Mean and quantiles over specimens that all carry the same load: those of `mcgw.solve`.

    Parameters
    ----------
    scene : Scene
        Of the specimens.
    kind : Kind
        Of which table.
    pressures : ndarray or None
        Of the rows. Default: those that the scene's separations span.
    points : int
        How many rows, where no pressures are given.
    quantiles : tuple of float
        Between 0 and 1; empty for the mean alone.

    Raises
    ------
    ValueError
        As from `mcgw.solve`; and if something is no function.
    """
    if pressures is None:
        pressures = pressures_of(scene, points)
    area, name = scene.surface.nominal_area, kind.answer(scene)
    solved = solutions(scene, "load", (area * pressures).tolist())
    per = area if kind.quantity == "stiffness" else 1.0
    mean = np.array([each.value[name] for each in solved]) / per
    some = [np.array([np.quantile(each.surfaces[name], q) for each in solved]) / per for q in quantiles]
    return _named(kind, quantiles, pressures, mean, some)


def _named(kind: Kind, quantiles: tuple[float, ...], x: Array, mean: Array, some: list[Array]) -> list[Curve]:
    names = ["mean", *map(quantile_name, quantiles)]
    return [_one_way(Curve(name, x, y), kind) for name, y in zip(names, [mean, *some], strict=True)]


def quantile_name(quantile: float) -> str:
    """Name of a quantile in file names: q05 for 0.05."""
    digits = f"{100 * quantile:.6g}"
    return f"q{digits.zfill(2)}" if "." not in digits else f"q{digits}"


def _at_gaps(
    ensemble: Ensemble, kind: Kind, pressures: Array | None, points: int, quantiles: tuple[float, ...]
) -> tuple[Array, Array, list[Array]]:
    """Gaps with the means and each quantile."""
    order = np.argsort(ensemble.separations, kind="stable")
    mean = ensemble.mean("pressure")[order]
    if np.any(mean < 0):
        worst = ensemble.separations[order][int(np.argmin(mean))]
        raise ValueError(
            f"contact.law: surfaces attract each other (mean pressure {mean.min():.3g} Pa at d/sigma = "
            f"{worst:g}), and a contact table has no negative pressures; give a law without adhesion"
        )
    if pressures is not None:
        inside = (mean >= pressures[0] * (1 - 1e-9)) & (mean <= pressures[-1] * (1 + 1e-9))
        order = order[inside]
    order = order[evenly(len(order), points)] if len(order) else order
    h, first = np.unique(ensemble.separations[order], return_index=True)
    order = order[first]
    name = kind.answer(ensemble.scene)
    x = h * ensemble.scene.surface.sigma
    some = _with_values(ensemble) if quantiles else ensemble
    return x, ensemble.mean(name)[order], [some.quantile(name, q)[order] for q in quantiles]


def _one_way(curve: Curve, kind: Kind) -> Curve:
    """Drop points without load; refuse a curve that is not monotonic."""
    carries = curve.y > 0
    x, y = curve.x[carries], curve.y[carries]
    if x.size < _FEWEST:
        raise ValueError(
            f"{kind.name}, {curve.name}: {x.size} point(s) with load; give more or smaller separations, or a "
            "wider range of pressures"
        )
    steps = np.diff(y) * (-1 if kind.against == "gap" else 1)
    if np.any(steps <= 0):
        at = x[int(np.argmin(steps))]
        raise ValueError(
            f"{kind.name}, {curve.name}: is not monotone at {kind.against} = {at:.4g}, as programs require; "
            "give fewer points, or a contact law without jumps"
        )
    return Curve(curve.name, x, y)


def _with_values(ensemble: Ensemble) -> Ensemble:
    """The ensemble itself; if it keeps only statistics, its first surfaces drawn again."""
    if ensemble.scene.keep != "statistics":
        return ensemble
    scene = drawn_by(ensemble.scene, ensemble.sampler)
    return simulate(scene, keep="sums", n_surfaces=min(ensemble.n_surfaces, _MOST))
