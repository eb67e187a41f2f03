"""From a scene to the sums of its surfaces, in one straight line.

``cells``      the heights that touch, cut where a law of contact has a root (`spacing` says where else)
``counts``     how many asperities fall into each cell, exactly (`halving`, `binomial`)
``moments``    sums over the uniforms of a cell (`philox`, `uniform_sums`), or from their Gaussian limit
               (`aggregate`): all that a surface keeps
``response``   physics as a sparse matrix: `laws` on the cells and on a `tree` over them, put together
               (`assembly`) to rows that follow from each other (`tiles`)
``lanes``      four numbers at a time; with `rules` and `exp_log` it makes the same bits on every processor
``samplers``   a block of surfaces = response @ moments, and the few asperities outside the cells (`extras`,
               `hertz`)
``asperities`` the very heights that were summed, if anybody asks
"""

from contextlib import suppress
from pathlib import Path


def _forget_old_kernels(folder: Path) -> None:
    """Have kernels compiled anew that are older than any of their files.

    Numba asks whether the file of a kernel has changed, never those of the functions that it calls: after
    an update of one file the others would go on with the old one, and draw what no version draws.
    """
    with suppress(OSError):  # a folder that cannot be written to has no kernels in it
        newest = max((path.stat().st_mtime for path in folder.rglob("*.py")), default=0.0)
        for index in folder.rglob("__pycache__/*.nbi"):
            if index.stat().st_mtime < newest:
                index.unlink()


_forget_old_kernels(Path(__file__).parent)
