"""Monte-Carlo simulator of rough contacts: Greenwood-Williamson surfaces with graded elasticity.

Describe a surface and a simulation:

=======================  =========================================================================
`Surface`                sigma, R, eta, A_n, E*, as numbers (SI) or texts with units
`SpectralSurface`        the same by the moments m0, m2, m4 of an isotropic Gaussian surface
`surface_from`           the same by numbers of ISO 25178 or of profiles: Sq, Sdq, Spc, ...
`combine`                two rough bodies as one surface: their moments add
`Body`                   one of two bodies; `composite_modulus`: E* of both
`Scene`                  a surface, separations d/sigma, grading, heights, number of surfaces, seed
`Contact`, `Sampling`    its parts: law and quantities of the contacts; how surfaces are drawn;
                         `Joint`: what conducts; `Graded`: a grading that may be negative
`load_scene`             a scene from its TOML file; `scene_from`, `scene_text`: from and to text
=======================  =========================================================================

Gradings E*(s)/E*, and height laws, of s = z/sigma:

=======================  =========================================================================
`Homogeneous`            the same modulus at every height; `Exponential`: Eq. (4) of the paper
`Table`                  measured moduli; `Custom`: any function of s (a plain lambda will do too)
`Gaussian`               the default; `ExponentialHeights`, `Weibull`, `Nayak`
`HeightTable`            measured heights, resampled; `MeasuredHeights`: as they are;
                         `MeasuredRadii`: with the radius of each summit
`ScipyHeights`           any distribution of scipy.stats (a plain frozen one will do too)
`Nayak`                  summits of a Gaussian surface; `RandomCurvature`: each with its own radius
=======================  =========================================================================

Contact laws of an asperity, and other properties of contacts:

=======================  =========================================================================
`KogutEtsion`            asperities that yield, from hardness or critical penetration; also
                         `ChangEtsionBogy`, `ZhaoMaiettaChang` and `JacksonGreen` (yield strength)
`Hertz`                  the default; `PowerLawGraded`: graded in depth; `Coated`; `CustomLaw`:
                         your own formulas
`JohnsonKendallRoberts`  contacts that stick; also `DerjaguinMullerToporov`
`Joint`, `Layer`         conductivities of the bodies, a film or layer, gas: conductance in S or W/K
`Interaction`            asperity interaction: nominal and effective separations
=======================  =========================================================================

Draw surfaces:

=======================  =========================================================================
`simulate`               in memory
`run`                    into a file, which it resumes or extends; by processes or jobs; `merge`
`open_ensemble`          from a file; `save`: an ensemble in memory to a file
`Ensemble`               load, area, ... of every surface; means, errors, intervals, tables
`heights`, `radii`       the summits of one surface
=======================  =========================================================================

Use the results:

=======================  =========================================================================
`compare`                an ensemble or a sweep against theory; the theory itself: ``scene.theory``
``scene.validity()``     measured error of the model against elasticity
`paired_ratio`           ratio of two means over the same surfaces
`solve`                  the separation at a load, pressure or area
`export`                 tables for finite-element programs, or as JSON
`sweep`, `open_sweep`    many scenes on the same surfaces: means, differences, slopes
`converge`, `tradeoff`   the statistical convergence test; error against time on this machine
`elastic`                means of elastic surfaces, with errors, from few boundary-element solves
`fit`, `fitted_scene`    a surface from a measured height map or profiles, and its scene
=======================  =========================================================================

Errors are a `SceneError` (a wrong argument or scene: one line for each mistake), a `StoreError`
(a file) or a `RunError` (a run that could not finish).

>>> import mcgw
>>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
>>> scene = mcgw.Scene(surface, separations=[0.0, 2.0], grading=mcgw.Exponential(2.0), seed=1)
>>> ensemble = mcgw.simulate(scene, n_surfaces=50)
>>> ensemble["load"].shape
(50, 2)
"""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

from mcgw.machine.terminal import bind_drawing

