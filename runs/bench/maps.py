"""Speed of synthetic maps, as a ratio to a loop over caps in NumPy; and what `mcgw fit` takes of a large one.

Both draw the envelope of the same asperities, ten pixels a cap, side by side in one process; the loop gets a
smaller area of the same density, and the ratio is that of the times of a pixel. The largest map follows, with
the time it takes. `mcgw fit` looks at 4096 x 4096 points in a process of its own: its CPU time, all cores
together, to that of a Fourier transform of the same map, and its memory, Python's own included, to that of
the map. Run: ``python runs/bench/maps.py``.
"""

import math
import resource
import subprocess
import sys
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
from scipy import fft
from timing import Job, Times, against, parser_of, seconds, timed

import analytic
from mcgw.maps.envelope import envelope
from mcgw.maps.map_files import write_map
from mcgw.maps.synthetic import Asperities, Spectrum, asperities_of, gaussian_map
from mcgw.maps.topography import Topography
from mcgw.scene.scene import Scene

LOOP, TRANSFORM, MAP = "NumPy loop", "rfft2", "bytes of the map"
SIDE, LARGE = 4096, Spectrum(1e-6, 500e-6, 10e-6)
# Memory is that of the process since it began as Python; what its parent had counts in ru_maxrss.
FIT = """
import sys, time
from mcgw.cli import main
assert main(sys.argv[1:]) == 0
(peak,) = (line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(time.process_time(), 1024 * int(peak))
"""


@cache
def field_of(number: int) -> Asperities:
    """So many asperities at one density."""
    surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e10, nominal_area=number / 1e10, E_star=1e9)
    return asperities_of(
        Scene(surface=surface, separations=(0.0,), ensemble={"n_asperities": number, "sampler": "cells"}), 0
    )


def numpy_loop(field: Asperities, pixels: int) -> np.ndarray:
    """What a user writes first: every cap into the window that it can rise in."""
    pixel = field.size[0] / pixels
    centre = (np.arange(pixels) + 0.5) * pixel
    heights = np.full((pixels, pixels), -np.inf)
    reach = 2 * math.sqrt(2 * field.radius * np.ptp(field.z))  # beyond, some other cap is higher
    for x, y, z in zip(field.x, field.y, field.z, strict=True):
        columns = slice(*np.searchsorted(centre, [x - reach, x + reach]))
        rows = slice(*np.searchsorted(centre, [y - reach, y + reach]))
        cap = z - ((centre[columns] - x) ** 2 + (centre[rows, None] - y) ** 2) / (2 * field.radius)
        np.maximum(heights[rows, columns], cap, out=heights[rows, columns])
    return heights


def fitting(folder: Path) -> dict[str, Job]:
    """Jobs on one large map: CPU seconds of a fit and of a Fourier transform; and bytes of memory."""
    file, used = folder / "large.npy", [0.0, 0.0]

    def transform() -> float:
        if not file.exists():
            drawn = gaussian_map(LARGE, (SIDE, SIDE), (1e-6, 1e-6), np.random.default_rng(1))
            write_map(Topography(drawn.heights, drawn.pixel), file)
        heights = np.load(file)
        start = process_time()
        fft.rfft2(heights)
        return process_time() - start

    def fit() -> float:
        call = [sys.executable, "-c", FIT, "fit", file, "--cutoff", "10um", "-o", folder / "large.toml"]
        said = subprocess.run(call, check=True, capture_output=True, text=True).stdout
        used[:] = map(float, said.splitlines()[-1].split())
        return used[0]

    return {TRANSFORM: transform, "fit": fit, MAP: lambda: 8.0 * SIDE**2, "memory of fit": lambda: used[1]}


def fitted(rounds: int) -> Times:
    """What these jobs take."""
    with TemporaryDirectory() as folder:
        return timed(fitting(Path(folder)), rounds)


def measured(rounds: int) -> Times:
    """Seconds a pixel of both."""
    jobs: dict[str, Job] = {
        LOOP: lambda: seconds(lambda: numpy_loop(field_of(10**4), 316), 316**2),
        "envelope": lambda: seconds(lambda: envelope(field_of(10**6), (3162, 3162)), 3162**2),
    }
    return timed(jobs, rounds)


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a pixel, to those of the loop, and what a fit takes to its peers: lower is better."""
    times = fitted(rounds)
    of_fit = against(times, TRANSFORM, ["fit"]) | against(times, MAP, ["memory of fit"])
    return against(measured(rounds), LOOP, ["envelope"]) | of_fit


def main() -> None:
    """Print the ratio, and what the largest map takes."""
    small, large = field_of(10**4), field_of(10**6)
    np.testing.assert_allclose(numpy_loop(small, 316), envelope(small, (316, 316)).heights, atol=1e-12)
    rounds = parser_of(__doc__).parse_args().rounds
    taken = {name: float(np.median(values)) for name, values in fitted(rounds).items()}
    print(
        f"mcgw fit of {SIDE} x {SIDE} points: {taken['fit']:.2f} s of CPU, "
        f"{taken['memory of fit'] / 2**20:.0f} MiB at most; its transform {taken[TRANSFORM]:.2f} s"
    )
    times = measured(rounds)
    low, middle, high = np.quantile(times[LOOP] / times["envelope"], [0, 0.5, 1])
    print(f"NumPy loop / envelope, a pixel: {middle:.3g} x ({low:.3g} ... {high:.3g})")
    took = seconds(lambda: envelope(large, (4096, 4096)))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"4096 x 4096 points of 1e6 asperities: {took:.1f} s, {memory:.2f} GiB at most")


if __name__ == "__main__":
    main()
