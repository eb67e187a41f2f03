"""Every key of a scene: a right value, the keys that go with it, what is looked at, and the number by hand.

Most rows look at one asperity: of three of known heights the highest alone touches, and is 0.5 sigma deep.
"""

from math import exp, log2, pi, sqrt

import numpy as np
import oracles.laws_of_one_depth as by_hand
from scipy.integrate import quad
from scipy.stats import gamma as gamma_law, norm, weibull_min

import analytic.joint
import mcgw

TOP = sqrt(1.5)  # of the heights -TOP, 0 and TOP, whose mean is 0 and variance 1
FILES = {
    "g.csv": "s,ratio\n0,1\n1,2\n",
    "h.csv": "0\n1\n3\n",
    "s.csv": "height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n",
}
FILES |= {"moduli.csv": FILES["g.csv"], "heights.csv": FILES["h.csv"], "summits.csv": FILES["s.csv"]}
BASE = {
    "": {},
    "surface": {"sigma": 1e-6, "radius": 1e-5, "eta": 1e9, "nominal_area": 1e-6, "E_star": 1e11},
    "grading": {},
    "heights": {"law": "'table'", "heights": [-TOP, 0.0, TOP], "resample": "false"},
    "summits": {},
    "contact": {"separations": [TOP - 0.5]},
    "contact.law": {},
    "interaction": {},
    "joint": {},
    "ensemble": {"n_asperities": 3, "n_surfaces": 1, "seed": 1, "sampler": "'direct'"},
    "fitted": {},
}
FREE = {"heights": None, "resample": None}  # of a list of heights
AUTO = {"ensemble": {"sampler": None}}
GAUSS = {"heights": None, "ensemble": {"n_asperities": None, "sampler": None, "n_surfaces": 4}}


def text(**tables):
    """The base with other keys; None takes a key or a whole table away."""
    found = ""
    for name, lines in BASE.items():
        given = tables.get(name or "top", {})
        lines = {} if given is None else lines | given
        found += f"[{name}]\n" if name and lines else ""
        found += "".join(f"{key} = {value}\n" for key, value in lines.items() if value is not None)
    return found


def simulated(quantity="load"):
    """The value on the first surface at the first separation."""
    return lambda s: float(mcgw.simulate(s).values(quantity).flat[0])


def theory(quantity, h=0.5):
    return lambda s: float(s.theory.mean(quantity, h))


def hertz(depth=0.5, E=1e11, R=1e-5, sigma=1e-6):
    return 4 / 3 * E * sqrt(R) * (depth * sigma) ** 1.5


F, UNIT = hertz(), hertz(1.0)  # load at this depth, and at unit depth
H = TOP - 0.5


def reduced(heights):
    """The highest of these heights, less their mean and over their standard deviation."""
    return float((max(heights) - np.mean(heights)) / np.std(heights))


def load_by(law, **constants):
    return UNIT * getattr(by_hand, law)(0.5, **constants)[0]


def hardness_yields_at(hardness, nu=0.3):
    """Critical depth over sigma: (pi K H/(2 E*))^2 R/sigma with K = 0.454 + 0.41 nu."""
    return (pi * (0.454 + 0.41 * nu) * hardness / 2e11) ** 2 * 10


# Of the heights of summits with alpha = 5, by quadrature of their density as Nayak (1971) has it: mean and
# deviation above the mean plane over sqrt(m0), and the share above the mean by half a deviation.
MEAN, STD, ABOVE = 1.009253008808064, 0.9058911903496998, 0.30730699867376116
SPECTRUM = {"sigma": None, "radius": None, "eta": None, "m0": 1e-12, "m2": 1e-3, "m4": 5e6}
SPECTRAL = {"surface": SPECTRUM, "heights": None, "ensemble": {"n_asperities": None, "sampler": None}}
LISTED = {"heights": None, "contact": {"separations": [reduced([0, 1, 3]) - 0.5]}}
SUMMITS = {"heights": [0.0, 1e-6, 3e-6], "radii": [1e-5, 2e-5, 3e-5], "resample": "false"}
SERIES = {"law": "'series'", "edges": [0.0, 5.0, 20.0], "coefficients": "[[1.0, 0.5], [1.5]]"}
KE = {"name": "'kogut-etsion'", "critical": 0.05}
JG = {"name": "'jackson-green'"}
GRADED = {"name": "'power-law-graded'", "k": 0.5}
COATED = {"name": "'coated'", "ratio": 3.0}
PIECE = (
    "[{{edges = [-1.0, 1.0], coefficients = [[1.0]]}}, {{edges = [0.0, 1.3862943611198906], "
    "coefficients = [[{}]]}}]"
)
CUSTOM = {"name": "'custom'", "critical": 0.05, "limits": [1.0], "load": PIECE.format("2.0, 0.5")}
CUSTOM |= {"area": PIECE.format("3.0")}
DEEP = sqrt(0.5 / 0.05)  # root of the depth over the critical one
# The variable of a piece from u = 1 to 4 is (u - 2)/(u + 2), stretched to -1..1.
LATER = 0.05**1.5 * DEEP**2 * (2.0 + 0.5 * (log2(DEEP) - 1))  # a series in log(u) between 1 and 4
SPOT = sqrt(1e-5 * 0.5e-6)


