"""``mcgw warm``: compile the loops before they are needed.

A run compiles what it needs by itself. Here small scenes need all there is: every sampler, laws that add
loops of their own, radii, interaction, statistics, maps and surfaces that are made.
"""

from typing import Any


def warm() -> None:
    """Compile all loops now, once for this machine, so that later runs only load them.

    Examples
    --------
    mcgw warm
    """
    import os

    from mcgw.commands.voice import news
    from mcgw.ensemble.simulation import simulate
    from mcgw.machine.compiling import loops_folder
    from mcgw.machine.progress import steps

    _draws()
    for change in steps(_scenes(), "scenes"):
        simulate(_scene(**change))
    _maps()
    news(f"all loops are compiled; cached in {os.environ.get('NUMBA_CACHE_DIR') or loops_folder()}")


def _scene(surface: Any = None, **changes: Any) -> Any:
    """Make a small scene with changes."""
    from mcgw.scene.scene import Scene
    from mcgw.scene.surface import Surface

    surface = surface or Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    drawn = {"n_surfaces": 20, "n_asperities": 3000}
    scene = Scene(surface, separations=[0.0, 0.5, 2.0], ensemble=drawn, seed=1)
    return scene.replace(**changes)


def _scenes() -> list[dict[str, Any]]:
    """Return changes of that scene: laws, samplers, crowds, statistics, radii."""
    from analytic import KogutEtsion
    from mcgw.scene.surface import SpectralSurface

    yielding = {"law": KogutEtsion(critical=0.1)}
    spectrum = SpectralSurface(m0=1e-12, m2=1e-2, m4=4e8, nominal_area=1e-6, E_star=1e11)
    return [
        *(yielding, {**yielding, "unload_from": 0.0}, {**yielding, "sampler": "tail"}),
        *({"sampler": "direct"}, {"count": "poisson"}),
        *({"sampler": "aggregate", "n_asperities": 10**6}, {"keep": "statistics"}),
        *({"surface": spectrum, "sampler": sampler} for sampler in ("cells", "tail")),
    ]


def _maps() -> None:
    import numpy as np

    from mcgw.maps.envelope import envelope, hidden_summits
    from mcgw.maps.fitting import fit
    from mcgw.maps.synthetic import asperities_of
    from mcgw.maps.topography import Topography

    field = asperities_of(_scene(), 0)
    for periodic in (False, True):
        envelope(field, (16, 16), periodic=periodic)
        hidden_summits(field, periodic=periodic)
    heights = np.random.default_rng(1).normal(size=(64, 64)) * 1e-6
    fit(Topography(heights, (1e-6, 1e-6)), cutoff="8 um")


def _draws() -> None:
    """Draw moments of every length, without physics."""
    import numpy as np

    from mcgw.sampling.block import Layout
    from mcgw.sampling.cells import mesh_of
    from mcgw.sampling.counts import counts_of
    from mcgw.sampling.drawn_moments import OneByOne

    scene = _scene()
    mesh = mesh_of(scene)
    lengths = (np.resize(kinds, mesh.size) for kinds in ([10, 12, 16], [0, 0, 0, 4, 6, 11]))
    OneByOne().moments(1, 0, counts_of(scene, mesh, 0, 20), Layout(*lengths))
