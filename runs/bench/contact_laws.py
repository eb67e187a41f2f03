"""What a contact law costs, beside Hertz's and beside a NumPy script: ``python runs/bench/contact_laws.py``.

10^6 asperities, 41 separations from 0 to 4, one core: time of set-up and of one surface, of Hertz's law alone
and as a multiple of it, all cases in turn. Then what a user would write: all heights by NumPy, Kogut and
Etsion's pieces with `numpy.select`, separation by separation, with sums of load, area and contacts.
"""

import numpy as np
from scenes import drawing, set_up
from timing import Job, Times, against, job, parser_of, ratio, timed

import mcgw
from analytic import laws
from mcgw.machine.threads import use_threads
from mcgw.sampling.samplers import cells_of
from mcgw.scene.scene import Scene

ASPERITIES, SEPARATIONS, SURFACES = 10**6, np.linspace(0, 4, 41), 64
SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", ASPERITIES / 300e6, "78.6 GPa")
KE = laws.KogutEtsion(critical=0.05)
PEER = "NumPy script of Kogut"


def scene_of(**changes) -> Scene:
    """The scene of all cases."""
    return mcgw.Scene(SURFACE, separations=SEPARATIONS, seed=1).replace(n_asperities=ASPERITIES, **changes)


def cases() -> dict[str, Scene]:
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


def by_numpy(seed: int) -> np.ndarray:
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


def measured(rounds: int) -> Times:
    """Set-up and drawing of all cases, and the peer, on one core."""
    jobs: dict[str, Job] = {PEER: job(lambda: by_numpy(0))}
    for name, scene in cases().items():
        jobs |= {f"{name}: set-up": set_up(scene), f"{name}: drawing": drawing(scene, SURFACES)}
    with use_threads(1):
        return timed(jobs, rounds)


def ratios(rounds: int) -> dict[str, float]:
    """Seconds of a set-up or of a surface, to those of the script: lower is better."""
    return against(measured(rounds), PEER)


def main() -> None:
    """Measure and print."""
    times = measured(parser_of(__doc__).parse_args().rounds)
    hertz = {what: np.median(times[f"Hertz: {what}"]) for what in ("set-up", "drawing")}
    print(f"Hertz: set-up {1e3 * hertz['set-up']:.0f} ms, one surface {1e3 * hertz['drawing']:.2f} ms")
    print(f"{'':>24} {'cells':>6} {'set-up':>7} {'drawing':>8}")
    for name, scene in cases().items():
        both = [ratio(times, f"{name}: {what}", f"Hertz: {what}") for what in hertz]
        print(f"{name:>24} {cells_of(scene).cells:6d} {both[0]:7.2f} {both[1]:8.2f}")
    print(f"{PEER}: {ratio(times, PEER, 'Kogut, 0.05, gamma 1: drawing'):.0f} times as long")


if __name__ == "__main__":
    main()
