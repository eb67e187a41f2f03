"""What `auto` chooses from: `tail` against `cells`, for few and many asperities and separations.

Under Hertz's law, a law that yields, and with radii of a spectrum. Medians of five rounds, in microseconds a
surface; in brackets what is expected before anything is drawn. Run: ``python runs/bench/auto.py``.
"""

import numpy as np
from scenes import S1, block
from timing import timed

import mcgw
from mcgw.sampling.expected import expected, name_of

SPECTRUM = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, 1e-6, 78.6e9)
SCENES = {
    "hertz": S1,
    "kogut-etsion": S1.replace(law=mcgw.KogutEtsion(critical=0.05)),
    "radii": mcgw.Scene(
        SPECTRUM, separations=[0.0], n_surfaces=10, ensemble=mcgw.Sampling(n_asperities=10), seed=1
    ),
}
SAMPLERS = ("tail", "cells")


def main() -> None:
    """Print a line for each pair of numbers."""
    print("law           separations  contacts              tail             cells   auto takes")
    for law, kind in SCENES.items():
        for separations in (1, 9, 41, 161, 401):
            h = np.linspace(0, 4, separations)
            for n in (6, 20, 60, 200):
                scene = kind.replace(n_asperities=n, separations=h, sampler="auto")
                each = {name: scene.replace(sampler=name) for name in SAMPLERS}
                times = timed({name: block(one) for name, one in each.items()}, 5)
                took = {name: 1e6 * float(np.median(times[name])) for name in SAMPLERS}
                numbers = " ".join(
                    f"{took[name]:8.1f} ({1e6 * expected(each[name]).seconds:6.1f})" for name in SAMPLERS
                )
                taken = name_of(scene)
                over = took[taken] / min(took.values())
                print(
                    f"{law:13} {separations:11} {n / 2:9.4g} {numbers}   {taken}"
                    + (f" ({over:.1f} times)" if over > 1 else "")
                )


if __name__ == "__main__":
    main()
