"""The surfaces that a table of a scene is made of: drawn at separations between which its pressures lie."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.exports.kinds import Kind
from mcgw.scene.scene import Scene

__all__ = ["checked", "surfaces_for"]

_STEP = 1 / 32  # d/sigma between separations, where quantities are read off at equal pressure
_MARGIN = 6.0  # standard deviations of the separation at which a surface has a pressure
_MOST = 2.0  # d/sigma, the margin at most: one contact alone has no standard deviation to speak of


def checked(scene: Scene, kind: Kind) -> None:
    """Refuse what has no such table.

    Raises
    ------
    ValueError
        With what the scene lacks.
    """
    if kind.quantity == "conductance" and scene.film is None:
        raise ValueError(
            "contact.conductivities: a table of conductance needs them; give conductivities = [k1, k2] in "
            "W/(m K), or resistivity, in the scene"
        )


def surfaces_for(scene: Scene, kind: Kind, pressures: NDArray[np.float64] | None, points: int) -> Ensemble:
    """Draw the surfaces of a scene, with what a table needs and nothing else.

    Parameters
    ----------
    scene : Scene
        Its surfaces; its lowest and highest separations bound the table where no pressures are given.
    kind : Kind
        Of table.
    pressures : ndarray or None
        Of the table, Pa.
    points : int
        Rows of a table against gap.

    Returns
    -------
    Ensemble
        In memory. Against gap at as many separations as there are points, or at those where the mean surface
        has the pressures; against pressure at separations 1/32 apart, so far beyond the range that every
        surface passes through it.
    """
    if pressures is None:
        low, high = min(scene.separations), max(scene.separations)
        number = points if kind.against == "gap" else max(round((high - low) / _STEP), 1) + 1
        h = np.linspace(low, high, number)
    else:
        h = np.array([float(scene.theory.separation_at("pressure", p)) for p in pressures])
        if kind.against == "pressure":
            low, high = h[-1] - _margin(scene, h[-1]), h[0] + _margin(scene, h[0])
            h = np.linspace(low, high, round((high - low) / _STEP) + 2)
    return simulate(
        replace(
            scene, separations=tuple(h.tolist()), quantities=kind.needs, keep="sums", unload_from=None,
            tangential=None, rel_err=None, max_seconds=None,
        )
    )  # fmt: skip


def _margin(scene: Scene, h: float) -> float:
    slope = float(scene.theory.slope("load", h))
    spread = float(scene.theory.std("load", h)) / slope if slope else _MOST
    return min(_MARGIN * abs(spread) + _STEP, _MOST)
