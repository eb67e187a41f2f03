"""The statistics of a sweep as xarray holds them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.machine.late import optional
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.sweeps.axes import Axes, label

__all__ = ["sweep_dataset"]

_KINDS = {"mean": "mean of the {}", "std": "standard deviation of the {} over surfaces"}


def sweep_dataset(
    axes: Axes,
    scene: Scene,
    values: Mapping[tuple[str, str], NDArray[np.float64]],
) -> Any:
    """An `xarray.Dataset` with a dimension for each axis, or "point" for zipped ones.

    Parameters
    ----------
    axes : Axes
        Keys and values.
    scene : Scene
        Of the first point.
    values : dict of (str, str) to ndarray
        By quantity and statistic, shape (axes ..., separations).

    Raises
    ------
    ImportError
        If xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray")
    last = ("separation", "displacement")
    variables = {}
    for (name, kind), array in values.items():
        q = quantity_of(name)
        about = {"units": q.unit, "long_name": _KINDS[kind].format(q.long_name)}
        variables[f"{name}_{kind}"] = (*axes.dims, *last[: array.ndim - len(axes.dims)]), array, about
    about = {"units": "1", "long_name": "mean-plane separation d/sigma"}
    coordinates = {"separation": ("separation", np.array(scene.separations), about)}
    for key, given in axes.values.items():
        dim = "point" if axes.zipped else key
        coordinates[key] = (dim, np.array([label(value) for value in given]), {"long_name": key})
    if scene.tangential is not None:
        about = {"units": "m", "long_name": "tangential displacement"}
        coordinates["displacement"] = ("displacement", np.array(scene.tangential.displacements), about)
    attributes = {"title": scene.title, "first_scene": scene_text(scene)}
    return xarray.Dataset(variables, coordinates, attributes)
