"""Random scenes over all features.

A scene that is accepted draws three surfaces within ten seconds of
CPU; its values are literal sums over their heights to the last digits, and means those of the values.
Where heights are not told, means lie in 7 exact standard deviations: less than one false alarm in 1e5
scenes. Another is refused when it is made, by a line with its key and a remedy.
"""

import time
import traceback

import numpy as np
import scipy.stats

import mcgw
from analytic import RandomCurvature, laws, quantity_of
from oracles.accurately import term
from oracles.inside import PROMISES
from oracles.scenes import scene_by

SECONDS, SURFACES, FAR = 10.0, 3, 7.0
ROUNDING, BENT, NEAR_BY = 3e-13, 1e-11, 0.8  # of sums; under steep gradings and layered laws; width of a cell
BASIC = ["load", "area", "stiffness", "contacts", "conductance"]
SURFACE = mcgw.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-5, E_star=78.6e9)
YIELDING = ("ke", "ceb", "zmc", "jg")


def grading(dice):
    a, b, c = dice.normal(size=3)
    fast, faster, steep = 10 ** dice.uniform([-1, 0, 0], [2, 1.3, 1.5]) * [1, 1, dice.choice([-1, 1])]
    kinds = {
        "none": lambda: None,
        "exponential": lambda: mcgw.Exponential(float(dice.uniform(-3, 7))),
        "soft": lambda: mcgw.Exponential(float(dice.uniform(0, 1))),
        "table": lambda: mcgw.Table(
            np.cumsum(10 ** dice.uniform(-4, 0.5, 5)) - 4, 10 ** dice.uniform(-1, 1, 5)
        ),
        "tanh": lambda: lambda s: 1 + 0.9 * np.tanh(fast * (s - a)),
        "square": lambda: lambda s: 1 + 2.5 * np.tanh(s - a) ** 2,
        "wave": lambda: lambda s: 1 + 0.8 * np.sin(faster * s + b),
        "exp": lambda: lambda s: np.exp(np.clip(steep * (s - 1), -300, 300)),
        "kink": lambda: lambda s: 1 + np.abs(c) * np.abs(s - a),
        "step": lambda: lambda s: np.where(s > a, 2.0, 0.5),
    }
    kind = dice.choice(list(kinds))
    return kinds[kind]()


def heights(dice):
    shape = float(10 ** dice.uniform(0.05, 1.8))
    frozen = {
        "gamma": lambda: scipy.stats.gamma(shape), "chi2": lambda: scipy.stats.chi2(2 * shape),
        "f": lambda: scipy.stats.f(10, 9 + shape), "t": lambda: scipy.stats.t(3 + shape),
        "lognorm": lambda: scipy.stats.lognorm(float(dice.uniform(0.05, 1))),
        "beta": lambda: scipy.stats.beta(1 + shape, 2.5), "uniform": scipy.stats.uniform,
        "triangle": lambda: scipy.stats.triang(0.3), "skewnorm": lambda: scipy.stats.skewnorm(shape),
        "logistic": scipy.stats.logistic, "gumbel": scipy.stats.gumbel_r,
        "johnsonsu": lambda: scipy.stats.johnsonsu(1.0, 2.0), "gennorm": lambda: scipy.stats.gennorm(2.5),
        "exponnorm": lambda: scipy.stats.exponnorm(shape / 10), "rice": lambda: scipy.stats.rice(2.0),
        "invgauss": lambda: scipy.stats.invgauss(0.3), "genextreme": lambda: scipy.stats.genextreme(0.1),
    }  # fmt: skip
    kinds = {
        "gaussian": lambda: None, "exponential": mcgw.ExponentialHeights,
        "weibull": lambda: mcgw.Weibull(min(shape, 40.0)),
        "nayak": lambda: mcgw.Nayak(1.5 + shape / 3),
        "table": lambda: mcgw.HeightTable.of(dice.gumbel(size=300)),
        "measured": lambda: mcgw.MeasuredHeights(dice.normal(size=400)),
        "scipy": lambda: frozen[dice.choice(list(frozen))](),
    }  # fmt: skip
    return kinds[dice.choice(list(kinds), p=[0.35, 0.1, 0.1, 0.1, 0.1, 0.05, 0.2])]()


