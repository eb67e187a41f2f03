"""What a contact law costs, beside Hertz's and beside a NumPy script: ``python runs/bench/contact_laws.py``.

10^6 asperities, 41 separations from 0 to 4, one core: time of set-up and of one surface, of Hertz's law alone
and as a multiple of it; medians of nine rounds, all cases in turn. Then what a user would write: all heights
by NumPy, Kogut and Etsion's pieces with `numpy.select`, separation by separation, with sums of load, area
and contacts.
"""

from statistics import median
from time import perf_counter

import numba
import numpy as np

import mcgw
from analytic import laws
from mcgw.sampling.samplers import cells_of

ASPERITIES, SEPARATIONS, SURFACES, ROUNDS = 10**6, np.linspace(0, 4, 41), 64, 9
SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", ASPERITIES / 300e6, "78.6 GPa")
KE = laws.KogutEtsion(critical=0.05)


def scene_of(**changes):
    """The scene of all cases."""
    return mcgw.Scene(SURFACE, separations=SEPARATIONS, n_asperities=ASPERITIES, seed=1, **changes)


def cases():
    """What is compared, Hertz's law first."""
    found = {"Hertz": scene_of(), "Hertz, gamma 2": scene_of(grading=mcgw.Exponential(2.0))}
    for critical in (0.003, 0.047, 0.05):
        for gamma in (1.0, 2.0):
            law, grading = laws.KogutEtsion(critical=critical), mcgw.Exponential(gamma)
            found[f"Kogut, {critical}, gamma {gamma:g}"] = scene_of(law=law, grading=grading)
    found["Kogut, 0.05, and back"] = scene_of(law=KE, unload_from="loop")
    found["Kogut, 0.003, and back"] = scene_of(law=laws.KogutEtsion(critical=0.003), unload_from="loop")
    found["graded half-space"] = scene_of(law=laws.PowerLawGraded(0.5, reduced_c0=1.0))
    found["coated"] = scene_of(law=laws.Coated(reduced_thickness=0.5, ratio=3.0))
    return found


def by_numpy(seed):
    """One surface as a script does it."""
    rng = np.random.default_rng(seed)
    s = rng.standard_normal(ASPERITIES)
    rows = []
    for h in SEPARATIONS:
        d = s[s > h] - h
        x = d / KE.critical
        limits = [x < 1, x < 6, x < 110]
        load = np.select(limits, [x**1.5, 1.03 * x**1.425, 1.40 * x**1.263], 3 * x / KE.yield_factor)
        area = np.select(limits, [x, 0.93 * x**1.136, 0.94 * x**1.146], 2 * x)
        rows.append((KE.critical**1.5 * load.sum(), KE.critical * area.sum(), d.size))
    return np.array(rows)


def main():
    """Measure and print."""
    numba.set_num_threads(1)
    scenes = cases()
    samplers = {name: cells_of(scene) for name, scene in scenes.items()}
    for sampler in samplers.values():
        sampler.block(0, SURFACES)
    setup, drawing = ({name: [] for name in scenes} for _ in range(2))
    for k in range(1, ROUNDS + 1):
        for name, sampler in samplers.items():
            start = perf_counter()
            cells_of(scenes[name])
            drawn = perf_counter()
            sampler.block(k * SURFACES, SURFACES)
            setup[name].append(drawn - start)
            drawing[name].append((perf_counter() - drawn) / SURFACES)
    first = {what: median(times["Hertz"]) for what, times in (("setup", setup), ("drawing", drawing))}
    print(f"Hertz: set-up {1e3 * first['setup']:.0f} ms, one surface {1e3 * first['drawing']:.2f} ms")
    print(f"{'':>24} {'cells':>6} {'set-up':>7} {'drawing':>8}")
    for name, sampler in samplers.items():
        ratios = median(setup[name]) / first["setup"], median(drawing[name]) / first["drawing"]
        print(f"{name:>24} {sampler.cells:6d} {ratios[0]:7.2f} {ratios[1]:8.2f}")
    by_numpy(0)
    times = []
    for seed in range(3):
        start = perf_counter()
        by_numpy(seed)
        times.append(perf_counter() - start)
    print(
        f"NumPy script of Kogut: {median(times) / median(drawing['Kogut, 0.05, gamma 1']):.0f} times as long"
    )


if __name__ == "__main__":
    main()
