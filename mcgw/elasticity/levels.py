"""What models say of one periodic map under a pressure: summits alone, located, boundary elements."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from analytic.arrays import Array, Marks
from mcgw.elasticity.grid import Grid
from mcgw.elasticity.located import Located
from mcgw.elasticity.spots import HertzSpots
from mcgw.errors import RunError
from mcgw.maps.summit_sums import summit_sums_of
from mcgw.maps.summits import summits_of
from mcgw.maps.topography import Topography

QUANTITIES = ("area", "stiffness", "conductance", "mean_gap")

Values = dict[str, float]

# Share of the area that whole pixels add for each side of one at the rim (Yastrebov, Anciaux and Molinari,
# Tribol. Int. 114 (2017) 161; recalled).
_OVERHANG = (math.pi - 1 + math.log(2)) / 24
_TOLERANCE, _MOST_STEPS = 1e-6, 20_000  # of Tamaas, by its own measure
_STEP = 1.02  # from the pressure to that at which stiffness is found
_sized_grid = lru_cache(maxsize=2)(Grid)  # their potential takes as long as a balance


@dataclass(frozen=True)
class Pressed:
    """A periodic map and the pressure on it.

    Parameters
    ----------
    heights : ndarray
        m, shape (rows, columns); about their mean.
    size : (float, float)
        Extent along x and y, m.
    E_star : float
        Composite modulus, Pa.
    pressure : float
        Load per nominal area, Pa.
    """

    heights: Array
    size: tuple[float, float]
    E_star: float
    pressure: float

    @property
    def load(self) -> float:
        """N."""
        return self.pressure * self.size[0] * self.size[1]

    @cached_property
    def summits(self) -> Located:
        """Its summits where they are."""
        grid = _sized_grid(self.heights.shape, self.size, True)
        used = Topography(self.heights, grid.pixel, periodic=True)
        counted = summit_sums_of(used, across=1)
        if not counted.heights.size:
            raise RunError("a map has no summit; give a larger one, or a shorter cutoff")
        columns, rows = (
            np.rint(p * n - 0.5).astype(np.int64) % n
            for p, n in zip(counted.places, self.heights.shape[::-1], strict=True)
        )
        spots = HertzSpots(counted.heights, summits_of(used, counted, (0.0, 0.0)).radii, self.E_star)
        return Located(spots, np.array([rows, columns]), grid)

    def values(self, area: float, stiffness: float, mean_gap: float) -> Values:
        """By name, SI; the conductance is C rho in m, which follows from the stiffness (Barber 2003)."""
        conductance = 2 * stiffness / self.E_star
        return {"area": area, "stiffness": stiffness, "conductance": conductance, "mean_gap": mean_gap}


def alone(pressed: Pressed) -> Values:
    """Hertz's sums over the map's own summits, none of which feels another one."""
    located = pressed.summits
    separation = located.alone_at(pressed.load)
    depth = located.spots.heights - separation
    area = math.pi * float(located.spots.squared_radius(depth).sum())
    return pressed.values(area, float(located.spots.slope(depth).sum()), separation)


def located(pressed: Pressed) -> Values:
    """The same summits, each pressed down by all others."""
    balance = pressed.summits.at_load(pressed.load)
    return pressed.values(balance.area, balance.stiffness, balance.separation)


def boundary_elements(pressed: Pressed) -> Values:
    """The elastic half-space itself, by Tamaas (Polonsky, Keer and Rey); area less half of the rim's pixels.

    Raises
    ------
    RunError
        If Tamaas is not installed, or stops before its tolerance.
    """
    try:
        import tamaas
    except ImportError:
        raise RunError("boundary elements need Tamaas: pip install 'mcgw[bem]'") from None
    tamaas.set_log_level(tamaas.LogLevel.error)
    side = pressed.size[1]
    heights = np.ascontiguousarray(pressed.heights / side)
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, pressed.size[0] / side], list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, heights, _TOLERANCE)
    solver.max_iter = _MOST_STEPS

    def gap_at(pressure: float) -> float:
        if not (error := float(solver.solve(pressure))) <= _TOLERANCE:
            raise RunError(f"boundary elements stopped at an error of {error:g}; give a lower pressure")
        gap, traction = model.displacement[...] - heights, model.traction[...]
        return float(gap.mean() - (gap * traction).sum() / traction.sum())

    p = pressed.pressure / pressed.E_star
    gap, touching = gap_at(p), model.traction[...] > 0
    stiffness = (_STEP - 1) * p / (gap - gap_at(_STEP * p)) * pressed.E_star * pressed.size[0]
    area = rimless(touching) * pressed.size[0] * pressed.size[1]
    return pressed.values(area, stiffness, gap * side)


def rimless(touching: Marks) -> float:
    """Share of the area that touches, less what whole pixels add along its rim."""
    steps = sum(np.count_nonzero(touching != np.roll(touching, 1, axis=k)) for k in (0, 1))
    return float(touching.mean() - _OVERHANG * steps / touching.size)


@dataclass(frozen=True)
class Level:
    """A model of a pressed map: what it is called, what it is, and how it is computed."""

    name: str
    words: str
    solve: Callable[[Pressed], Values]

    def timed(self, pressed: Pressed) -> tuple[Values, float]:
        """Values, and CPU seconds."""
        begun = time.process_time()
        return self.solve(pressed), time.process_time() - begun


LEVELS = (
    Level("summits", "own summits, alone", alone),
    Level("located", "own summits, located", located),
    Level("elastic", "boundary elements", boundary_elements),
)
