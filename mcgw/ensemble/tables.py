"""The numbers of an ensemble as xarray and pandas hold them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.machine.late import optional

__all__ = ["dataframe", "dataset"]

Values = Mapping[str, NDArray[Any]]
_DIMS = ("surface", "separation", "displacement")


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
    scales = {
        "surface": ("surface", np.arange(rows), {"units": "1", "long_name": "number of the surface"}),
        "separation": (
            "separation",
            separations,
            {"units": "1", "long_name": "mean-plane separation d/sigma"},
        ),
    }
    if displacements is not None:
        about = {"units": "m", "long_name": "tangential displacement"}
        scales["displacement"] = ("displacement", displacements, about)
    return xarray.Dataset(variables, scales, dict(attributes))


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