def law(dice):
    critical = float(10 ** dice.uniform(-3.5, 0))
    kinds = {
        "hertz": lambda: None, "ke": lambda: laws.KogutEtsion(critical=critical),
        "bridged": lambda: laws.KogutEtsion(critical=critical, bridge="hermite"),
        "ceb": lambda: laws.ChangEtsionBogy(critical=critical),
        "zmc": lambda: laws.ZhaoMaiettaChang(critical=critical),
        "jg": lambda: laws.JacksonGreen(yield_strain=float(10 ** dice.uniform(-3, -1.8)), critical=critical),
        "coated": lambda: laws.Coated(reduced_thickness=critical, ratio=float(10 ** dice.uniform(-1, 1))),
        "depth": lambda: laws.PowerLawGraded(float(dice.uniform(0.05, 0.8)), reduced_c0=1.0),
        "jkr": lambda: laws.JohnsonKendallRoberts(pull_off=critical),
        "dmt": lambda: laws.DerjaguinMullerToporov(pull_off=critical),
    }  # fmt: skip
    kind = dice.choice(list(kinds), p=[0.3, 0.14, 0.06, 0.09, 0.09, 0.09, 0.06, 0.05, 0.06, 0.06])
    return kind, kinds[kind]()


def asked(seed):
    """Arguments of `mcgw.Scene`; everything is taken with the seed alone."""
    dice = np.random.default_rng([seed, 32])
    kind, contact = law(dice)
    number = int(10 ** dice.uniform(0, 1.6))
    h = np.sort(dice.uniform(dice.choice([-6.0, -2.5, 0.0]), 4, number))
    if dice.random() < 0.2:
        h = np.linspace(0, 4, number)
    names = [*BASIC, *(["load_slope"] * (kind != "hertz")), *(["yielded"] * (kind in YIELDING))]
    names = [name for name in names if dice.random() < 0.7] or ["load"]
    values = {
        "surface": SURFACE, "separations": h, "law": contact, "grading": grading(dice),
        "negative": str(dice.choice(["error", "clip", "allow"], p=[0.2, 0.7, 0.1])), "heights": heights(dice),
        "n_asperities": int(10 ** dice.uniform(0.5, 5)), "n_surfaces": SURFACES, "seed": seed,
        "count": str(dice.choice(["fixed", "poisson"])),
    }  # fmt: skip
    if isinstance(values["heights"], mcgw.Nayak) and dice.random() < 0.5:
        values["summits"] = RandomCurvature(values["heights"].alpha)
    if isinstance(values["heights"], mcgw.MeasuredHeights):
        values |= {"n_asperities": 400, "n_surfaces": 1, "count": "fixed"}
    if dice.random() < 0.3:
        values["unload_from"] = "loop" if dice.random() < 0.6 else float(h[0] - dice.exponential(2))
    if dice.random() < 0.1:
        values["joint"] = mcgw.Joint(resistivity=1e-7, film_resistance=float(10 ** dice.uniform(-14, -10)))
        names.append("conductance_si")
    if dice.random() < 0.15:
        bulk = SURFACE.E_star * float(10 ** dice.uniform(1, 4))
        reference = str(dice.choice(["body", "mean-plane"]))
        values["interaction"] = mcgw.Interaction(reference, bulk_modulus=bulk)
    values["sampler"] = str(
        dice.choice(["auto", "cells", "tail", "direct", "aggregate"], p=[0.55, 0.3, 0.05, 0.05, 0.05])
    )
    values["keep"] = str(dice.choice(["sums", "statistics"], p=[0.95, 0.05]))
    return values | {"quantities": names}


