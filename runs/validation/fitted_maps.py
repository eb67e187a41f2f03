"""Hold what scenes fitted to fresh maps say of themselves against boundary elements.

    python runs/validation/fitted_maps.py [--solve]     (--solve needs tamaas: the extra ``bem``; 15 minutes)

Sixteen maps that no table was made from, half of which no table is about: isotropic Gaussian ones, with a lay
of 4 : 1, plateau-honed, lognormal, and of mirrored Weibull heights, each drawn twice. ``--solve`` loads them
anew and writes fitted_maps.csv; without it, those solves are read.
"""

import argparse
import csv
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rough_maps import DRAWN_PIXELS, GaussianMap, roll_off, spectrum
from scipy import fft
from scipy.special import ndtr
from solve_list import STEP

import mcgw
from analytic.surface import LEAST_ALPHA
from mcgw.maps.fit import fit_prepared
from mcgw.maps.fitted_scene import fitted_scene
from mcgw.maps.preparation import Preparation, prepared
from mcgw.maps.topography import Topography

Array = NDArray[np.float64]

PATH = Path(__file__).with_name("fitted_maps.csv")
LOADS = (0.002, 0.01, 0.05)  # p/(E* g), g the rms slope of the map
SIDE, SLOPE, MODULUS = 1e-3, 0.1, 1e9  # of the cell as a map, m; of the map; Pa: all cancel
LAY = 4
HONED, DEPTH = 1.0, 6.0  # where the plateau begins in the valleys' deviations; how much finer it is
LOGNORMAL, WEIBULL = 0.5, 1.5


def with_lay(base: GaussianMap) -> Array:
    """Waves along x are `LAY` times as long as those along y, whose shortest is that of the base."""
    n = DRAWN_PIXELS * base.shortest
    k = np.hypot(LAY * fft.rfftfreq(n, 1 / n), fft.fftfreq(n, 1 / n)[:, None])
    power = spectrum(k, base.shortest, roll_off(base.alpha, base.hurst, base.shortest), base.hurst)
    noise = np.random.default_rng(base.seed).standard_normal((n, n))
    return np.asarray(fft.irfft2(fft.rfft2(noise) * np.sqrt(power), s=(n, n)))


def honed(base: GaussianMap) -> Array:
    """A fine plateau cut into coarse valleys: the lower one of two Gaussian surfaces."""
    coarse = base.heights()
    fine = GaussianMap(base.hurst, base.alpha, base.seed + 500, base.shortest).heights()
    z = np.minimum(coarse / coarse.std() + HONED, fine / fine.std() / DEPTH)
    return smooth(z, base.shortest)


def lognormal(base: GaussianMap) -> Array:
    """Few high peaks."""
    z = base.heights()
    return smooth(np.exp(LOGNORMAL * z / z.std()), base.shortest)


def weibull(base: GaussianMap) -> Array:
    """Few deep valleys: mirrored Weibull heights."""
    z = base.heights()
    return smooth(-((-np.log(ndtr(z / z.std()))) ** (1 / WEIBULL)), base.shortest)


def smooth(z: Array, shortest: int) -> Array:
    """Without waves shorter than half of the shortest of its base: four points each."""
    series = fft.rfft2(z)
    n = len(z)
    k = np.hypot(fft.fftfreq(n, 1 / n)[:, None], fft.rfftfreq(n, 1 / n))
    return np.asarray(fft.irfft2(series * np.exp(-((k / (1.5 * shortest)) ** 4)), s=z.shape))


def plain(base: GaussianMap) -> Array:
    """As it is."""
    return base.heights()


@dataclass(frozen=True)
class FreshMap:
    """A map, and whether it is of the kind that the table is about."""

    name: str
    make: Callable[[GaussianMap], Array]
    base: GaussianMap

    def heights(self) -> Array:
        """Mean 0 and rms slope 1, in cells of side 1."""
        z = self.make(self.base)
        z = z - z.mean()
        return np.ascontiguousarray(z / math.sqrt(mean_square_slope(z)))


def mean_square_slope(z: Array) -> float:
    """Of a periodic map in a cell of side 1."""
    n = len(z)
    q = 2 * math.pi * np.hypot(fft.fftfreq(n, 1 / n)[:, None], fft.fftfreq(n, 1 / n))
    return float((np.abs(fft.fft2(z) / n**2) ** 2 * q**2).sum())


