"""Which maps are solved, at which loads, in which order: cheap ones first.

Loads are p/(E* g), g the rms slope of the map, and p/(E* sqrt(sigma/R)) of caps: both are p/E*, as maps have
g = 1 and sigma = R.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from rough_maps import DRAWN_PIXELS, CapsMap, GaussianMap

LOADS = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1)
FEWER = (1e-4, 1e-3, 1e-2, 1e-1)
FRESH_LOADS = (3e-4, 3e-3, 1e-2, 3e-2)
SHORTEST = {2: 64, 3: 64, 5: 64, 7: 64, 10: 80, 15: 96, 20: 96, 30: 112, 50: 140, 100: 216}
COARSER = {100: 6}  # points a shortest wave, where the usual ones took too long; how much it matters is tried
CROWDING = {0.002: 1024, 0.006: 768, 0.02: 768, 0.06: 512, 0.2: 512}  # and points along a side
CAP_LOADS = {
    0.002: (3e-5, 1e-4, 3e-4, 1e-3, 3e-3),
    0.006: (1e-4, 3e-4, 1e-3, 3e-3, 1e-2),
    0.02: (3e-4, 1e-3, 3e-3, 1e-2, 3e-2),
    0.06: (1e-3, 3e-3, 1e-2, 3e-2, 1e-1),
    0.2: (3e-3, 1e-2, 3e-2, 1e-1, 3e-1),
}
STUDY, OTHER, TWIN, FRESH = 8, 4, 2, 3  # maps of a spectrum
FRESH_SEEDS = 1000
BETWEEN = {3: 2000, 7: 3000}  # alphas between the first ones, on maps of other seeds; and those before
TOLERANCE = 1e-6  # of the solver, by its own measure
STEP = 1.02  # stiffness is that of the step from a load to this times the load: at 1.01 times the load
HALF_STEP = (1.005, 1.015)  # steps of half the width around the same load


@dataclass(frozen=True)
class Job:
    """Solves of one map.

    Parameters
    ----------
    purpose : str
        "study", "caps", "fresh", or what is tried: "mesh", "size", "tolerance", "step".
    map : GaussianMap or CapsMap
    loads : tuple of float
        From light to heavy.
    tolerance, step : float
        Of the solver; from one load to the next for stiffness, which is that of their mean.
    """

    purpose: str
    map: GaussianMap | CapsMap
    loads: tuple[float, ...]
    tolerance: float = TOLERANCE
    step: float = STEP

    def solves(self) -> Iterator[tuple[str, float]]:
        """Name of each solve, and its load."""
        closer = "" if self.tolerance == TOLERANCE else f"-t{self.tolerance:g}"
        for p in self.loads:
            yield f"{self.map.name}-p{p:g}{closer}", p


def study(alpha: int, seeds: range) -> list[Job]:
    """Maps of H = 0.8."""
    pixels = COARSER.get(alpha, DRAWN_PIXELS)
    return [Job("study", GaussianMap(0.8, alpha, seed, SHORTEST[alpha], pixels), LOADS) for seed in seeds]


def meshed(alpha: int, seeds: range, pixels: int = 2 * DRAWN_PIXELS) -> list[Job]:
    """The same maps with more points, or fewer."""
    return [Job("mesh", GaussianMap(0.8, alpha, seed, SHORTEST[alpha], pixels), FEWER) for seed in seeds]


def enlarged(alpha: int, seeds: range) -> list[Job]:
    """Maps of cells with twice the waves."""
    return [Job("size", GaussianMap(0.8, alpha, seed, 2 * SHORTEST[alpha]), FEWER[:-1]) for seed in seeds]


def caps(crowding: float) -> list[Job]:
    """Random caps."""
    loads = CAP_LOADS[crowding]
    return [Job("caps", CapsMap(crowding, seed, CROWDING[crowding]), loads) for seed in range(1, OTHER + 1)]


def fresh(alpha: int, hurst: float) -> list[Job]:
    """Maps that nothing was chosen by: other seeds, exponents and bandwidths."""
    first = FRESH_SEEDS + 1
    maps = (GaussianMap(hurst, alpha, seed, SHORTEST[alpha]) for seed in range(first, first + FRESH))
    return [Job("fresh", each, FRESH_LOADS) for each in maps]


def tightened(alpha: int) -> list[Job]:
    """A map with a tolerance a thousand times smaller, and with half the step."""
    surface = GaussianMap(0.8, alpha, 1, SHORTEST[alpha])
    first, last = HALF_STEP
    halved = tuple(first * p for p in FEWER)
    return [
        Job("tolerance", surface, FEWER, tolerance=TOLERANCE / 1000),
        Job("step", surface, halved, step=last / first),
    ]


def jobs() -> list[Job]:
    """All, in the order in which they are solved."""
    every, few = range(1, STUDY + 1), range(1, TWIN + 1)
    listed = [job for alpha in (2, 5, 10) for job in study(alpha, every)]
    listed += tightened(2) + tightened(10) + meshed(2, few) + study(20, every)
    listed += [job for crowding in (0.2, 0.06, 0.02, 0.006) for job in caps(crowding)]
    listed += [job for alpha in (3, 7, 15) for hurst in (0.5, 1.0) for job in fresh(alpha, hurst)]
    listed += [
        job for alpha, seed in BETWEEN.items() for job in study(alpha, range(seed + 1, seed + 1 + STUDY))
    ]
    listed += [Job("fresh", GaussianMap(0.6, 15, seed, 80), LOADS[1::2]) for seed in range(4001, 4009)]
    listed += study(50, range(1, 5)) + study(100, range(1, 4)) + enlarged(2, few)
    listed += (
        caps(0.002) + meshed(10, few, 6) + study(50, range(5, STUDY + 1)) + fresh(30, 0.5) + meshed(5, few)
    )
    return listed + enlarged(5, few) + meshed(10, few) + study(100, range(4, STUDY + 1)) + enlarged(20, few)
