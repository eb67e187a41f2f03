"""Monte-Carlo simulator of rough contacts: Greenwood-Williamson surfaces with graded elasticity.

>>> import mcgw
>>> scene = mcgw.scene_from('''
... [surface]
... sigma = 1.37e-6
... radius = 13e-6
... eta = 3.0e8
... nominal_area = 1e-4
... E_star = 78.6e9
... [contact]
... separations = [0.0, 2.0]
... [ensemble]
... n_surfaces = 50
... seed = 1
... ''')
>>> ensemble = mcgw.simulate(scene)
>>> ensemble.load.shape
(50, 2)
"""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.ensemble.simulation import simulate
    from mcgw.sampling.asperities import heights
    from mcgw.scene.scene import Scene, SceneError
    from mcgw.scene.scene_file import load_scene, scene_from, scene_text
    from mcgw.scene.surface import Surface
    from mcgw.store.ensembles import open_ensemble

__all__ = [
    "Ensemble",
    "Scene",
    "SceneError",
    "Surface",
    "heights",
    "load_scene",
    "open_ensemble",
    "scene_from",
    "scene_text",
    "simulate",
]

# Threads that wait for others sleep. By default they spin, and a loop of microseconds takes a hundred
# times as long on a machine that has anything else to do. Read once, when the loops are loaded.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

# Imported when asked for: compiling and file formats cost a second that `mcgw --help` need not wait.
_HOME = {
    "Ensemble": "ensemble.ensemble",
    "Scene": "scene.scene",
    "SceneError": "scene.scene",
    "Surface": "scene.surface",
    "heights": "sampling.asperities",
    "load_scene": "scene.scene_file",
    "open_ensemble": "store.ensembles",
    "scene_from": "scene.scene_file",
    "scene_text": "scene.scene_file",
    "simulate": "ensemble.simulation",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'mcgw' has no attribute {name!r}")
    return getattr(import_module(f"mcgw.{_HOME[name]}"), name)
