# Public names and where they come from; `mcgw/__init__.py` imports each on first use.

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
from mcgw.jobs.blocks import merge as merge
from mcgw.jobs.running import run as run
from mcgw.jobs.sweeping import sweep as sweep
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

__version__: str
