"""A patch of one surface, and the spots where it touches: pictures of what the numbers are about."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.contact_map import contact_map_figure, spots_at
from mcgw.maps.envelope import envelope
from mcgw.maps.synthetic import Asperities, asperities_of
from mcgw.scene.scene import Scene

__all__ = ["Patch", "patch_figures"]

_MOST = 200_000  # asperities of a surface that is drawn whole
_FEWER = 20_000  # of a patch of a larger one
_SHARE = 0.3  # of the asperities that touch at a moderate separation
_POINTS = 400  # of the map along each side
_SHOWN = 150.0  # summits on the part of the map that is drawn
_DEPTH = 6.0  # sigma below the mean summit, to which the scale of heights reaches


@dataclass(frozen=True)
class Patch:
    """Two figures, and the separation and number of contacts of the second."""

    heights: Figure
    spots: Figure
    separation: float
    contacts: int
    whole: bool


def patch_figures(scene: Scene) -> Patch | None:
    """Heights of the first surface, and its contacts at a moderate separation.

    A surface of more than 200 000 asperities is told by a patch of another one of 20 000. None where the
    sampler has no single asperities, or nothing touches.
    """
    whole = scene.n_asperities <= _MOST
    try:
        field = asperities_of(scene if whole else _smaller(scene), 0)
    except ValueError:  # measured heights have no places, and some samplers draw no single heights
        return None
    separation = _moderate(scene, field)
    if separation is None:
        return None
    spots = spots_at(scene, field, separation)
    picture = contact_map_figure(field, spots, inches=3.6, visible=4.0)
    sigma = scene.surface.sigma
    return Patch(_heights(field, sigma), picture, separation, int(spots.radius.size), whole)


def _smaller(scene: Scene) -> Scene:
    share = _FEWER / scene.n_asperities
    return scene.replace(nominal_area=share * scene.surface.nominal_area, n_asperities=_FEWER)


def _moderate(scene: Scene, field: Asperities) -> float | None:
    """The separation of the scene that is nearest to that of so many contacts, of those with any."""
    s = field.z / scene.surface.sigma
    touched = [h for h in scene.separations if s.size and h < s.max()]
    wanted = float(np.quantile(s, 1 - _SHARE)) if s.size else 0.0
    return min(touched, key=lambda h: abs(h - wanted), default=None)


def _heights(field: Asperities, sigma: float) -> Figure:
    """The middle of the map, as large as some hundred summits are."""
    width, height = field.size
    side = min(np.sqrt(_SHOWN * width * height / max(field.number, 1)), width, height)
    left, bottom = (width - side) / 2, (height - side) / 2
    window = (left, left + side, bottom, bottom + side)
    z = 1e6 * envelope(field, (_POINTS, _POINTS), window=window).heights
    figure = Figure(figsize=(4.9, 4.2), layout="constrained")
    axes = figure.add_subplot()
    lowest = max(float(np.percentile(z, 1)), -1e6 * _DEPTH * sigma)
    extent = tuple(1e6 * edge for edge in window)
    image = axes.imshow(
        z, cmap="viridis", origin="lower", interpolation="nearest", vmin=lowest, extent=extent
    )
    axes.set(xlabel="x (µm)", ylabel="y (µm)")
    figure.colorbar(image, ax=axes, label="height above the mean summit (µm)", shrink=0.9, pad=0.02)
    return figure
