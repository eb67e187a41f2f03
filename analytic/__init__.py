"""Contact mechanics of functionally graded rough surfaces: the theory, exactly evaluated.

The surface of Greenwood and Williamson (Gaussian summit heights, one radius) whose composite modulus
E*(s) depends on the reduced summit height s = z/sigma. All separations are h = d/sigma, from the mean
of the summit heights. The equations are those of "Contact mechanics of functionally graded rough
surfaces", corrected; each docstring says what is misprinted. `analytic.Model` has everything that belongs
to one surface in one place; the functions that take a surface are short names for it.

========  ===================================  ================================================
Equation  Function                             What it is
========  ===================================  ================================================
Eq. (1)   `analytic.area`, `analytic.load`     area and load of the homogeneous surface
Eq. (2)   `analytic.fn`                        F_n(h)
Eq. (3)   `analytic.load`                      load for any grading E*(s)
Eq. (4)   `analytic.Exponential`               exponential grading
Eq. (5)   `analytic.load`                      load for the exponential grading
Eq. (6)   `analytic.load`                      the same by F*_{3/2}
Eq. (7)   `analytic.fn`                        F*_n(h)
Eq. (8)   `analytic.fn_paper`                  F*_n in the variable t = exp(-s) (misprinted)
Eq. (9)   `analytic.fn_paper`                  its Gauss-Legendre sum (misprinted)
Eq. (10)  `analytic.area_per_load`             A/P of the graded surface
Eq. (11)  `analytic.area_per_load`             A/P of the homogeneous surface
Eq. (12)  `analytic.area_per_load_ratio`       their ratio
Eq. (13)  `analytic.plasticity_index`          plasticity index
Eq. (14)  `analytic.barber_conductance`        "conductance" from the stiffness (misprinted)
Eq. (15)  `analytic.stiffness_ratio`           its ratio: that of the stiffnesses
========  ===================================  ================================================
"""

from analytic.correlation import cooper_mikic_yovanovich, mean_absolute_slope, mikic_elastic
from analytic.curvature import RandomCurvature
from analytic.equations import (
    area,
    area_per_load,
    area_per_load_ratio,
    barber_conductance,
    conductance,
    contacts,
    load,
    mean,
    mean_modulus,
    plasticity_index,
    stiffness,
    stiffness_ratio,
    summit_plasticity_index,
    yielding_share,
)
from analytic.gradings import Clipped, Custom, Exponential, Grading, Homogeneous, Table
from analytic.height_rule import Fluctuations, HeightRule
from analytic.heights import ExponentialHeights, Gaussian, HeightLaw, Weibull
from analytic.integrals import fn, fn_paper, ratio_at_equal_load
from analytic.interaction import Interaction
from analytic.joint import Joint
from analytic.laws.adhesion import DerjaguinMullerToporov, JohnsonKendallRoberts
from analytic.laws.custom import CustomLaw
from analytic.laws.elastic import Coated, PowerLawGraded
from analytic.laws.elastic_plastic_laws import ChangEtsionBogy, JacksonGreen, KogutEtsion, ZhaoMaiettaChang
from analytic.laws.film import Film, Layer
from analytic.laws.law import ContactLaw, Hertz
from analytic.measured_summits import HeightTable, MeasuredHeights, MeasuredRadii
from analytic.model import Cumulants, Model
from analytic.nayak import Nayak
from analytic.piecewise import PiecewiseSeries
from analytic.quadrature import extent
from analytic.quantities import (
    ALL_QUANTITIES,
    JOINT,
    LAW_QUANTITIES,
    PER_AREA,
    QUANTITIES,
    RESISTANCES,
    SEPARATIONS,
    UNLOADING,
    Quantity,
    quantity_of,
)
from analytic.resolution import bends, first_negative, is_data, name_of, resolved, resolved_breaks
from analytic.scipy_heights import ScipyHeights
from analytic.surface import Body, SpectralMoments, Surface, composite_modulus

__all__ = [
    "ALL_QUANTITIES", "JOINT", "LAW_QUANTITIES", "PER_AREA", "QUANTITIES", "RESISTANCES", "SEPARATIONS",
    "UNLOADING",
    "Body", "ChangEtsionBogy", "Clipped", "Coated", "ContactLaw", "Cumulants", "Custom", "CustomLaw",
    "DerjaguinMullerToporov", "Exponential", "ExponentialHeights", "Film", "Fluctuations", "Gaussian",
    "Grading", "HeightLaw", "HeightRule", "HeightTable", "Hertz", "Homogeneous", "Interaction",
    "JacksonGreen", "JohnsonKendallRoberts", "Joint", "KogutEtsion", "Layer", "MeasuredHeights",
    "MeasuredRadii", "Model", "Nayak", "PiecewiseSeries", "PowerLawGraded", "Quantity", "RandomCurvature",
    "ScipyHeights", "SpectralMoments", "Surface", "Table", "Weibull", "ZhaoMaiettaChang",
    "area", "area_per_load", "area_per_load_ratio", "barber_conductance", "bends", "composite_modulus",
    "conductance", "contacts", "cooper_mikic_yovanovich", "extent", "first_negative", "fn", "fn_paper",
    "is_data", "load", "mean", "mean_absolute_slope", "mean_modulus", "mikic_elastic", "name_of",
    "plasticity_index", "quantity_of", "ratio_at_equal_load", "resolved", "resolved_breaks", "stiffness",
    "stiffness_ratio", "summit_plasticity_index", "yielding_share",
]  # fmt: skip
