"""Scenes whose surfaces are held against literal sums over their heights: what each asks of `mcgw.Scene`.

Each is of three surfaces, or as many as ``surfaces`` says: what goes wrong in rare cells shows in few.
"""

import numpy as np
import scipy.stats

import analytic
import mcgw
from analytic import laws

H = tuple(np.linspace(0, 4, 21))
BASIC = ("load", "area", "stiffness", "contacts", "conductance")
KOGUT = laws.KogutEtsion(critical=0.05)
GAMMA_STAR = float(np.exp(0.5) / (np.exp(0.5) - 1))

CLOSE_KINKS = analytic.Table([-1.0, 1.03, 1.0304, 1.0308, 3.0], [1.0, 1.0, 1.1, 1.0, 1.0])
GRADINGS = {
    "gamma 0": analytic.Exponential(0.0),
    "gamma 0.2": analytic.Exponential(0.2),
    "homogeneous": analytic.Homogeneous(),
    "gamma 2": analytic.Exponential(2.0),
    "table": analytic.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5]),
    "kinks nearer than a node's points": CLOSE_KINKS,
    "step": analytic.Custom(lambda s: np.where(s > 1.234, 2.0, 0.5), (1.234,)),
    "untold step": analytic.Custom(lambda s: np.where(s > 0.777, 2.0, 0.5)),
    "steep": analytic.Custom(lambda s: 1.5 + np.tanh(1e3 * (s - 0.5))),
    "steeper": analytic.Custom(lambda s: 1.5 + np.tanh(1e6 * (s - 0.5))),
    "exp(12 s)": analytic.Custom(lambda s: np.exp(12 * s)),
    "exp(30 s)": analytic.Custom(lambda s: np.exp(30 * s)),
    "exp(-30 s)": analytic.Custom(lambda s: np.exp(-30 * s)),
    "exp(60 s)": analytic.Custom(lambda s: np.exp(60 * (s - 3)), checked=False),
}


def graded(name, **changes):
    return {"grading": GRADINGS[name], "separations": np.linspace(0, 4, 11), "n_asperities": 4000} | changes


def at(*h, **changes):
    return {"grading": analytic.Exponential(0.2), "separations": h, "n_asperities": 300} | changes


def lone(k, h):
    """It falls by decades between two separations, and a single contact is as accurate as all of them."""
    steep = analytic.Custom(lambda s: np.exp(k * (s - 3)), checked=False)
    return {"grading": steep, "separations": h, "n_asperities": 1500}


def step(law, middle, slope, *h):
    """The law of heights, the grading and the root bend together: cells are cut until all is resolved."""
    grading = analytic.Custom(lambda s: 1.5 + np.tanh(slope * (s - middle)))
    return {"heights": law, "grading": grading, "separations": h}


def smooth(shape, gamma, n, *h):
    """Where the law of heights bends as fast as cells allow, a cell needs all but one of its coefficients."""
    grading = analytic.Exponential(gamma)
    changes = {"grading": grading, "negative": "allow", "separations": h, "n_asperities": n}
    return {"heights": analytic.Weibull(shape), **changes}


def heights(law, low=-0.3):
    return {"heights": law, "grading": analytic.Exponential(0.5), "separations": np.linspace(low, 1.5, 13)}


def under(law, *more, **changes):
    return {"law": law, "quantities": (*BASIC, "load_slope", *more), "separations": np.linspace(0, 3, 13)} | (
        changes
    )


