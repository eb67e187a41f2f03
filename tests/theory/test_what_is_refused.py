"""What the theory refuses: each in one line that names what is wrong, and the value."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.laws_by_hand import SURFACE, HalfSpace, kogut_etsion
from oracles.scenes import scene_by

import analytic
from analytic import (
    ChangEtsionBogy,
    Coated,
    Custom,
    Exponential,
    JacksonGreen,
    JohnsonKendallRoberts,
    KogutEtsion,
    Model,
    PiecewiseSeries,
    PowerLawGraded,
    RandomCurvature,
    Table,
    ZhaoMaiettaChang,
)
from analytic.laws import CustomLaw

ONE = np.array(1.0)
HERTZ = Model(SURFACE)
OWN = Model(SURFACE, law=kogut_etsion(0.05))
BACK = Model(SURFACE, law=KogutEtsion(critical=0.05), unload_from=0.5)
STICKS = Model(SURFACE, law=JohnsonKendallRoberts(pull_off=0.3), unload_from=0.5)


def cube(u):
    return u**3


def bent(u):
    """A kink inside the second piece."""
    return u**2 * (2 + np.sqrt((u - 2) ** 2))


def noisy(s):
    return 1 + 1e-9 * np.modf(np.sin(1e9 * s) * 1e5)[0]


def scene(**asked):
    return scene_by(SURFACE, separations=[0, 1], **asked)


REFUSED = [
    # surfaces and bodies
    ("sigma = 0", lambda: replace(SURFACE, sigma=0)),
    ("nominal_area = nan", lambda: replace(SURFACE, nominal_area=math.nan)),
    ("give two of them, not 1", lambda: analytic.composite_modulus([analytic.Body(1e9)])),
    ("both are rigid", lambda: analytic.composite_modulus([analytic.Body(math.inf)] * 2)),
    ("count = 'random'", lambda: Model(SURFACE, count="random")),
    ("heights = Nayak(alpha=5.0)", lambda: Model(SURFACE, curvature=RandomCurvature(5.0))),
    ("two or more finite numbers", lambda: analytic.HeightTable.of([0.0, math.nan, 1.0])),
    # gradings
    ("gamma = inf", lambda: Exponential(math.inf)),
    ("not finite at s = 1", lambda: analytic.fn(1.5, 0.0, Custom(lambda s: np.where(s > 1, np.nan, 1.0)))),
    ("gave shape (3,)", lambda: analytic.fn(1.5, 0.0, Custom(lambda _: np.ones(3)))),
    ("not 1 and 1", lambda: Table((0,), (1,))),
    ("not 2 and 3", lambda: Table((0, 1), (1, 2, 3))),
    ("must be finite", lambda: Table((0, 1), (1, math.inf))),
    ("must increase", lambda: Table((0, 0), (1, 2))),
    ("not resolved by 4096 pieces", lambda: analytic.resolved_breaks(Custom(noisy), 0, 4)),
    ("edges", lambda: PiecewiseSeries([0.0, 0.0], [[1.0]])),
    ("give 1 lists", lambda: PiecewiseSeries([0.0, 1.0], [[1.0], [1.0]])),
    ("coefficients", lambda: PiecewiseSeries([0.0, 1.0], [[math.nan]])),
    ("kinks", lambda: PiecewiseSeries([0.0, 1.0], [[1.0]], kinks=[1.0])),
    # quantities and separations
    ("torque", lambda: analytic.mean(SURFACE, "torque", 0.0)),
    ("load_slope, conductance_si, yielded", lambda: OWN.mean("force", 0.0)),
    ("volume", lambda: analytic.mean_modulus(0.0, Exponential(2.0), weight="volume")),
    ("yielded_unloading", lambda: BACK.mean("yielded_unloading", 0.6)),
    ("h: every separation must be finite", lambda: OWN.mean("load", math.nan)),
    ("h: every separation must be finite", lambda: analytic.fn(1.5, [0.0, math.inf])),
    ("load = 0.0", lambda: HERTZ.separation_at("load", 0.0)),
    ("load = nan", lambda: HERTZ.separation_at("load", math.nan)),
    ("load = [1.0, -1.0]", lambda: OWN.separation_at("load", [1.0, -1.0])),
    ("contacts: not reached for h from -40 to 37", lambda: HERTZ.separation_at("contacts", 2000.0)),
    ("load: not reached", lambda: HERTZ.separation_at("load", 1e-320)),
    ("load_unloading: not reached for h from 0.5 to", lambda: BACK.separation_at("load_unloading", 1e9)),
    (
        "load: not reached",
        lambda: replace(HERTZ, grading=Custom(lambda s: -np.ones_like(s))).separation_at("load", 1.0),
    ),
    ("load_slope", lambda: OWN.slope("load_slope", 0.0)),
    ("'area_unloading': its slope is not known", lambda: BACK.slope("area_unloading", 0.6)),
    ("load_slope_unloading", lambda: BACK.slope("load_slope_unloading", 0.6)),
    ("has no variance", lambda: STICKS.slope("load_unloading", 0.8)),
    ("conductance_si': give a film", lambda: BACK.mean("conductance_si", 1.0)),
    ("give unload_from", lambda: replace(BACK, unload_from=None).mean("load_unloading", 0.5)),
    ("law = 'custom': no unloading", lambda: OWN.mean("load_unloading", 0.5)),
    (
        "law = 'chang-etsion-bogy': no unloading",
        lambda: replace(BACK, law=ChangEtsionBogy(critical=0.05)),
    ),
    ("zhao-maietta-chang", lambda: ZhaoMaiettaChang(critical=0.1).unloading(0.0)),
    ("jackson-green", lambda: JacksonGreen(yield_strength=1e9).unloading(0.0)),
    ("grading: E*(s)/E* = -", lambda: replace(OWN, grading=Exponential(2.0)).mean("load", -1.0)),
    ("adhesion", lambda: STICKS.separation_law(1e-3)),
    ("'stiffness' has no variance", lambda: scene(law=JohnsonKendallRoberts(pull_off=0.1), unload_from=0.0)),
    ('grading.negative = "allow"', lambda: scene(law=JohnsonKendallRoberts(pull_off=0.1), negative="allow")),
    ("your own law is mcgw", lambda: scene(law=lambda penetration: penetration**1.5)),
    ("contact.unload_from = 0: law = 'custom'", lambda: scene(law=OWN.law, unload_from=0.0)),
    # constants of laws
    ("hardness = None, critical = None", lambda: KogutEtsion()),
    ("critical = 0.1: give one", lambda: KogutEtsion(hardness=1e9, critical=0.1)),
    ("hardness = -1.0", lambda: ZhaoMaiettaChang(hardness=-1.0)),
    ("critical = 0.0", lambda: ChangEtsionBogy(critical=0.0)),
    ("poisson = 0.7", lambda: ChangEtsionBogy(critical=0.1, poisson=0.7)),
    ("bridge = 'linear'", lambda: KogutEtsion(critical=0.1, bridge="linear")),
    ("yield_strength = None, yield_strain = None", lambda: JacksonGreen()),
    ("critical = None", lambda: JacksonGreen(yield_strain=0.004)),
    ("both of the other two", lambda: JacksonGreen(yield_strength=1e9, yield_strain=0.01, critical=1.0)),
    ("yield_strength = nan", lambda: JacksonGreen(yield_strength=np.nan)),
    ("hardness=1000000000.0", lambda: KogutEtsion(hardness=1e9).limits(ONE)),
    ("strength=1000000000.0", lambda: JacksonGreen(yield_strength=1e9).limits(ONE)),
    ("c0 = None, reduced_c0 = None", lambda: PowerLawGraded(0.5)),
    ("c0 = 0.0", lambda: PowerLawGraded(0.5, 0.0)),
    ("poisson = 0.6", lambda: PowerLawGraded(0.5, 1e-6, 0.6)),
    ("c0=1e-06", lambda: PowerLawGraded(0.5, 1e-6).load(0, ONE, ONE)),
    ("thickness = None, reduced_thickness = None", lambda: Coated(ratio=2.0)),
    ("ratio = 0.0", lambda: Coated(ratio=0.0, thickness=1e-6)),
    ("thickness=1e-06", lambda: Coated(ratio=2.0, thickness=1e-6).load(0, ONE, ONE)),
    ("conductivities = (1.0, -1.0)", lambda: analytic.Film(conductivities=(1.0, -1.0))),
    ("resistivity = 0.0", lambda: analytic.Film(0.0, film_resistance=1.0)),
    ("work = None, pull_off = None", lambda: JohnsonKendallRoberts()),
    ("pull_off = 1.0: give one", lambda: JohnsonKendallRoberts(work=1.0, pull_off=1.0)),
    ("work = -1.0", lambda: JohnsonKendallRoberts(work=-1.0)),
    ("pull_off = inf", lambda: JohnsonKendallRoberts(pull_off=np.inf)),
    ("hardness = -1.0", lambda: analytic.summit_plasticity_index(SURFACE, -1.0)),
    ("poisson = 0.7", lambda: analytic.yielding_share(HERTZ, 0.0, 1e9, 0.7)),
    # laws of one's own
    ("load: give 2 formulas", lambda: CustomLaw((cube,), (cube,), (1.0,), 0.1)),
    ("area: give 2 formulas", lambda: CustomLaw((cube,) * 2, (cube,), (1.0,), 0.1)),
    ("limits = [2.0, 1.0]", lambda: CustomLaw((cube,) * 3, (cube,) * 3, (2.0, 1.0), 0.1)),
    ("critical = 0.0", lambda: CustomLaw((cube,), (cube,), (), 0.0)),
    ("load[0]", lambda: CustomLaw((lambda u: u**2.5,), (cube,), (), 0.1)),
    ("area[0]", lambda: CustomLaw((cube,), (lambda u: np.interp(u, [0, 1], [0, 1]),), (), 0.1)),
    ("load[1]", lambda: CustomLaw((cube, lambda u: np.log(1 - u)), (cube,) * 2, (1.0,), 0.1)),
    ("x = 2 and 50: give the", lambda: CustomLaw((cube, bent), (cube,) * 2, (2,), 0.1).as_data(5.0)),
    ("write u**3", lambda: CustomLaw((lambda u: (u * u) ** 1.5,), (cube,), (), 0.05).as_data(5.0)),
]


@pytest.mark.parametrize(("words", "ask"), REFUSED)
def test_what_is_refused_is_named_in_one_line(words, ask):
    with pytest.raises((ValueError, KeyError)) as caught:
        ask()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_negative_modulus_is_refused_only_where_asperities_yield():
    elastic = Model(SURFACE, law=HalfSpace(0.5), grading=Exponential(2.0))
    assert np.isfinite(elastic.mean("load", -1.0))
    assert np.isfinite(replace(OWN, grading=Exponential(2.0)).mean("load", 0.0))
