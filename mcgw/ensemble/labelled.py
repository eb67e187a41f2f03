"""Results as named arrays with axes, units and words, for files, xarray and pandas, and as tables."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Quantity
from mcgw.formats.table import SEPARATION, Column, Table, optional
from mcgw.scene.scene import Scene

GROUP = "drawn"  # the one group of a file: what its statistics are made of
AXES = {  # of tables, in their order: unit and long name
    "point": ("1", "number of the point"),
    "surface": ("1", "number of the surface"),
    "separation": ("1", "mean-plane separation d/sigma"),
}
_WORDS = {
    "mean": "mean of the {}",
    "std": "standard deviation of the {} over surfaces",
}


@dataclass(frozen=True)
class Variable:
    """An array with the names of its axes, its unit and what it is."""

    dims: tuple[str, ...]
    values: NDArray[Any]
    units: str
    long_name: str

    @property
    def about(self) -> dict[str, str]:
        """Its attributes, as netCDF has them."""
        return {**({"units": self.units} if self.units else {}), "long_name": self.long_name}


@dataclass(frozen=True)
class Labelled:
    """Tables and the coordinates of their axes, by name, and what is said of all of them."""

    variables: Mapping[str, Variable]
    coordinates: Mapping[str, Variable]
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def in_file(self, drawn: Mapping[str, NDArray[Any]], attributes: Mapping[str, Any]) -> "Labelled":
        """Return what a file holds: these, and in one group what statistics are made of."""
        coordinates = {
            name: one if one.values.dtype.kind in "iuf" else _numbered(one)
            for name, one in self.coordinates.items()
        }
        others = [name for name, one in coordinates.items() if one.dims != (name,)]
        named = {"coordinates": " ".join(others)} if others else {}  # by which xarray knows them
        scales = {name: one for name, one in coordinates.items() if name not in others}
        made_of = {f"{GROUP}/{name}": Variable((), values, "", "") for name, values in drawn.items()}
        return Labelled({**self.variables, **made_of}, {**scales, **coordinates}, {**attributes, **named})

    def to_xarray(self, about: Mapping[str, Any]) -> Any:
        """Return an `xarray.Dataset` with these attributes.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        xarray = optional("xarray", "to_xarray")
        both = (
            {name: (one.dims, one.values, one.about) for name, one in some.items()}
            for some in (self.variables, self.coordinates)
        )
        return xarray.Dataset(*both, dict(about))

    def to_dataframe(self) -> Any:
        """Return a `pandas.DataFrame` of the tables with the axes of the first: a row for each place there.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        pandas = optional("pandas", "to_dataframe")
        first = next(iter(self.variables.values()))
        places = [
            self.coordinates[dim].values if dim in self.coordinates else np.arange(n)
            for dim, n in zip(first.dims, first.values.shape, strict=True)
        ]
        if len(places) == 1:
            index = pandas.Index(places[0], name=first.dims[0])
        else:
            index = pandas.MultiIndex.from_product(places, names=first.dims)
        alike = {name: one for name, one in self.variables.items() if one.dims == first.dims}
        columns = {name: one.values.ravel() for name, one in alike.items()}
        return pandas.DataFrame(columns, index=index)


def _numbered(one: Variable) -> Variable:
    """Return a coordinate whose values are texts by their numbers, and these in words."""
    words = ", ".join(f"{k} {value}" for k, value in enumerate(one.values))
    return replace(one, values=np.arange(len(one.values)), long_name=f"{one.long_name}: {words}")


def axis(name: str, values: Any) -> Variable:
    """Return the coordinate of an axis of this name."""
    return Variable((name,), np.asarray(values), *AXES[name])


def axes_of(scene: Scene) -> dict[str, Variable]:
    """Return the coordinates that tables of one surface of a scene have."""
    return {"separation": axis("separation", scene.separations)}


def values_of(scene: Scene, n_surfaces: int, values: Callable[[str], Any]) -> Labelled:
    """Values of so many surfaces: arrays by name, or what stands for them."""
    found = {}
    for name in scene.tables:
        q = scene.quantity(name)
        found[name] = Variable(("surface", "separation"), values(name), q.unit, q.long_name)
    axes = {"surface": np.arange(n_surfaces), "separation": scene.separations}
    return Labelled(found, {name: axis(name, values) for name, values in axes.items()})


def statistics_of(
    result: Any, names: Iterable[str], kinds: Sequence[str], lead: tuple[str, ...] = ()
) -> dict[str, Variable]:
    """Return what a result tells over its surfaces of some quantities, with axes before those of one."""
    found: dict[str, Variable] = {}
    scene = result.scenes[0] if lead else result.scene
    for name in names:
        q = scene.quantity(name)
        for kind in kinds:
            words = _WORDS[kind].format(q.long_name)
            found[f"{name}_{kind}"] = Variable(
                (*lead, "separation"), getattr(result, kind)(name), q.unit, words
            )
    return found


def heading(q: Quantity) -> str:
    """Long name and unit of a quantity, over its table."""
    return q.long_name if q.unit == "1" else f"{q.long_name} ({q.unit})"


def statistics_table(ensemble: Any, name: str) -> Table:
    """Mean, std and stderr of a quantity at every separation."""
    q = ensemble.scene.quantity(name)
    unit = q.unit
    found = [("mean", ensemble.mean(name), ".6g"), ("std", ensemble.std(name), ".3g")]
    found.append(("stderr", ensemble.stderr(name), ".3g"))
    columns = [Column(kind, values, unit=unit, form=form) for kind, values, form in found]
    columns[0] = replace(columns[0], error=found[2][1])
    separation = Column("separation", ensemble.separations, SEPARATION, form="g")
    return Table((separation, *columns), heading(q))
