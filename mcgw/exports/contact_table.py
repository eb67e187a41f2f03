"""A contact table as JSON, which any program can read: all columns against the gap, with their provenance."""

from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.exports.curves import KINDS
from mcgw.scene.scene_file import scene_text

SCHEMA = Path(__file__).with_name("contact-table.schema.json")


def contact_table(ensemble: Ensemble, digest: str) -> dict[str, Any]:
    """Return what the file holds, by ``contact-table.schema.json``: means where they carry a load, SI.

    Parameters
    ----------
    ensemble : Ensemble
        With load, area and, where heat or current is conducted, conductance at several separations.
    digest : str
        Of what it was made from, in words.

    Raises
    ------
    ValueError
        If fewer than two separations carry a load, or the pressure does not fall as the gap rises.
    """
    scene, order = ensemble.scene, np.argsort(ensemble.separations)
    order = order[ensemble.mean("pressure")[order] > 0]
    pressure = ensemble.mean("pressure")[order]
    if len(order) < 2:
        raise ValueError("a contact table needs two separations or more that carry a load")
    if np.any(np.diff(pressure) >= 0):
        raise ValueError(
            "the mean pressure does not fall as the gap rises; give more surfaces, or fewer rows"
        )
    conductance = covariance = None
    if "conductance_si" in scene.quantities:
        conductance = ensemble.mean(KINDS["conductance-gap"].answer(scene))[order].tolist()
    if ensemble.n_surfaces > 1:
        covariance = ensemble.covariance("pressure")[np.ix_(order, order)].tolist()
    return {
        "format": "mcgw-contact-table-1",
        "units": {"gap": "m", "pressure": "Pa", "area": "1", "conductance": "per nominal area"},
        "gap": (ensemble.separations[order] * scene.surface.sigma).tolist(),
        "pressure": pressure.tolist(),
        "area": ensemble.mean("area_fraction")[order].tolist(),
        "conductance": conductance,
        "covariance": covariance,
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