def changed(key, value, **tables):
    """Changes of a scene: one key, dotted, beside others."""
    table, _, name = key.rpartition(".")
    return {**tables, table or "top": {**tables.get(table or "top", {}), name: value}}


def jump(s):
    """Load just above the depth over that just below it."""
    load = mcgw.simulate(s.replace(separations=[H - 1e-11, H + 1e-11])).load[0]
    return float(load[0] / load[1])


def nominal(s):
    """Nominal separation of its first surface."""
    return float(mcgw.simulate(s)["nominal_separation"][0, 0])


def sunk(bulk, area, factor):
    """Separation of the bodies where the plane sinks by `factor` P/(bulk root of an area)."""
    return H - factor * hertz(TOP - H) / (bulk * sqrt(area)) / 1e-6


# Key, its value, other keys beside it, what is looked at, and what it must be.
CHANCE = 2 * sqrt(6 / 4000)
FITTED = {"m0": 1e-12, "m2": 1e-2, "m4": 1e9, "skewness": 0.0, "kurtosis": 3.0, "independent": 1e4,
          "agreement": 1.05, "lay": 1.1, "area": 1e-6}  # fmt: skip

JOINED = {"joint": {"conductivities": [150.0, 16.0], "gas": "'air'", "rms": 2e-6}}


def not_measured(words):
    """Whether nothing is stated against elasticity for this reason."""
    return lambda scene: words in scene.validity().unknown


