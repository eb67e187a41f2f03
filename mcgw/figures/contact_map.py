"""Contact spots to scale on the height map, coloured by load; and a patch for a report."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from analytic import quantity_of
from analytic.arrays import Array, Marks
from analytic.laws import Ways
from mcgw.figures.style import STYLE, save_figure
from mcgw.maps.envelope import envelope
from mcgw.maps.synthetic import Asperities
from mcgw.maps.topography import Topography
from mcgw.scene.scene import Scene

Colour = Literal["load", "modulus"]
Window = tuple[float, float, float, float]

_INCHES = 6.0
_DPI = 160
_VISIBLE = 1.8  # least pixels of the figure per radius of the median spot
_POINTS = 800  # points of the height map along each side


@dataclass(frozen=True)
class Spots:
    """Contacts under a rigid plane.

    Parameters
    ----------
    x, y, radius : ndarray
        Centre and radius, m.
    load : ndarray
        N.
    modulus : ndarray
        E*(s)/E*.
    separation : float
        Of the plane, in sigma.
    """

    x: Array
    y: Array
    radius: Array
    load: Array
    modulus: Array
    separation: float


def spots_at(scene: Scene, field: Asperities, separation: float) -> Spots:
    """Contacts of a surface at a separation.

    Parameters
    ----------
    scene : Scene
        Its surface, grading and contact law are used.
    field : Asperities
        One of its surfaces.
    separation : float
        d/sigma; not below the scene's lowest where the modulus would be negative.

    Returns
    -------
    Spots
        Of every asperity above the plane.
    """
    surface = scene.surface
    touching = field.z > separation * surface.sigma
    s = field.z[touching] / surface.sigma
    modulus = scene.modulus(s)
    delta = field.z[touching] - separation * surface.sigma
    load, radius = _load_and_radius(scene, delta, modulus, field.radii[touching])
    return Spots(field.x[touching], field.y[touching], radius, load, modulus, separation)


def _load_and_radius(scene: Scene, delta: Array, modulus: Array, radii: Array) -> tuple[Array, Array]:
    """Of contacts of these penetrations and summit radii, all in SI units."""
    surface = scene.surface
    ways, penetration, ratios = Ways(scene.contact), delta / surface.sigma, radii / surface.radius
    load, radius = (ways.term(name, 0.0, penetration, modulus, ratios) for name in ("load", "conductance"))
    scale = quantity_of("load").scale(surface)
    return scale * load, np.sqrt(surface.radius * surface.sigma) * radius


def _window(spots: Spots, size: tuple[float, float], most: float) -> Window:
    """Left, right, bottom, top: all of the map, or a window that shows the median spot large enough."""
    width, height = size
    side = np.median(spots.radius) * most
    if side >= max(size):
        return 0.0, width, 0.0, height
    left, bottom = (max(n - side, 0) / 2 for n in size)
    return left, min(left + side, size[0]), bottom, min(bottom + side, size[1])


def save_contact_map(
    field: Asperities, spots: Spots, path: Path, *, colour: Colour = "load", periodic: bool = False
) -> None:
    """Draw the contact spots on the map.

    Where they would be too small to be seen, the figure shows a window in the middle, and says so.

    Parameters
    ----------
    field : Asperities
        The whole surface.
    spots : Spots
        Contacts on it.
    path : Path
        Ending in .png, .svg or .pdf.
    colour : {"load", "modulus"}, optional
        What the colour tells.
    periodic : bool, optional
        Whether caps reach across the edges.

    Raises
    ------
    ValueError
        If nothing touches.
    OSError
        If the file cannot be written.
    """
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        save_figure(contact_map_figure(field, spots, colour=colour, periodic=periodic), path, dpi=_DPI)


def contact_map_figure(
    field: Asperities,
    spots: Spots,
    *,
    colour: Colour = "load",
    periodic: bool = False,
    inches: float = _INCHES,
    visible: float = _VISIBLE,
) -> Figure:
    """The same as a figure, of so many inches, the median spot of a radius of so many pixels or more."""
    if not spots.radius.size:
        raise ValueError(f"separation = {spots.separation:g}: there is no contact; give a smaller one")
    window = _window(spots, field.size, inches * _DPI / visible)
    topography = envelope(field, (_POINTS, _POINTS), periodic=periodic, window=window)
    figure = Figure(figsize=(inches + 2.2, inches + 0.6), layout="constrained")
    axes = figure.add_subplot()
    _draw_heights(figure, axes, topography, window)
    inside = _inside(spots, window)
    values, norm, label, scale = _values(spots, inside, colour)
    diameters = 2e6 * spots.radius[inside]
    collection = EllipseCollection(
        diameters, diameters, np.zeros(diameters.size), units="xy",
        offsets=1e6 * np.column_stack([spots.x[inside], spots.y[inside]]), offset_transform=axes.transData,
        array=values * scale, norm=norm, cmap="plasma", linewidths=0.3, edgecolors="black",
    )  # fmt: skip
    axes.add_collection(collection)
    figure.colorbar(collection, ax=axes, label=label, shrink=0.85, pad=0.02)
    whole = inside.all() and window[1] - window[0] >= field.size[0]
    seen = "" if whole else f", {np.count_nonzero(inside)} in this window of the map"
    axes.set_title(f"{spots.radius.size} contacts at $d/\\sigma$ = {spots.separation:g}{seen}", fontsize=10)
    return figure


def _inside(spots: Spots, window: Window) -> Marks:
    left, right, bottom, top = window
    r = spots.radius
    return np.asarray(
        (spots.x + r > left) & (spots.x - r < right) & (spots.y + r > bottom) & (spots.y - r < top)
    )


def _values(spots: Spots, inside: Marks, colour: Colour) -> tuple[Array, Normalize, str, float]:
    """Numbers, scale of colours, label, factor of the unit."""
    if colour == "modulus":
        low, high = float(spots.modulus.min()), float(spots.modulus.max())
        return spots.modulus[inside], Normalize(low, high if high > low else low + 1), "$E^*(s)/E^*$", 1.0
    positive = spots.load[spots.load > 0]
    top = 1e3 * float(positive.max()) if positive.size else 1.0
    return np.maximum(spots.load[inside], 1e-6 * top), LogNorm(1e-3 * top, top), "load of a spot (mN)", 1e3


def _draw_heights(figure: Figure, axes: Any, topography: Topography, window: Window) -> None:
    """Draw the height map, its grey scale from the 5th percentile of the heights on."""
    left, right, bottom, top = (1e6 * edge for edge in window)
    heights = 1e6 * topography.heights
    image = axes.imshow(
        heights,
        origin="lower",
        interpolation="nearest",
        extent=(left, right, bottom, top),
        vmin=float(np.percentile(heights, 5)),
        cmap="gray",
    )
    axes.set(xlabel="x (µm)", ylabel="y (µm)", xlim=(left, right), ylim=(bottom, top), aspect="equal")
    figure.colorbar(image, ax=axes, label="height (µm)", shrink=0.85, pad=0.02)
