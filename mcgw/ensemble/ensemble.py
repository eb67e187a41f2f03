"""An ensemble: the sums of every surface, and their statistics over surfaces."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.ensemble.dataset import Dataset
from mcgw.ensemble.results import Held, Labelled, Variable, axis, statistics_of
from mcgw.formats.law_text import law_text
from mcgw.formats.table import Column, Table, evenly
from mcgw.machine.terminal import brief
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.scene.writing import accuracy_facts, contact_facts

MOST_SHOWN = 100  # separations in a table or figure beside theory
_MOST_READ = 20_000_000  # numbers that are read for a short look; of more, only how many there are
_AT = "mean +- stderr, d/sigma ="
_COLUMNS = ("column", "other_column")  # of the covariance


def _values(quantity: str, words: str) -> property:
    """Return the property of an ensemble that holds the values of a quantity."""
    return property(lambda self: self.values(quantity), doc=f"{words}; shape (surfaces, separations).")


@dataclass(frozen=True, repr=False)
class Ensemble(Dataset):
    """The sums of every surface at every separation.

    The quantities are those of the scene, such as "load" (N); "pressure" (P/A_n, Pa) and "area_fraction"
    (A/A_n, 1) follow from them.

    Parameters
    ----------
    scene : Scene
        The scene that was simulated.
    sampler : str
        The sampler that drew it.
    sums : Held
        The values of every surface, or their statistics.
    drawn_for : Scene, optional
        The scene for which the surfaces were drawn, if it is another one, as for some of its separations.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> e = mcgw.simulate(mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1))
    >>> e["load"].shape, e.mean("pressure").shape
    ((100, 3), (3,))
    >>> e  # doctest: +ELLIPSIS
    Ensemble of 100 surfaces of 300 asperities
      grading     Homogeneous()
      heights     Gaussian()
      drawn       by cells, seed 1
      elasticity  ...
      mean +- stderr, d/sigma =                    0                    1                    2
      load (N)                         78.623 +- 0.9        13.997 +- 0.3       1.2636 +- 0.08
      area (m^2)                 6.7268e-09 +- 6e-11  1.4176e-09 +- 3e-11  1.4864e-10 +- 7e-12
      stiffness (N/m)            8.2104e+07 +- 6e+05  2.0904e+07 +- 3e+05  2.5762e+06 +- 1e+05
      contacts (1)                     150.17 +- 0.9         47.49 +- 0.7          6.99 +- 0.3
    """

    scene: Scene
    sampler: str
    sums: Held
    drawn_for: Scene | None = None

    @property
    def surfaces_of(self) -> Scene:
        """The scene whose seed reproduces the surfaces."""
        return self.drawn_for or self.scene

    @property
    def n_surfaces(self) -> int:
        """Number of surfaces drawn so far; smaller than the scene's while a run is in progress."""
        return self.sums.rows()

    @property
    def _points(self) -> tuple[Scene]:
        """The scene alone."""
        return (self.scene,)

    @property
    def shape(self) -> tuple[()]:
        """No axis: there is one scene."""
        return ()

    def _held(self, point: int = 0) -> Held:  # noqa: ARG002
        """Return the values of every surface, or their statistics."""
        return self.sums

    def _at(self, which: Ints) -> "Ensemble":
        """Return the same surfaces at some separations, by their numbers; `surfaces_of` is as before."""
        scene = self.scene.replace(separations=tuple(self.separations[which].tolist()))
        return Ensemble(scene, self.sampler, self.sums.at(which), self.surfaces_of)

    def values(self, quantity: str) -> Array:
        """Return all values of a quantity in SI units, shape (surfaces, separations).

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        """
        name, per_area = self._stored(quantity)
        values = self.sums.read(name, 0, self.n_surfaces)
        return self._per_area(values) if per_area else values

    def __getitem__(self, quantity: str) -> Array:
        """Return the same as `values`."""
        return self.values(quantity)

    load = _values("load", "Load P, N")
    area = _values("area", "Real area A, m^2")
    stiffness = _values(
        "stiffness",
        "Stiffness of the contact spots, N/m: -dP/dd where nothing yields. With asperity interaction it is "
        "in series with the half-space, 1/K = 1/K_asp + compliance",
    )
    contacts = _values("contacts", "Number of contacts")
    conductance = _values(
        "conductance",
        "Contact conductance times resistivity, m. With asperity interaction it is in series with the "
        "half-space, as `stiffness` is",
    )
    pressure = _values("pressure", "Load per nominal area P/A_n, Pa")
    area_fraction = _values("area_fraction", "Real area per nominal area A/A_n")

    def labelled(self) -> Labelled:
        """Return the values of every surface; with ``keep = "statistics"`` means, deviations, covariances."""
        scene, axes = self.scene, {"separation": axis("separation", self.scene.separations)}
        sums: Any = self.sums
        if scene.keep != "statistics":
            surfaces, found = axis("surface", np.arange(sums.rows())), {}
            for name in scene.tables:
                q = scene.quantity(name)
                found[name] = Variable(("surface", "separation"), sums.tables[name], q.unit, q.long_name)
            return Labelled(found, {"surface": surfaces, **axes})
        from mcgw.ensemble.pooled import tables_of  # for those scenes alone

        order = ", ".join(f"{name} {len(scene.separations)}" for name in scene.tables)
        rows = [[self.covariance(one, other) for other in scene.tables] for one in scene.tables]
        covariance = Variable(_COLUMNS, np.block(rows), "product of units", f"covariance of {order}")
        columns = Variable(("column",), np.arange(scene.width), "1", "quantity and separation")
        scales = {name: replace(columns, dims=(name,)) for name in _COLUMNS}
        variables = {**statistics_of(self), "covariance": covariance}
        return Labelled(variables, {**axes, **scales}, drawn=tables_of(sums.parts))

    def _about(self) -> dict[str, Any]:
        """Return the title, the scene as TOML and the sampler."""
        return {"title": self.scene.title, "scene": scene_text(self.scene), "sampler": self.sampler}

    def sheet(self) -> Table:
        """Return how the ensemble was drawn, and means at the lowest, a middle and the highest separation."""
        scene, m = self.scene, self.n_surfaces
        title = f": {scene.title}" if scene.title else ""
        order = np.argsort(scene.separations, kind="stable")
        few = order[np.unique([0, len(order) // 2, len(order) - 1])]
        facts = [
            ("grading", law_text(scene.grading)),
            ("heights", law_text(scene.heights)),
            *contact_facts(scene),
            ("drawn", f"by {self.sampler}, seed {scene.seed}"),
            *accuracy_facts(scene),
            ("elasticity", scene.validity().brief),
        ]
        head = brief(f"Ensemble of {m} surfaces of {scene.n_asperities} asperities{title}")
        if m * len(scene.separations) * len(scene.quantities) > _MOST_READ:
            held = f"{', '.join(scene.quantities)} at {len(scene.separations)} separations"
            return Table((), head, [*facts, ("holds", held)])
        names = scene.answers
        columns = [Column("quantity", [f"{q} ({scene.quantity(q).unit})" for q in names], _AT)]
        mean, error = (np.array([get(q)[few] for q in names]) for get in (self.mean, self.stderr))
        for i, h in enumerate(self.separations[few]):
            columns.append(Column(f"{h:g}", mean[:, i], form=".5g"))
            columns.append(Column("stderr", error[:, i], form=".1g", between=" +- "))
        return Table(tuple(columns), head, facts)


def shown(ensemble: Ensemble) -> Ensemble:
    """Return it at 100 of its separations, evenly over their number, or as it is if there are fewer."""
    count = len(ensemble.scene.separations)
    if count <= MOST_SHOWN:
        return ensemble
    rising = np.argsort(ensemble.separations, kind="stable")
    return ensemble._at(np.sort(rising[evenly(count, MOST_SHOWN)]))


def how_many(ensemble: Ensemble) -> str:
    """Say at how many separations tables and figures are; nothing if at all of them."""
    count = len(ensemble.scene.separations)
    return f"at {MOST_SHOWN} of {count} separations" if count > MOST_SHOWN else ""
