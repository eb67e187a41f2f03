"""What models say of one periodic map, pressed or brought near: summits alone, located, boundary elements."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array, Ints, Marks
from mcgw.elasticity.grid import Grid, sized_grid
from mcgw.elasticity.located import Balance, balanced
from mcgw.elasticity.spots import Spots, fallen
from mcgw.errors import RunError, extra
from mcgw.maps.summit_sums import Summits, summit_sums_of
from mcgw.maps.topography import Topography

_EITHER = ("area", "stiffness", "conductance")
QUANTITIES = {"pressure": (*_EITHER, "mean_gap"), "separation": (*_EITHER, "pressure")}  # by what is given
Values = dict[str, float]

# Share of the area that whole pixels add for each side of one at the rim (Yastrebov, Anciaux and Molinari,
# Tribol. Int. 114 (2017) 161; recalled).
_OVERHANG = (math.pi - 1 + math.log(2)) / 24
_TOLERANCE, _MOST_STEPS = 1e-6, 20_000  # of Tamaas, by its own measure
_STEP = 1.02  # from the pressure to that at which stiffness is found


@dataclass(frozen=True)
class Pressed:
    """A periodic map, and the pressure on it or the plane's distance from it."""

    heights: Array  # m, shape (rows, columns); about their mean
    size: tuple[float, float]  # extent along x and y, m
    E_star: float  # composite modulus, Pa
    pressure: float = math.nan  # load per nominal area, Pa
    separation: float | None = None  # instead: of the plane from the mean plane of the deformed surface, m

    @property
    def load(self) -> float:
        """Return the load on the map, N."""
        return self.pressure * self.size[0] * self.size[1]

    @cached_property
    def spots(self) -> Spots:
        """Hertz's contacts on its summits."""
        return Spots.hertz(self._counted.heights, self._counted.radii, self.E_star)

    def plane(self, spots: Spots) -> float:
        """Separation, or that at which spots carry the load, none of which feels another one, m."""
        return spots.separation_at(self.load) if self.separation is None else self.separation

    @property
    def grid(self) -> Grid:
        """Its points."""
        return sized_grid(self.heights.shape, self.size)

    @cached_property
    def _map(self) -> Topography:
        return Topography(self.heights, self.grid.pixel, periodic=True)

    @cached_property
    def _counted(self) -> Summits:
        """Its summits."""
        counted = summit_sums_of(self._map, across=1)
        if not counted.heights.size:
            raise RunError("a map has no summit; give a larger one, or a shorter cutoff")
        return counted

    def touching(self, fits: int = 2) -> tuple[Spots, Ints]:
        """Spots that may touch, fitted so many times to the map around them, and their rows and columns.

        Those down to as far below the plane as the highest one, if none felt another one, rises above it.
        """
        summits, pixel = self._counted, self.grid.pixel
        near = np.flatnonzero(summits.heights > 2 * self.plane(self.spots) - summits.heights.max())
        spots = Spots.hertz(summits.heights[near], summits.radii[near], self.E_star)
        for _ in range(fits):
            spots = fallen(self._map, summits, near, spots, spots.least_radii(self.plane(spots)))
        places = (
            each[near] // p % n
            for each, p, n in zip((summits.y, summits.x), pixel, self.heights.shape, strict=True)
        )
        return spots, np.array([*places], dtype=np.int64)

    def values(self, area: float, stiffness: float, pressure: float, mean_gap: float) -> Values:
        """By name, SI; the conductance is C rho in m, which follows from the stiffness (Barber 2003)."""
        conductance = 2 * stiffness / self.E_star
        found = {"area": area, "stiffness": stiffness, "conductance": conductance}
        return found | ({"mean_gap": mean_gap} if self.separation is None else {"pressure": pressure})

    def of_spots(self, spots: Spots, found: Balance) -> Values:
        """Return the sums over contacts in balance."""
        area, load = (float(part(found.penetrations).sum()) for part in (spots.areas, spots.loads))
        return self.values(area, found.stiffness, load / math.prod(self.size), found.separation)


