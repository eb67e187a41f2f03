"""The numbers of an ensemble as tables, and as xarray and pandas hold them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.ensemble.over_surfaces import PROBABILITIES, STATISTICS_OF
from mcgw.formats.table import SEPARATION, Column, Table
from mcgw.machine.late import optional

__all__ = [
    "dataframe",
    "dataset",
    "heading",
    "statistics_dataframe",
    "statistics_dataset",
    "statistics_table",
]

Values = Mapping[str, NDArray[Any]]
_SCALES = {
    "surface": ("1", "number of the surface"),
    "separation": ("1", "mean-plane separation d/sigma"),
    "displacement": ("m", "tangential displacement"),
    "probability": ("1", "share of the surfaces that are below"),
}
_DIMS = ("surface", "separation", "displacement")


def heading(quantity: str) -> str:
    """Long name and unit of a quantity, over its table."""
    q = quantity_of(quantity)
    return q.long_name if q.unit == "1" else f"{q.long_name} ({q.unit})"


def statistics_table(ensemble: Any, name: str) -> Table:
    """Of a quantity at every separation: mean, std, stderr; and where values are not kept, what else is."""
    unit = quantity_of(name).unit
    found = [("mean", ensemble.mean(name), ".6g"), ("std", ensemble.std(name), ".3g")]
    found.append(("stderr", ensemble.stderr(name), ".3g"))
    columns = [Column(kind, values, unit=unit, form=form) for kind, values, form in found]
    if ensemble.scene.keep == "statistics":
        columns.append(Column("skewness", ensemble.skewness(name), form=".3g"))
        quantiles = ((f"quantile_{share:g}", ensemble.quantile(name, share)) for share in PROBABILITIES)
        columns += [Column(kind, values, unit=unit) for kind, values in quantiles]
    separation = Column("separation", ensemble.separations, SEPARATION, form="g")
    return Table((separation, *columns), heading(name))


def dataset(
    sums: Values,
    separations: NDArray[np.float64],
    attributes: Mapping[str, Any],
    displacements: NDArray[np.float64] | None = None,
) -> Any:
    """An `xarray.Dataset` with dimensions, units and long names as in the file.

    Raises
    ------
    ImportError
        If xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray")
    rows = len(next(iter(sums.values())))
    variables = {}
    for name, values in sums.items():
        q = quantity_of(name)
        variables[name] = _DIMS[: values.ndim], values, {"units": q.unit, "long_name": q.long_name}
    scales = _scales({"surface": np.arange(rows), "separation": separations, "displacement": displacements})
    return xarray.Dataset(variables, scales, dict(attributes))


def statistics_dataset(
    ensemble: Any, attributes: Mapping[str, Any], displacements: NDArray[np.float64] | None = None
) -> Any:
    """An `xarray.Dataset` of the statistics of an ensemble, as its file has them.

    Raises
    ------
    ImportError
        If xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray")
    variables = {}
    for name in ensemble.scene.shapes:
        q = quantity_of(name)
        for kind, words in STATISTICS_OF.items():
            values = getattr(ensemble, kind)(name)
            about = {"units": "1" if kind == "skewness" else q.unit, "long_name": words.format(q.long_name)}
            variables[f"{name}_{kind}"] = _DIMS[1 : 1 + values.ndim], values, about
        quantiles = np.stack([ensemble.quantile(name, share) for share in PROBABILITIES])
        about = {"units": q.unit, "long_name": f"quantiles of the {q.long_name}"}
        variables[f"{name}_quantile"] = ("probability", *_DIMS[1 : quantiles.ndim]), quantiles, about
    scales = _scales(
        {
            "probability": np.array(PROBABILITIES),
            "separation": ensemble.separations,
            "displacement": displacements,
        }
    )
    return xarray.Dataset(variables, scales, dict(attributes))


def _scales(values: Mapping[str, NDArray[Any] | None]) -> dict[str, Any]:
    """Coordinates with their units and names."""
    return {
        name: (name, x, dict(zip(("units", "long_name"), _SCALES[name], strict=True)))
        for name, x in values.items()
        if x is not None
    }


def statistics_dataframe(ensemble: Any) -> Any:
    """A `pandas.DataFrame` of the statistics of an ensemble, a row for each separation.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    pandas = optional("pandas", "to_dataframe")
    index = pandas.Index(ensemble.separations, name="separation")
    names = [(name, kind) for name in ensemble.scene.quantities for kind in STATISTICS_OF]
    columns = {f"{name}_{kind}": getattr(ensemble, kind)(name) for name, kind in names}
    return pandas.DataFrame(columns, index=index)


def dataframe(sums: Values, separations: NDArray[np.float64]) -> Any:
    """A `pandas.DataFrame`, a row for each surface and separation, a column for each quantity.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    pandas = optional("pandas", "to_dataframe")
    rows = len(next(iter(sums.values())))
    index = pandas.MultiIndex.from_product([np.arange(rows), separations], names=_DIMS[:2])
    return pandas.DataFrame({name: values.ravel() for name, values in sums.items()}, index=index)