DICE = np.random.default_rng(3)
UNSORTED = DICE.uniform(-1, 3.5, 12)
# Hertz's law, under gradings and laws of heights of every kind.
HERTZ = {
    "few": {"n_asperities": 50, "surfaces": 10, "count": "poisson"},
    "high": {"separations": np.linspace(2, 5, 16), "n_asperities": 20_000},
    **{f"grading {name}": graded(name) | {"surfaces": 6} for name in GRADINGS},
    "steep": graded("steep", n_asperities=4500) | {"surfaces": 6},  # a lone contact in its ramp is 6e-12 off
    "geometric": at(*np.geomspace(1e-3, 4, 25)) | {"surfaces": 10},
    "unsorted and repeated": at(*UNSORTED, 0.5, 0.5, -0.0) | {"surfaces": 10},
    "close": at(1.0, 1.0 + 1e-9, 1.0 + 3e-9, 1.0 + 1e-6, 1.5) | {"surfaces": 10},
    "every cell full": at(1.0, 1.0 + 1e-9, 1.0 + 1e-6, 1.5, n_asperities=50_000) | {"surfaces": 1},
    "lone": lone(-30.0, np.linspace(0, 4, 11)) | {"surfaces": 40},
    "lone, high": lone(-60.0, (3.2, 3.6)) | {"surfaces": 40},
    "step, weibull": step(analytic.Weibull(2.55), 1.14, 24.0, 0.0, 1e-28, 0.6) | {"surfaces": 20},
    "step, far down": step(analytic.Weibull(1.82), 2.12, 47.0, -27.6, -21.7, -10.8) | {"surfaces": 20},
    "step, exponential": step(analytic.ExponentialHeights(), 2.65, 3.35, 0.01803722, 0.01803731)
    | {"surfaces": 20},
    "step, below all": step(analytic.ExponentialHeights(), 0.03, 5.0, -27.7, -27.3) | {"surfaces": 20},
    "smooth 4.6": smooth(4.63, 0.7144619, 17, -1.655150524, 2.22019398) | {"surfaces": 20},
    "smooth 45": smooth(45.423, 1.43735, 6, 0.46187410402, 3.14785127) | {"surfaces": 20},
    "smooth 1.7": smooth(1.6853, 0.69289, 1638, -3.42293094, 2.2294051) | {"surfaces": 20},
    "from -40 to 40": {"separations": np.linspace(-40, 40, 17), "grading": None},
    "next to zero": {"separations": (-1e-100, 0.0, 1e-100, 1e-50, 1.0)},
    "1e-12 apart": {"separations": (1.0, 1.0 + 1e-12, 1.0, 1.0 + 2e-12, 2.0), "n_asperities": 10**5},
    **{f"gamma {gamma:g}": {"grading": analytic.Exponential(gamma)} for gamma in (GAMMA_STAR, 1e6, 1e60)},
    "negative gamma": {"grading": analytic.Exponential(-0.5)},
    "exponential heights": heights(analytic.ExponentialHeights()),
    **{f"weibull {shape:g}": heights(analytic.Weibull(shape)) for shape in (1.5, 3.60235, 40.743)},
    "nayak": heights(analytic.Nayak(2.0)),
    "table of heights": heights(analytic.HeightTable.of(DICE.weibull(1.6, size=300)), -30.0),
    **{law.dist.name: heights(law, -30.0) for law in (
        scipy.stats.uniform(), scipy.stats.t(5), scipy.stats.gamma(2.5), scipy.stats.beta(2.5, 3.5),
        scipy.stats.laplace(),
    )},
}  # fmt: skip

CLIPPED = {"grading": analytic.Exponential(5.5), "negative": "clip", "separations": [-2.4, -0.5, 2.0]}
BELOW_ONE = {"grading": analytic.Exponential(-1.5), "negative": "clip", "separations": [-1.2, 1.8]}
STEP = analytic.Table([1.0, 1.0004, 1.0008, 3.0], [1.0, 3.0, 1.0, 2.0])
# Where a contact law, a film or radii bend with the modulus: to 1e-11.
LAWS = {
    "plastic at once": {**CLIPPED, "law": mcgw.ChangEtsionBogy(critical=0.08)},
    "by and by": {**CLIPPED, "law": mcgw.ZhaoMaiettaChang(critical=0.0013)},
    "powers": {**BELOW_ONE, "law": mcgw.KogutEtsion(critical=0.0018)},
    "and back": {**BELOW_ONE, "law": mcgw.KogutEtsion(critical=0.0018), "unload_from": "loop"},
    "a table": {"grading": STEP, "separations": [1.0, 2.0]},
    "plastic at first touch": {
        "law": mcgw.ZhaoMaiettaChang(critical=0.015),
        "grading": analytic.Custom(lambda s: np.exp(29 * (s - 1))),
        "separations": [0.2, 1.3, 2.2],
        "quantities": ["load", "area", "stiffness", "load_slope"],
    },
    "comes off where it softens": {
        "law": mcgw.KogutEtsion(critical=0.0191),
        "grading": analytic.Custom(lambda s: 1 + 0.8 * np.sin(8 * s - 0.376)),
        "separations": [0.0, 1.1],
        "unload_from": -1.6,
        "sampler": "cells",
    },
    "elastic again where it softens": {
        "law": mcgw.JacksonGreen(yield_strain=0.0059, critical=0.386),
        "grading": analytic.Exponential(-1.2554),
        "negative": "clip",
        "separations": [-3.81, -1.713, -1.577, -1.086, 0.1313, 1.133, 1.734],
        "quantities": ["load", "conductance", "load_slope"],
        "n_asperities": 52,
    },
    "sticks": {
        "law": mcgw.JohnsonKendallRoberts(pull_off=0.5),
        "unload_from": "loop",
        "separations": [1.0, 1.0 + 1e-9, 1.5],
        "quantities": ["load", "area", "contacts"],
    },
    "Kogut, few": under(KOGUT, n_asperities=50, count="poisson"),
    "Kogut, steep": under(KOGUT, grading=analytic.Custom(lambda s: 1.5 + np.tanh(8 * (s - 1)))),
    "Kogut, weibull": under(KOGUT) | heights(analytic.Weibull(1.5)),
    "film": under(KOGUT, "conductance_si", joint=mcgw.Joint(resistivity=1e-7, film_resistance=1e-12)),
}