ONCE = (
    FreshMap("isotropic, alpha = 3", plain, GaussianMap(0.7, 3, 7101, 64)),
    FreshMap("isotropic, alpha = 6", plain, GaussianMap(0.9, 6, 7102, 64)),
    FreshMap("isotropic, alpha = 12", plain, GaussianMap(0.6, 12, 7103, 80)),
    FreshMap("isotropic, alpha = 32", plain, GaussianMap(0.7, 32, 7104, 112)),
    FreshMap("lay 4 : 1", with_lay, GaussianMap(0.8, 6, 7105, 64)),
    FreshMap("plateau-honed", honed, GaussianMap(0.8, 6, 7106, 64)),
    FreshMap("lognormal", lognormal, GaussianMap(0.8, 6, 7107, 64)),
    FreshMap("mirrored Weibull", weibull, GaussianMap(0.8, 6, 7108, 64)),
)
MAPS = (
    *ONCE,
    *(replace(m, name=f"{m.name}, again", base=replace(m.base, seed=m.base.seed + 1000)) for m in ONCE),
)


def solve() -> None:
    """Load every map, from light to heavy."""
    from boundary_elements import Solver

    with PATH.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("map", "p", "area", "stiffness", "gap"))
        for each in MAPS:
            solver = Solver(each.heights())
            for p in LOADS:
                found = solver.at(p)
                numbers = (f"{x:.8g}" for x in (p, found.area, found.stiffness, found.gap))
                writer.writerow((each.name, *numbers))
                file.flush()
                print(f"{each.name}  p = {p:g}  {found.seconds:.0f} s", flush=True)


@dataclass(frozen=True)
class Stated:
    """What a scene says of an error, and what it is."""

    map: str
    heights: str
    p: float
    figure: str
    said: float
    real: float

    @property
    def false(self) -> bool:
        """Whether something was said that does not hold."""
        return abs(self.real) > self.said


def stated(name: str, heights: Array, solves: Iterable[dict[str, float]]) -> Iterator[Stated]:
    """All figures of the scenes that are fitted to one map, where they say one: by two laws of heights.

    Parameters
    ----------
    name : str
        Of the map.
    heights : ndarray
        In sides of its cell, at rms slope 1.
    solves : iterable of dict
        With p, area, stiffness and gap.
    """
    n = len(heights)
    z = Topography(SLOPE * SIDE * heights, (SIDE / n, SIDE / n), periodic=True)
    fit = fit_prepared(prepared(z, Preparation(None, "none")))
    solves = list(solves)
    for law in ("gaussian", "nayak") if fit.numbers["alpha"].value > LEAST_ALPHA else ("gaussian",):
        scene = fitted_scene(fit, heights=law, E_star=MODULUS)
        for solve in solves:
            for figure, (at, real) in errors(scene, fit.mean_summit, solve).items():
                said = scene.validity(at).error[figure][0]
                if not math.isnan(said):
                    yield Stated(name, law, solve["p"], figure, float(said), real)


def errors(scene: mcgw.Scene, datum: float, solve: dict[str, float]) -> dict[str, tuple[float, float]]:
    """Of each figure the separation that it is stated at, and the model's error there."""
    theory, sigma, area = scene.theory, scene.surface.sigma, scene.surface.nominal_area
    load, gap = solve["p"] * MODULUS * SLOPE * area, solve["gap"] * SLOPE * SIDE
    at, middle = (float(theory.separation_at("load", load * share)) for share in (1.0, (1 + STEP) / 2))
    at_gap = (gap - datum) / sigma

    def off(quantity: str, h: float, right: float) -> float:
        return float(theory.mean(quantity, h)) / right - 1

    return {
        "area": (at, off("area", at, solve["area"] * area)),
        "stiffness": (at, off("stiffness", middle, solve["stiffness"] * MODULUS * area / SIDE)),
        "separation": (at, at - at_gap),
        "load": (at_gap, off("load", at_gap, load)),
    }


def read() -> dict[str, list[dict[str, float]]]:
    """The solves of each map."""
    found: dict[str, list[dict[str, float]]] = {}
    with PATH.open(newline="") as file:
        for row in csv.DictReader(file):
            found.setdefault(row.pop("map"), []).append({key: float(text) for key, text in row.items()})
    return found


def main() -> None:
    """Tell of each map how many figures are stated, and which are false."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--solve", action="store_true", help="load the maps anew")
    if parser.parse_args().solve:
        solve()
    solves = read()
    every: list[Stated] = []
    for each in MAPS:
        found = list(stated(each.name, each.heights(), solves[each.name]))
        every += found
        print(f"{each.name}: {len(found)} stated, {sum(one.false for one in found)} false")
        for one in found:
            if one.false:
                print(f"    {one.heights}, p = {one.p:g}: {one.figure} {one.real:+.3f}, said {one.said:.3f}")
    print(f"all: {sum(one.false for one in every)} of {len(every)} stated figures are false")


if __name__ == "__main__":
    main()
