"""What a radius for each summit costs, beside one radius for all: ``python runs/bench/random_radii.py``.

10^5 asperities, 41 separations from 0 to 4: time of set-up and of one surface, of one radius alone and as a
multiple of it, all cases in turn, and of the same sums by NumPy over the very summits.
"""

from functools import cache

import numpy as np
from scenes import drawing, set_up
from timing import Job, Times, against, parser_of, ratio, seconds, timed

import mcgw
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.own_radii import radius_table
from mcgw.sampling.samplers import cells_of
from mcgw.scene.scene import Scene

SEPARATIONS, SURFACES = np.linspace(0, 4, 41), 64
SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
FIRST, OWN = "one radius, Gaussian", "own radii"
PEER = "NumPy over the same summits"


def cases() -> dict[str, Scene]:
    """What is compared, one radius and Gaussian heights first."""
    asked = {"separations": SEPARATIONS, "ensemble": mcgw.Sampling(n_asperities=10**5), "seed": 1}
    return {
        FIRST: mcgw.Scene(SPECTRAL.surface, **asked),
        "one radius, Nayak": mcgw.Scene(SPECTRAL, summits="mean", **asked),
        OWN: mcgw.Scene(SPECTRAL, **asked),
        "own radii, load alone": mcgw.Scene(SPECTRAL, contact={"quantities": ["load"]}, **asked),
        "own radii, contacts alone": mcgw.Scene(SPECTRAL, contact={"quantities": ["contacts"]}, **asked),
    }


def by_numpy(scene: Scene) -> Job:
    """Sums of one surface whose summits are given, separation by separation."""
    summits = cache(lambda: summits_drawn(scene, cells_of(scene), 0))

    def sums(s: np.ndarray, c: np.ndarray) -> None:
        for h in SEPARATIONS:
            d = s[s > h] - h
            root = np.sqrt(c[s > h] * d)
            _ = (root * d).sum(), (c[s > h] * d).sum(), root.sum()

    def script() -> float:
        given = summits()
        return seconds(lambda: sums(*given))

    return script


def measured(rounds: int) -> Times:
    """Set-up and drawing of all cases, and the peer."""
    scenes = cases()
    jobs = {PEER: by_numpy(scenes[OWN])}
    for name, scene in scenes.items():
        jobs[f"{name}: set-up"] = set_up(scene, forget=radius_table.cache_clear)
        jobs[f"{name}: drawing"] = drawing(scene, SURFACES)
    return timed(jobs, rounds)


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of a set-up or of a surface, to those of NumPy: lower is better."""
    return against(measured(rounds), PEER)


def main() -> None:
    """Measure and print."""
    times = measured(parser_of(__doc__).parse_args().rounds)
    one = [np.median(times[f"{FIRST}: {what}"]) for what in ("set-up", "drawing")]
    print(f"{FIRST}: set-up {1e3 * one[0]:.0f} ms, {1e6 * one[1]:.0f} us a surface")
    for name in list(cases())[1:]:
        both = [ratio(times, f"{name}: {what}", f"{FIRST}: {what}") for what in ("set-up", "drawing")]
        print(f"{name:28s} set-up x {both[0]:5.2f}, drawing x {both[1]:5.2f}")
    print(f"{PEER}, without drawing them: x {ratio(times, PEER, f'{OWN}: drawing'):.1f}")


if __name__ == "__main__":
    main()
