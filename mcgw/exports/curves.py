"""Kinds of tables, and their numbers: mean and quantiles over surfaces against gap or pressure, SI."""

from typing import NamedTuple

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.at_load import pressures_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.ensemble.solution import solutions
from mcgw.formats.table import evenly
from mcgw.scene.scene import Scene

# x, rising, and by name means and quantiles, nan where nothing is carried.
Numbers = tuple[Array, dict[str, Array]]
_MOST = 2000  # surfaces drawn again where an ensemble keeps statistics alone


class Kind(NamedTuple):
    """A table of "pressure", "conductance" or "stiffness" against "gap" or "pressure"."""

    quantity: str
    against: str

    @property
    def name(self) -> str:
        """Quantity and argument."""
        return "-".join(self)

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


def surfaces_for(
    source: Scene | Ensemble, needs: tuple[str, ...], pressures: Array | None, points: int
) -> Ensemble:
    """Return the ensemble itself; of a scene its surfaces, with only what a table against the gap needs.

    They are drawn at so many separations, evenly between the lowest and the highest of the scene, or at those
    where the mean surface has the pressures.
    """
    if isinstance(source, Ensemble):
        if missing := [name for name in needs if name not in source.scene.quantities]:
            raise ValueError(
                f"contact.quantities: the ensemble has no {', '.join(missing)}; give its scene instead"
            )
        return source
    h = np.linspace(min(source.separations), max(source.separations), points)
    if pressures is not None:
        h = np.array([float(source.theory.separation_at("pressure", p)) for p in pressures])
    changes = {"keep": "sums", "unload_from": None, "rel_err": None, "max_seconds": None}
    return simulate(source.replace(separations=tuple(h.tolist()), quantities=needs, **changes))


def at_gaps(
    source: Scene | Ensemble, kind: Kind, pressures: Array | None, points: int, shares: tuple[float, ...]
) -> Numbers:
    """Return mean and quantiles of these shares over surfaces at equal gap, m.

    The pressures are those of the rows of a scene; the first and the last bound those of an ensemble, which
    has its own separations.
    """
    needs = ("load", "conductance_si") if kind.quantity == "conductance" else ("load",)
    ensemble = surfaces_for(source, needs, pressures, points)
    h, rows = np.unique(ensemble.separations, return_index=True)
    mean = ensemble.mean("pressure")[rows]
    if np.any(mean < 0):
        raise ValueError(
            f"contact.law: surfaces attract each other (mean pressure {mean.min():.3g} Pa at d/sigma = "
            f"{h[np.argmin(mean)]:g}), and a contact table has no negative pressures; give a law without "
            "adhesion"
        )
    if ensemble is source:
        if pressures is not None:
            rows = rows[(mean >= pressures[0] * (1 - 1e-9)) & (mean <= pressures[-1] * (1 + 1e-9))]
        rows = rows[evenly(len(rows), points)]
    some = ensemble
    if shares and ensemble.scene.keep == "statistics":  # its first surfaces are drawn again
        drawn = ensemble.scene.drawn_by(ensemble.sampler)
        some = simulate(drawn, keep="sums", n_surfaces=min(ensemble.n_surfaces, _MOST))
    name = kind.answer(ensemble.scene)
    values = [ensemble.mean(name)[rows], *(some.quantile(name, share)[rows] for share in shares)]
    return _checked(kind, shares, ensemble.separations[rows] * ensemble.scene.surface.sigma, values)


def at_pressures(
    scene: Scene, kind: Kind, pressures: Array | None, points: int, shares: tuple[float, ...]
) -> Numbers:
    """Return mean and quantiles over specimens that all carry the same load: those of `mcgw.solve`."""
    if pressures is None:
        pressures = pressures_of(scene, points)
    area, name = scene.surface.nominal_area, kind.answer(scene)
    solved = solutions(scene, "load", (area * pressures).tolist())
    values = [np.array([each.value[name] for each in solved])]
    values += [np.array([np.quantile(each.surfaces[name], share) for each in solved]) for share in shares]
    per = area if kind.quantity == "stiffness" else 1.0
    return _checked(kind, shares, pressures, [each / per for each in values])


def _checked(kind: Kind, shares: tuple[float, ...], x: Array, values: list[Array]) -> Numbers:
    """Name the numbers, without rows that carry nothing; refuse what is not monotonic."""
    named = dict(zip(["mean", *map(quantile_name, shares)], values, strict=True))
    for name, every in named.items():
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
    carried = values[0] > 0
    return x[carried], {name: np.where(y > 0, y, np.nan)[carried] for name, y in named.items()}


def quantile_name(quantile: float) -> str:
    """Name of a quantile in file names: q05 for 0.05."""
    digits = f"{100 * quantile:.6g}"
    return f"q{digits.zfill(2)}" if "." not in digits else f"q{digits}"