if TYPE_CHECKING:
    from analytic import (
        ChangEtsionBogy as ChangEtsionBogy,
        Coated as Coated,
        Custom as Custom,
        CustomLaw as CustomLaw,
        DerjaguinMullerToporov as DerjaguinMullerToporov,
        Exponential as Exponential,
        ExponentialHeights as ExponentialHeights,
        Gaussian as Gaussian,
        HeightTable as HeightTable,
        Hertz as Hertz,
        Homogeneous as Homogeneous,
        Interaction as Interaction,
        JacksonGreen as JacksonGreen,
        JohnsonKendallRoberts as JohnsonKendallRoberts,
        KogutEtsion as KogutEtsion,
        Layer as Layer,
        MeasuredHeights as MeasuredHeights,
        MeasuredRadii as MeasuredRadii,
        Nayak as Nayak,
        PowerLawGraded as PowerLawGraded,
        RandomCurvature as RandomCurvature,
        ScipyHeights as ScipyHeights,
        Table as Table,
        Weibull as Weibull,
        ZhaoMaiettaChang as ZhaoMaiettaChang,
        composite_modulus as composite_modulus,
    )
    from mcgw.elasticity.elastic import elastic as elastic
    from mcgw.ensemble.ensemble import Ensemble as Ensemble
    from mcgw.ensemble.paired import paired_ratio as paired_ratio
    from mcgw.ensemble.simulation import simulate as simulate
    from mcgw.ensemble.solution import solve as solve
    from mcgw.errors import RunError as RunError, StoreError as StoreError
    from mcgw.exports.writing import export as export
    from mcgw.jobs.making import merge as merge
    from mcgw.jobs.running import run as run, sweep as sweep
    from mcgw.maps.fitted_scene import fitted_scene as fitted_scene
    from mcgw.maps.fitting import fit as fit
    from mcgw.maps.iso import surface_from as surface_from
    from mcgw.maps.two_bodies import combine as combine
    from mcgw.sampling.asperities import heights as heights, radii as radii
    from mcgw.scene.contact import Contact as Contact, Joint as Joint
    from mcgw.scene.ensemble import Sampling as Sampling
    from mcgw.scene.laws import Graded as Graded
    from mcgw.scene.scene import Scene as Scene
    from mcgw.scene.scene_file import (
        load_scene as load_scene,
        scene_from as scene_from,
        scene_text as scene_text,
    )
    from mcgw.scene.section import SceneError as SceneError
    from mcgw.scene.surface import Body as Body, SpectralSurface as SpectralSurface, Surface as Surface
    from mcgw.statistics.comparison import compare as compare
    from mcgw.statistics.convergence import converge as converge
    from mcgw.statistics.tradeoff import tradeoff as tradeoff
    from mcgw.store.ensembles import open_ensemble as open_ensemble, open_sweep as open_sweep
    from mcgw.store.place import save as save

# Threads that wait for others sleep. By default they spin, and a loop of microseconds takes a hundred
# times as long on a machine that has anything else to do. Read once, when the loops are loaded.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

# Where names come from. They are imported on first use: compiling and file formats cost a second, for which
# `mcgw --help` should not wait.
_HOMES = {
    "analytic": "ChangEtsionBogy Coated Custom CustomLaw DerjaguinMullerToporov Exponential "
    "ExponentialHeights Gaussian HeightTable Hertz Homogeneous Interaction JacksonGreen "
    "JohnsonKendallRoberts KogutEtsion Layer MeasuredHeights MeasuredRadii Nayak PowerLawGraded "
    "RandomCurvature ScipyHeights Table Weibull ZhaoMaiettaChang composite_modulus",
    "mcgw.elasticity.elastic": "elastic",
    "mcgw.ensemble.ensemble": "Ensemble",
    "mcgw.ensemble.paired": "paired_ratio",
    "mcgw.ensemble.simulation": "simulate",
    "mcgw.ensemble.solution": "solve",
    "mcgw.errors": "RunError StoreError",
    "mcgw.exports.writing": "export",
    "mcgw.jobs.making": "merge",
    "mcgw.jobs.running": "run sweep",
    "mcgw.maps.fitted_scene": "fitted_scene",
    "mcgw.maps.fitting": "fit",
    "mcgw.maps.iso": "surface_from",
    "mcgw.maps.two_bodies": "combine",
    "mcgw.sampling.asperities": "heights radii",
    "mcgw.scene.scene": "Scene",
    "mcgw.scene.scene_file": "load_scene scene_from scene_text",
    "mcgw.scene.contact": "Contact Joint",
    "mcgw.scene.ensemble": "Sampling",
    "mcgw.scene.laws": "Graded",
    "mcgw.scene.section": "SceneError",
    "mcgw.scene.surface": "Body SpectralSurface Surface",
    "mcgw.statistics.comparison": "compare",
    "mcgw.statistics.convergence": "converge",
    "mcgw.statistics.tradeoff": "tradeoff",
    "mcgw.store.ensembles": "open_ensemble open_sweep",
    "mcgw.store.place": "save",
}
_HOME = {name: module for module, names in _HOMES.items() for name in names.split()}


def _draw(result: Any, ax: Any, **options: Any) -> Any:
    """Draw what ``.plot()`` of a result shows; figures are imported on the first call."""
    from mcgw.figures.plotting import draw

    return draw(result, ax, **options)


bind_drawing(_draw)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("mcgw")
    if name not in _HOME:
        raise AttributeError(f"module 'mcgw' has no attribute {name!r}")
    globals()[name] = found = getattr(import_module(_HOME[name]), name)
    return found


def __dir__() -> list[str]:
    return sorted(_HOME)  # and no __all__, by which help(mcgw) would print the help of every name
