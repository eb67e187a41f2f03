"""Speed of synthetic maps, as a ratio to a loop over caps in NumPy.

Both draw the envelope of the same asperities, ten pixels a cap, side by side in one process; the loop gets a
smaller area of the same density, and the ratio is that of the times of a pixel. The largest map follows, with
the time it takes. Run: ``python runs/bench/maps.py``.
"""

import math
import resource
from functools import cache

import numpy as np
from timing import Job, Times, against, parser_of, seconds, timed

import analytic
from mcgw.maps.asperities import Asperities, asperities_of
from mcgw.maps.envelope import envelope
from mcgw.scene.scene import Scene

LOOP = "NumPy loop"


@cache
def field_of(number: int) -> Asperities:
    """So many asperities at one density."""
    surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e10, nominal_area=number / 1e10, E_star=1e9)
    return asperities_of(Scene(surface=surface, separations=(0.0,), n_asperities=number, sampler="cells"), 0)


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


def measured(rounds: int) -> Times:
    """Seconds a pixel of both."""
    jobs: dict[str, Job] = {
        LOOP: lambda: seconds(lambda: numpy_loop(field_of(10**4), 316), 316**2),
        "envelope": lambda: seconds(lambda: envelope(field_of(10**6), (3162, 3162)), 3162**2),
    }
    return timed(jobs, rounds)


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a pixel, to those of the loop: lower is better."""
    return against(measured(rounds), LOOP, ["envelope"])


def main() -> None:
    """Print the ratio, and what the largest map takes."""
    small, large = field_of(10**4), field_of(10**6)
    np.testing.assert_allclose(numpy_loop(small, 316), envelope(small, (316, 316)).heights, atol=1e-12)
    times = measured(parser_of(__doc__).parse_args().rounds)
    low, middle, high = np.quantile(times[LOOP] / times["envelope"], [0, 0.5, 1])
    print(f"NumPy loop / envelope, a pixel: {middle:.3g} x ({low:.3g} ... {high:.3g})")
    took = seconds(lambda: envelope(large, (4096, 4096)))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"4096 x 4096 points of 1e6 asperities: {took:.1f} s, {memory:.2f} GiB at most")


if __name__ == "__main__":
    main()