def judged(seed):
    """Of a scene: whether ``accepted``, ``seconds``, ``worst`` error over the allowed, ``wrong``."""
    start, told = time.process_time(), {"seed": seed, "accepted": False, "worst": 0.0, "wrong": ""}
    try:
        scene = scene_by(**asked(seed))
    except mcgw.SceneError as error:
        unsaid = [line for line in error.problems if ":" not in line or ";" not in line]
        return told | {
            "seconds": time.process_time() - start,
            "wrong": f"says no remedy: {unsaid[0]}" if unsaid else "",
            "refused": list(error.problems),
        }
    told["made"] = time.process_time() - start
    try:
        ensemble = mcgw.simulate(scene)
        told |= {"accepted": True, "seconds": time.process_time() - start, "sampler": ensemble.sampler}
        if PROMISES[ensemble.sampler].one_by_one:
            told["worst"], told["where"] = worst_share(listed := with_sums(ensemble))
            told["wrong"] = "off" if not told["worst"] <= 1 else other_means(ensemble, listed)
        else:
            told["wrong"] = far_from_theory(ensemble)
    except Exception:  # whatever it is, it came after the scene was accepted
        told |= {"seconds": time.process_time() - start, "wrong": traceback.format_exc(limit=-3)}
    if told["seconds"] > SECONDS:
        told["wrong"] += " slow"
    return told


def with_sums(ensemble):
    """The same surfaces with the values of each."""
    if ensemble.scene.keep != "statistics":
        return ensemble
    return mcgw.simulate(ensemble.scene.replace(keep="sums", sampler=ensemble.sampler))


def other_means(ensemble, listed):
    """The quantity whose mean is another one than that of its values: also where there is no variance."""
    for name in ensemble.scene.quantities:
        mean, values = ensemble.mean(name), listed[name]
        if np.any(np.abs(mean - values.mean(axis=0)) > 1e-12 * np.abs(values).max(axis=0)):
            return f"mean of {name} is off"
    return ""


def worst_share(ensemble):
    """Largest error of a value over what is allowed of the literal sum, and of which quantity and where."""
    scene, worst, place = ensemble.scene, 0.0, ""
    pull = abs(float(scene.reduced_law.load(0, 0.0, np.array(1.0))))
    plain = scene.hertzian and getattr(scene.grading, "smooth", False)
    allowed = ROUNDING if plain else BENT
    names = [n for n in scene.quantities if scene.interaction is None or n in ("load", "area", "contacts")]
    for surface in range(ensemble.n_surfaces):
        s, ratios = mcgw.heights(scene, surface), None
        if scene.summits is not None:
            ratios = mcgw.radii(scene, surface) / scene.surface.radius
        for name in names:
            q = quantity_of(name)
            for k, h in enumerate(scene.separations):
                x = s[s > (scene.unload_from if q.unloading else h)]
                c = None if ratios is None else ratios[s > (scene.unload_from if q.unloading else h)]
                one = literal(scene, name, h, x, c)
                digit = np.abs(literal(scene, name, h, x + np.spacing(np.abs(x) + abs(h)), c) - one)
                size = np.abs(one)
                if q.base in ("load", "load_slope", "stiffness") and (pull or scene.negative == "allow"):
                    size += pull + np.abs(literal(scene, name, h, x + NEAR_BY, c))  # where signs change
                exact, size, digit = (q.scale(scene.surface) * part.sum() for part in (one, size, digit))
                error = abs(float(ensemble[name][surface, k]) - exact) - digit
                share = error / (allowed * size) if size else float(error > 0)
                if not share <= worst:
                    worst, place = float(share), f"{name} of surface {surface} at {h:g}"
    return worst, place


def literal(scene, name, h, s, ratios):
    """What each asperity adds, reduced."""
    if ratios is None and scene.film is None:
        return term(scene, name, h, s)
    return scene.ways.of(name).with_radii(ratios).terms([name], h, s, scene.modulus(s))[0]


def far_from_theory(ensemble):
    """The quantity whose mean of a few surfaces is too far from the exact one, if any."""
    scene = ensemble.scene
    if scene.as_measured or scene.interaction is not None:
        return ""
    try:
        scene.theory.std("load", scene.lowest)
    except ValueError:  # there is none in double precision
        return ""
    for name in scene.quantities:
        mean, std = (np.asarray(f(name, scene.separations)) for f in (scene.theory.mean, scene.theory.std))
        rare = np.asarray(scene.theory.mean("contacts", scene.separations)) < 20  # far from Gaussian
        off = np.abs(ensemble.mean(name) - mean) - FAR * std / np.sqrt(ensemble.n_surfaces)
        if np.any(off[~rare] > 1e-12 * np.abs(mean)[~rare]):
            return f"mean of {name} is off"
    return ""