ROWS = [
    ("title", "'Mine'", {}, lambda s: s.title, "Mine"),
    ("surface.sigma", "'2 um'", {}, simulated(), hertz(sigma=2e-6)),
    ("surface.radius", "'40 µm'", {}, simulated(), 2 * F),
    ("surface.E_star", "'300 GPa'", {}, simulated(), 3 * F),
    ("surface.bodies", "[{E = '70 GPa', nu = 0.33}, {E = 2e11}]", {"surface": {"E_star": None}}, simulated(),
     hertz(E=1 / ((1 - 0.33**2) / 7e10 + (1 - 0.3**2) / 2e11))),
    ("surface.uncertainty", "{E_star = '10 %'}", {}, lambda s: float(s.uncertainty.covariance[0, 0]), 0.01),
    ("surface.eta", "'2000/mm^2'", GAUSS, theory("contacts"), 2000 * norm.sf(0.5)),
    ("surface.nominal_area", "'3 mm²'", GAUSS, theory("contacts"), 3000 * norm.sf(0.5)),
    ("surface.m0", 2e-12, SPECTRAL, lambda s: s.surface.sigma, sqrt((1 - 0.8968 / 10) * 2e-12)),
    ("surface.m2", 0.5e-3, SPECTRAL, lambda s: s.n_asperities,
     round(1e-6 * 5e6 / (6 * sqrt(3) * pi * 0.5e-3))),
    ("surface.m4", 20e6, SPECTRAL, lambda s: s.surface.radius, 3 * sqrt(pi) / (8 * sqrt(20e6))),
    ("grading.law", "'exponential'", {"grading": {"gamma": 1.5}}, simulated(), F * (1.5 - 0.5 * exp(-TOP))),
    ("grading.gamma", 1.5, {}, simulated(), F * (1.5 - 0.5 * exp(-TOP))),
    ("grading.negative", "'clip'", {"grading": {"gamma": 2.0}, "contact": {"separations": [-TOP - 1]}},
     simulated(), UNIT * ((1 + TOP) ** 1.5 + (2 - exp(-TOP)) * (1 + 2 * TOP) ** 1.5)),
    ("grading.negative", "'allow'", {"grading": {"gamma": 2.0}, "contact": {"separations": [-TOP - 1]}},
     simulated(), UNIT * (2 - exp(TOP) + (1 + TOP) ** 1.5 + (2 - exp(-TOP)) * (1 + 2 * TOP) ** 1.5)),
    ("grading.s", [0.0, 2 * TOP], {"grading": {"law": "'table'", "ratio": [1.0, 3.0]}}, simulated(), 2 * F),
    ("grading.ratio", [1.0, 5.0], {"grading": {"law": "'table'", "s": [0.0, 2 * TOP]}}, simulated(), 3 * F),
    ("grading.file", "'g.csv'", {"grading": {"law": "'table'"}}, simulated(), 2 * F),
    ("grading.edges", [0.0, 4.0, 20.0], {"grading": SERIES}, simulated(), F * (1 + 0.5 * (TOP / 2 - 1))),
    ("grading.coefficients", "[[1.0, 0.0, 0.5], [1.5]]", {"grading": SERIES}, simulated(),
     F * (1 + 0.5 * (2 * (2 * TOP / 5 - 1) ** 2 - 1))),
    ("grading.kinks", [0.7],
     {**GAUSS, "grading": SERIES | {"edges": [0.0, 0.7, 5.0, 20.0], "coefficients": "[[1.0], [2.0], [2.0]]"}},
     theory("load"), 1000 * UNIT * (
         quad(lambda s: (s - 0.5) ** 1.5 * norm.pdf(s), 0.5, 0.7, epsabs=0, epsrel=1e-12)[0]
         + quad(lambda s: 2 * (s - 0.5) ** 1.5 * norm.pdf(s), 0.7, 12, epsabs=0, epsrel=1e-12)[0])),
    ("grading.name", "'ramp'", {"grading": SERIES}, lambda s: s.grading.name, "ramp"),
    ("grading.checked", "false", {"grading": SERIES | {"coefficients": "[[2e6], [2e6]]"}}, simulated(),
     2e6 * F),
    ("heights.law", "'weibull'", {"heights": FREE | {"shape": 3.0}, **AUTO},
     theory("contacts"), 3 * weibull_min.sf(weibull_min.mean(3) + 0.5 * weibull_min.std(3), 3)),
    ("heights.shape", 3.0, {"heights": {"law": "'weibull'", **FREE}, **AUTO},
     theory("contacts"), 3 * weibull_min.sf(weibull_min.mean(3) + 0.5 * weibull_min.std(3), 3)),
    ("heights.alpha", 5.0, {"heights": {"law": "'nayak'", **FREE}, **AUTO},
     theory("contacts"), 3 * ABOVE),
    ("heights.name", "'gamma'", {"heights": {"law": "'scipy'", "shapes": "{a = 4.0}", **FREE}, **AUTO},
     theory("contacts"), 3 * gamma_law.sf(5.0, 4)),
    ("heights.shapes", "{a = 9.0}", {"heights": {"law": "'scipy'", "name": "'gamma'", **FREE}, **AUTO},
     theory("contacts"), 3 * gamma_law.sf(10.5, 9)),
    ("heights.heights", [0.0, 1.0, 5.0], {}, simulated(), hertz(reduced([0, 1, 5]) - H)),
    ("heights.file", "'h.csv'", {"heights": {"heights": None}}, simulated(), hertz(reduced([0, 1, 3]) - H)),
    ("heights.resample", "false", {}, simulated("contacts"), 1),
    ("heights.s", [0.0, 1.0], {"heights": {**FREE, "share": [0.0, 1.0]}, **AUTO},
     theory("contacts"), 3 * (0.5 - 0.5 / sqrt(12))),
    ("heights.share", [0.0, 1.0], {"heights": {**FREE, "s": [0.0, 3.0]}, **AUTO},
     theory("contacts"), 3 * (0.5 - 0.5 / sqrt(12))),
    ("summits.curvature", "'mean'", {**SPECTRAL, "summits": {"curvature": None}}, theory("contacts"),
     round(1e-6 * 5e6 / (6 * sqrt(3) * pi * 1e-3)) * ABOVE),
    ("summits.largest_radius", "'1 mm'", SPECTRAL, lambda s: s.summits.largest,
     1e-3 / (3 * sqrt(pi) / (8 * sqrt(5e6)))),
    ("summits.file", "'s.csv'", {**LISTED, "summits": {"resample": "false"}}, simulated(), sqrt(3) * F),
    ("summits.heights", [0.0, 1e-6, 5e-6], {**LISTED, "summits": SUMMITS}, simulated(),
     sqrt(3) * hertz(reduced([0, 1, 5]) - reduced([0, 1, 3]) + 0.5)),
    ("summits.radii", [1e-5, 2e-5, 4e-5], {**LISTED, "summits": SUMMITS}, simulated(), 2 * F),
    ("summits.ratios", [1.0, 2.0, 9.0], {**LISTED, "summits": SUMMITS | {"radii": None}}, simulated(), 3 * F),
    ("summits.resample", "false", {**LISTED, "summits": SUMMITS}, simulated("contacts"), 1),
    ("contact.separations", [TOP - 1.0], {}, simulated(), UNIT),
    ("contact.datum", "'surface'", SPECTRAL, lambda s: s.separations[0], H - MEAN / STD),
    ("contact.quantities", "['conductance']", {}, simulated("conductance"), 4 * SPOT),
    ("contact.law.name", "'kogut-etsion'", {"contact.law": KE}, simulated(), load_by("kogut_etsion")),
    ("contact.law.critical", 0.1, {"contact.law": KE}, simulated(), load_by("kogut_etsion", critical=0.1)),
    ("contact.law.hardness", "'12 GPa'", {"contact.law": KE | {"critical": None}}, simulated(),
     load_by("kogut_etsion", critical=hardness_yields_at(12e9))),
    ("contact.law.poisson", 0.4, {"contact.law": KE | {"critical": None, "hardness": 12e9}}, simulated(),
     load_by("kogut_etsion", critical=hardness_yields_at(12e9, 0.4))),
    ("contact.law.bridge", "'hermite'", {"contact.law": KE | {"critical": 0.5 / 6}}, jump, 1.0),
    ("contact.law.yield_strength", "'400 MPa'", {"contact.law": JG}, simulated(),
     load_by("jackson_green", strain=0.004, ratio=10)),
    ("contact.law.yield_strain", 0.005, {"contact.law": JG | {"critical": 0.05}}, simulated(),
     load_by("jackson_green", strain=0.005, ratio=0.05 / by_hand.yields_at(0.005, ratio=1))),
    ("contact.law.k", 0.3, {"contact.law": GRADED | {"reduced_c0": 1.0}}, simulated(),
     load_by("power_law_graded", k=0.3, depth=1.0)),
    ("contact.law.c0", "'10 um'", {"contact.law": GRADED}, simulated(),
     load_by("power_law_graded", depth=sqrt(10))),
    ("contact.law.reduced_c0", 2.0, {"contact.law": GRADED}, simulated(),
     load_by("power_law_graded", depth=2.0)),
    ("contact.law.thickness", "'1 um'", {"contact.law": COATED}, simulated(),
     load_by("coated", thickness=1 / sqrt(10))),
    ("contact.law.reduced_thickness", 0.5, {"contact.law": COATED}, simulated(),
     load_by("coated", thickness=0.5)),
    ("contact.law.ratio", 2.0, {"contact.law": COATED | {"reduced_thickness": 0.5}}, simulated(),
     load_by("coated", ratio=2.0)),
    ("contact.law.limits", [4.0], {"contact.law": CUSTOM}, simulated(), UNIT * LATER),
    ("contact.law.load", PIECE.format("2.0, 0.5"), {"contact.law": CUSTOM}, simulated(), UNIT * LATER),
    ("contact.law.area", PIECE.format("3.0"), {"contact.law": CUSTOM}, simulated("area"), 3 * pi * SPOT**2),
    ("contact.law.checked", "false", {"contact.law": CUSTOM | {"load": PIECE.format("2e7, 0.5e7")}},
     simulated(), UNIT * LATER * 1e7),
    ("contact.law.work", "'0.05 J/m^2'", {"contact.law": {"name": "'derjaguin-muller-toporov'"}}, simulated(),
     F - 2 * pi * 1e-5 * 0.05),
    ("contact.law.pull_off", 0.1, {"contact.law": {"name": "'johnson-kendall-roberts'"}}, simulated(),
     load_by("johnson_kendall_roberts", stretch=0.1)),
    ("contact.unload_from", H - 0.5, {"contact.law": KE}, simulated("load_unloading"),
     UNIT * by_hand.unloaded_kogut_etsion(0.5, 1.0, 0.05)),
    ("joint.resistivity", 1e-7, {}, simulated("conductance_si"), 4 * SPOT / 1e-7),
    ("joint.conductivities", [150.0, 16.0], {}, simulated("conductance_si"), 4 * SPOT / (1 / 150 + 1 / 16)),
    ("joint.film_resistance", 1e-12, {"joint": {"resistivity": 1e-7}}, simulated("conductance_si"),
     1 / (1e-7 / (4 * SPOT) + 1e-12 / (pi * SPOT**2))),
    ("joint.layer", "{thickness = 1e9, conductivity = 7.0}",
     changed("joint.conductivities", [150.0, 16.0]),
     simulated("conductance_si"), 4 * SPOT / (1 / 7 + 1 / 16)),
    ("ensemble.n_surfaces", 7, GAUSS, lambda s: mcgw.simulate(s).load.shape, (7, 1)),
    ("ensemble.n_asperities", 50, changed("contact.separations", -30.0, **GAUSS), simulated("contacts"), 50),
    ("ensemble.count", "'poisson'", GAUSS, lambda s: s.theory.std("contacts", -30.0), sqrt(1000)),
    ("ensemble.seed", 12, GAUSS, lambda s: mcgw.simulate(s).scene.seed, 12),
    ("ensemble.sampler", "'tail'", GAUSS, lambda s: mcgw.simulate(s).sampler, "tail"),
    ("ensemble.keep", "'statistics'", GAUSS, lambda s: mcgw.simulate(s).std("load").shape, (1,)),
    ("ensemble.rel_err", "'2 %'", changed("ensemble.n_surfaces", None, **GAUSS), lambda s: s.rel_err, 0.02),
    ("ensemble.max_seconds", "'2 min'", {}, lambda s: s.max_seconds, 120.0),
    ("ensemble.accuracy", "'0.1 %'", GAUSS, lambda s: s.accuracy, 0.001),
    ("interaction.reference", "'body'", {}, nominal, sunk(1e11, 1e-6, 0.9464020088186771)),
    ("interaction.reference", "'mean-plane'", {}, nominal, sunk(1e11, 3e-6, -3.900264920001956 / pi)),
    ("interaction.bulk_modulus", 1e9, {"interaction": {"reference": "'body'"}}, nominal,
     sunk(1e9, 1e-6, 0.9464020088186771)),
    ("joint.gas", "{conductivity = 0.15, jump = 1e-6}", JOINED, lambda s: s.gas.held.conductivity, 0.15),
    ("joint.rms", "'3 um'", JOINED, lambda s: s.filled.rms, 3e-6),
    ("joint.temperature", 600.0, JOINED,
     lambda s: s.gas.held.conductivity, 2.64638e-3 * 600**1.5 / (600 + 245.4 * 10 ** (-12 / 600))),
    ("joint.gas_pressure", "'0.5 bar'", JOINED,
     lambda s: s.gas.held.jump / analytic.Joint("air").held.jump, 101325 / 5e4),
    ("fitted.m0", 2e-12, {"fitted": FITTED}, lambda s: s.fitted.moments.alpha, 20),
    ("fitted.m2", 2e-2, {"fitted": FITTED}, lambda s: s.fitted.moments.alpha, 2.5),
    ("fitted.m4", 4e9, {"fitted": FITTED}, lambda s: s.fitted.moments.alpha, 40),
    ("fitted.skewness", 0.5, {**GAUSS, "fitted": FITTED}, not_measured("skewness 0.50"), True),
    ("fitted.kurtosis", 4.0, {**GAUSS, "fitted": FITTED}, not_measured("kurtosis 4.00"), True),
    # By chance 4000 independent heights have twice sqrt(6/4000) = 0.077; no chance excuses more than 0.15.
    ("fitted.independent", 4000.0, {**GAUSS, "fitted": FITTED | {"skewness": CHANCE - 0.001}},
     not_measured("skewness"), False),
    ("fitted.independent", 4000.0, {**GAUSS, "fitted": FITTED | {"skewness": CHANCE + 0.001}},
     not_measured("skewness"), True),
    ("fitted.independent", 90.0, {**GAUSS, "fitted": FITTED | {"skewness": 0.151}},
     not_measured("skewness"), True),
    ("fitted.agreement", 1.5, {**GAUSS, "fitted": FITTED}, not_measured("differ by a factor of 1.5"), True),
    ("fitted.lay", 3.0, {**GAUSS, "fitted": FITTED}, not_measured("slopes 3 : 1"), True),
    ("fitted.area", "'4 mm^2'", {"fitted": FITTED}, lambda s: s.fitted.area, 4e-6),
    ("fitted.cautions", "['lay: 2 : 1']", {"fitted": FITTED}, lambda s: s.fitted.cautions, ("lay: 2 : 1",)),
]  # fmt: skip
OTHER_FORMS = {("ensemble", "rel_err"): ["{load = 0.01, area = '2 %'}", "{load = [0.01]}", "{load = [inf]}"]}
BESIDE = {}
for _key, _value, _beside, *_ in ROWS:
    BESIDE.setdefault(tuple(_key.rpartition(".")[::2]), (_value, _beside))


def keys():
    """All keys of all tables."""
    return list(BESIDE)


def good(table, key):
    """A right value of a key, as it is written."""
    return str(BESIDE[table, key][0])


def text_of(table, key, value):
    """A scene that is right but for the value of one key; None takes it away."""
    return text(**changed(f"{table}.{key}", value, **BESIDE[table, key][1]))
