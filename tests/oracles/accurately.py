"""How far values of single surfaces are from exact sums over their very heights, literally added up.

The sums are literal: each asperity's own formula, added up. Where loads may be negative, as with adhesion,
they are held against the sum over the contacts of what each presses or pulls and of its pull at first touch.
"""

import numpy as np

from analytic import quantity_of
from analytic.laws.law import slope_in_root
from oracles.inside import sampler_of, summits_drawn
from oracles.literal import POWERS

POWERS_OF_RADIUS = {"load": 0.5, "area": 1.0, "stiffness": 0.5, "conductance": 0.5, "contacts": 0.0}


def drawn(scene, surfaces):
    """Values of some surfaces, and their heights: how many each has, all of them, ratios of radii or None."""
    sampler = sampler_of(scene)
    sums = sampler.block(0, surfaces)
    listed = [summits_drawn(scene, sampler, surface) for surface in range(surfaces)]
    numbers = [len(s) for s, _ in listed]
    s = np.concatenate([s for s, _ in listed])
    ratios = None if listed[0][1] is None else np.concatenate([c for _, c in listed])
    return sums, numbers, s, ratios


def worst_error(scene, surfaces):
    """Largest error of any value, relative to its exact sum."""
    sums, numbers, s, ratios = drawn(scene, surfaces)
    owner, worst = np.repeat(np.arange(surfaces), numbers), 0.0
    pull = abs(float(scene.law.on(scene.surface).load(0, 0.0, np.array(1.0))))
    for name in scene.quantities:
        q = quantity_of(name)
        for k, h in enumerate(scene.separations):
            here = s > (scene.unload_from if q.unloading else h)
            x, c = s[here], 1.0 if ratios is None else ratios[here] ** POWERS_OF_RADIUS[name]
            one = c * term(scene, name, h, x)
            digit = np.abs(c * term(scene, name, h, x + np.spacing(np.abs(x) + abs(h))) - one)
            size = np.abs(one) + (pull * (one != 0) if q.base == "load" else 0.0)
            exact, size, digit = (
                q.scale(scene.surface) * np.bincount(owner[here], part, surfaces)
                for part in (one, size, digit)
            )
            error = np.abs(sums[name][:, k] - exact) - digit  # what the last digit of a height is good for
            assert not sums[name][size == 0, k].any()
            worst = max(worst, (error[size > 0] / size[size > 0]).max(initial=0.0))
    return worst


def term(scene, name, h, s):
    """What asperities of heights `s` add to a quantity at `h`, reduced: each by the piece it has reached."""
    q, law, e = quantity_of(name), scene.law.on(scene.surface), scene.modulus(s)
    if scene.hertzian and name in POWERS:
        power, modulus = POWERS[name]
        return (s - h) ** power * e**modulus
    deepest = s - (scene.unload_from if q.unloading else h)
    with np.errstate(divide="ignore"):
        reached = (law.limits(e) <= deepest).sum(axis=0)
    found = np.zeros(len(s))
    for piece in np.unique(reached).tolist():
        some = reached == piece
        formulas = _back if q.unloading else _there
        found[some] = formulas(scene, law, q.base, piece, s[some] - h, deepest[some], e[some])
    return found


def _there(scene, law, name, piece, d, _, e):
    y = np.sqrt(d)
    radius = law.radius(piece, y, e)
    return {
        "load": lambda: law.load(piece, y, e),
        "area": lambda: radius**2,
        "stiffness": lambda: law.stiffness(piece, y, e),
        "contacts": lambda: np.ones(len(y)),
        "conductance": lambda: radius,
        "conductance_si": lambda: _of_spots(scene, radius),
        "load_slope": lambda: 2 / 3 * slope_in_root(lambda v: law.load(piece, v, e), y),
        "yielded": lambda: np.full(len(y), float(piece > 0)),
    }[name]()


def _of_spots(scene, radius):
    """Constriction in the two bodies and a film in series, over the unit of conductance."""
    unit = (scene.surface.radius * scene.surface.sigma) ** 0.5
    a = unit * radius
    return 1 / (4 * unit * (scene.film.rho / (4 * a) + scene.film.film_resistance / (np.pi * a * a)))


def _back(_, law, name, piece, d, most, e):
    """After lift-off nothing."""
    found, left = np.zeros(len(d)), law.unloading(most).left(d, e)
    held = left > 0
    way, y, e = law.unloading(most[held]), np.sqrt(left[held]), e[held]
    radius = way.radius(piece, y, e)
    found[held] = {
        "load": lambda: way.load(piece, y, e),
        "area": lambda: radius**2,
        "stiffness": lambda: way.stiffness(piece, y, e),
        "contacts": lambda: np.ones(len(y)),
        "conductance": lambda: radius,
        "load_slope": lambda: 2 / 3 * slope_in_root(lambda v: way.load(piece, v, e), y),
    }[name]()
    return found
