"""A contact table as JSON, which any program can read: all columns against the gap, with their provenance."""

from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.exports.curves import KINDS
from mcgw.scene.scene_file import scene_text

FORMAT = "mcgw-contact-table-1"
SCHEMA = Path(__file__).with_name("contact-table.schema.json")
UNITS = {"gap": "m", "pressure": "Pa", "area": "1", "conductance": "per nominal area"}


def contact_table(ensemble: Ensemble, digest: str) -> dict[str, Any]:
    """Return what the file holds: means over the surfaces of an ensemble, where any of them carries a load.

    Parameters
    ----------
    ensemble : Ensemble
        With load, area and, where heat or current is conducted, conductance at several separations.
    digest : str
        Of what it was made from, in words.

    Returns
    -------
    dict
        As ``contact-table.schema.json`` says: columns against rising gaps in SI units, the covariance of the
        pressures over surfaces, provenance, and the error of the model.

    Raises
    ------
    ValueError
        If fewer than two separations carry a load, or the pressure does not fall as the gap rises.
    """
    scene = ensemble.scene
    order = np.argsort(ensemble.separations)
    order = order[ensemble.mean("pressure")[order] > 0]
    pressure = ensemble.mean("pressure")[order]
    if len(order) < 2:
        raise ValueError("a contact table needs two separations or more that carry a load")
    if np.any(np.diff(pressure) >= 0):
        raise ValueError(
            "the mean pressure does not fall as the gap rises; give more surfaces, or fewer rows"
        )
    columns = {
        "gap": ensemble.separations[order] * scene.surface.sigma,
        "pressure": pressure,
        "area": ensemble.mean("area_fraction")[order],
        "conductance": None,
        "covariance": None,
    }
    if "conductance_si" in scene.quantities:
        columns["conductance"] = ensemble.mean(KINDS["conductance-gap"].answer(scene))[order]
    if ensemble.n_surfaces > 1:
        columns["covariance"] = ensemble.covariance("pressure")[np.ix_(order, order)]
    return {
        "format": FORMAT,
        "units": UNITS,
        **{name: None if x is None else x.tolist() for name, x in columns.items()},
        "provenance": {
            "program": f"mcgw {version('mcgw')}",
            "digest": digest,
            "scene": scene_text(scene),
            "surfaces": ensemble.n_surfaces,
            "seed": scene.seed,
            "nominal_area": scene.surface.nominal_area,
        },
        "validity": scene.validity().verdict,
    }
