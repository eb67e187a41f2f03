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
from typing import Any

from mcgw.machine.door import homes_of_names
from mcgw.machine.terminal import drawers

# Threads that wait for others sleep. By default they spin, and a loop of microseconds takes a hundred
# times as long on a machine that has anything else to do. Read once, when the loops are loaded.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

_HOME = homes_of_names(__file__)


def _draw(result: Any, ax: Any, **options: Any) -> Any:
    """Draw what ``.plot()`` of a result shows; figures are imported on the first call."""
    from mcgw.figures.plotting import draw

    return draw(result, ax, **options)


drawers.append(_draw)


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