def alone(pressed: Pressed) -> Values:
    """Hertz's sums over the map's own summits, none of which feels another one."""
    spots, separation = pressed.spots, pressed.plane(pressed.spots)
    delta = spots.heights - separation
    stiffness = float(spots.slopes(delta).sum())
    return pressed.of_spots(spots, Balance(separation, delta, stiffness, 0.0))


def located(pressed: Pressed) -> Values:
    """Return the same summits, each with the surface around it and pressed down by all others."""
    if pressed.separation is not None and pressed.separation >= pressed.spots.heights.max():
        return alone(pressed)
    spots, places = pressed.touching()
    load = pressed.load if pressed.separation is None else None
    return pressed.of_spots(spots, balanced(spots, places, pressed.grid, pressed.plane(spots), load))


def boundary_elements(pressed: Pressed) -> Values:
    """Solve the elastic half-space by Tamaas (Polonsky, Keer, Rey); area less half of the rim's pixels."""
    try:
        import tamaas
    except ImportError:
        raise RunError(f"boundary elements need Tamaas: {extra('bem')}") from None
    tamaas.set_log_level(tamaas.LogLevel.error)
    if pressed.separation is not None and pressed.separation >= pressed.heights.max():
        return pressed.values(0.0, 0.0, 0.0, 0.0)
    side = pressed.size[1]
    heights = np.ascontiguousarray(pressed.heights / side)
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, pressed.size[0] / side], list(heights.shape))
    model.E, model.nu = 1.0, 0.0

    def solve(target: float, what: "tamaas.PolonskyKeerRey.type") -> None:
        solver = tamaas.PolonskyKeerRey(model, heights, _TOLERANCE, what, what)
        solver.max_iter = _MOST_STEPS
        try:
            error = float(solver.solve(target))
        except FloatingPointError:
            more = "a higher pressure" if pressed.separation is None else "a smaller separation"
            raise RunError(f"boundary elements: of a map a single point touches; give {more}") from None
        if not error <= _TOLERANCE:
            less = "a lower pressure" if pressed.separation is None else "a larger separation"
            raise RunError(f"boundary elements stopped at an error of {error:g}; give {less}")

    def gap_at(pressure: float) -> float:
        solve(pressure, tamaas.PolonskyKeerRey.pressure)
        gap, traction = model.displacement[...] - heights, model.traction[...]
        return float(gap.mean() - (gap * traction).sum() / traction.sum())

    if pressed.separation is None:
        p = pressed.pressure / pressed.E_star
    else:  # of its tractions, which do not vanish outside of contact, the mean alone is of use
        solve(pressed.separation / side, tamaas.PolonskyKeerRey.gap)
        p = float(model.traction[...].mean())
        model.traction[...] = 0
    gap, touching = gap_at(p), model.traction[...] > 0
    stiffness = (_STEP - 1) * p / (gap - gap_at(_STEP * p)) * pressed.E_star * pressed.size[0]
    area = rimless(touching) * pressed.size[0] * pressed.size[1]
    return pressed.values(area, stiffness, p * pressed.E_star, gap * side)


def rimless(touching: Marks) -> float:
    """Share of the area that touches, less what whole pixels add along its rim."""
    steps = sum(np.count_nonzero(touching != np.roll(touching, 1, axis=k)) for k in (0, 1))
    return float(touching.mean() - _OVERHANG * steps / touching.size)


@dataclass(frozen=True)
class Level:
    """A model of a pressed map: its name, words, how it is computed, and what that costs.

    The cost is that of one map in solves of boundary elements, by CPU seconds of maps of 768^2 points with
    alpha = 20. It is a fixed number, so that a plan is the same on each machine and under any load.
    """

    name: str
    words: str
    solve: Callable[[Pressed], Values]
    cost: float

    def timed(self, pressed: Pressed) -> tuple[Values, float]:
        """Values, and CPU seconds."""
        begun = time.process_time()
        return self.solve(pressed), time.process_time() - begun


LEVELS = (
    Level("summits", "summits, independent", alone, 0.0005),
    Level("located", "summits, located", located, 0.02),
    Level("elastic", "boundary elements", boundary_elements, 1.0),
)
