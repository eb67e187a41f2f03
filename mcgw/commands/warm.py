"""``mcgw warm``: compile the loops before they are needed.

A run compiles what it needs by itself. Here small scenes need all there is: every sampler, laws that add
loops of their own, radii, interaction, statistics, maps and surfaces that are made.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcgw.scene.scene import Scene


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

    plain, *others = _scenes()
    _draws(plain)
    for scene in steps(others, "scenes"):
        simulate(scene)
    _maps(plain)
    news(f"all loops are compiled; cached in {os.environ.get('NUMBA_CACHE_DIR') or loops_folder()}")


def _scenes() -> list["Scene"]:
    """Return a small scene, and changed ones: laws, samplers, crowds, statistics, radii."""
    from analytic import KogutEtsion, Nayak, RandomCurvature
    from mcgw.scene.scene import Scene
    from mcgw.scene.surface import Surface

    surface = Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    drawn = {"n_surfaces": 20, "n_asperities": 3000}
    scene = Scene(surface, separations=[0.0, 0.5, 2.0], ensemble=drawn, seed=1)
    yielding: dict[str, Any] = {"law": KogutEtsion(critical=0.1)}
    radii: dict[str, Any] = {"heights": Nayak(4.0), "summits": RandomCurvature(4.0)}
    changes: list[dict[str, Any]] = [
        *({}, yielding, {**yielding, "unload_from": 0.0}, {**yielding, "sampler": "tail"}),
        *({"sampler": "direct"}, {"count": "poisson"}, {"keep": "statistics"}),
        *({"sampler": "aggregate", "n_asperities": 10**6}, {**radii, "sampler": "tail"}, radii),
    ]
    return [scene.replace(**each) for each in changes]


def _draws(scene: "Scene") -> None:
    """Draw moments of every length, without physics."""
    import numpy as np

    from mcgw.sampling.block import Layout
    from mcgw.sampling.cells import mesh_of
    from mcgw.sampling.counts import counts_of
    from mcgw.sampling.drawn_moments import OneByOne

    mesh = mesh_of(scene)
    lengths = (np.resize(kinds, mesh.size) for kinds in ([10, 12, 16], [0, 0, 0, 4, 6, 11]))
    OneByOne().moments(1, 0, counts_of(scene, mesh, 0, 20), Layout(*lengths))


def _maps(scene: "Scene") -> None:
    import numpy as np

    from mcgw.maps.envelope import envelope, hidden_summits
    from mcgw.maps.fitting import fit
    from mcgw.maps.synthetic import asperities_of
    from mcgw.maps.topography import Topography

    field = asperities_of(scene, 0)
    for periodic in (False, True):
        envelope(field, (16, 16), periodic=periodic)
        hidden_summits(field, periodic=periodic)
    heights = np.random.default_rng(1).normal(size=(64, 64)) * 1e-6
    fit(Topography(heights, (1e-6, 1e-6)), cutoff="8 um")
