"""`cells` under every contact law against exactly rounded sums of each asperity's own formula."""

import math
from dataclasses import replace

import numpy as np
import pytest

import analytic
import mcgw
from analytic import laws
from mcgw.sampling import cells
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.samplers import cells_of

LAWS = {
    "Kogut": laws.KogutEtsion(critical=0.05),
    "Kogut, soft": laws.KogutEtsion(critical=0.001),
    "Kogut, hard": laws.KogutEtsion(critical=10.0),
    "Kogut, bridged": laws.KogutEtsion(critical=0.05, bridge="hermite"),
    "Chang": laws.ChangEtsionBogy(critical=0.05),
    "Zhao": laws.ZhaoMaiettaChang(critical=0.05),
    "Jackson": laws.JacksonGreen(yield_strain=0.004, critical=0.1),
    "graded half-space": laws.PowerLawGraded(0.5, reduced_c0=1.0),
    "coated": laws.Coated(reduced_thickness=0.5, ratio=3.0),
    "Derjaguin": laws.DerjaguinMullerToporov(pull_off=0.05),
    "Johnson": laws.JohnsonKendallRoberts(pull_off=0.05),
    "Johnson, sticky": laws.JohnsonKendallRoberts(pull_off=0.5),
}
GRADINGS = {
    "homogeneous": analytic.Homogeneous(),
    "gamma 0": analytic.Exponential(0.0),
    "gamma 0.2": analytic.Exponential(0.2),
    "gamma 2": analytic.Exponential(2.0),
    "table": analytic.Table((-4.0, 0.0, 1.0, 4.0), (0.5, 1.0, 2.0, 1.5)),
}
SEPARATIONS = {
    "equal": tuple(np.linspace(0, 3, 7)),
    "geometric": tuple(np.geomspace(0.01, 3, 6)),
    "random": tuple(0.5 + 2 * np.random.default_rng(4).random(6)),
    "close": (1.0, 1.0 + 1e-9, 1.5),
}
QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance", "load_slope")
SURFACE = analytic.Surface(sigma=1.37e-6, radius=1.3e-5, eta=3e8, nominal_area=1e-4, E_star=78.6e9)


def scene_of(law, grading, separations, **changes):
    names = QUANTITIES if law.elastic else (*QUANTITIES, "yielded")
    if "unload_from" in changes and not law.on(SURFACE).unloading().stiff:
        names = ("load", "area", "contacts", "conductance")
    return mcgw.Scene(
        SURFACE,
        separations=separations,
        grading=grading,
        negative="clip",
        law=law,
        quantities=names,
        n_asperities=20_000,
        n_surfaces=1,
        seed=11,
        **changes,
    )


def literal(scene, heights, name):
    """Sum of each asperity's own formula at each separation, exactly rounded."""
    law, q = scene.law.on(scene.surface), analytic.quantity_of(name)
    e_of_all = scene.modulus(heights)
    sums = []
    for h in scene.separations:
        terms = []
        for piece in range(1 + len(law.limits(np.ones(1)))):
            with np.errstate(divide="ignore"):
                limits = law.limits(e_of_all)
            deepest = heights - (h if not q.unloading else scene.unload_from)
            here = (deepest >= 0) & ((limits <= deepest).sum(axis=0) == piece)
            d, most, e = heights[here] - h, deepest[here], e_of_all[here]
            terms += of_piece(law, q.base, piece, d, most, e, back=bool(q.unloading)).tolist()
        sums.append(q.scale(scene.surface) * math.fsum(terms))
    return np.array(sums)


def of_piece(law, name, piece, d, most, e, *, back):
    """What asperities add that are `d` deep and, on the way back, have been as deep as `most`."""
    if back:
        way = law.unloading()
        left = d - way.residual(piece, most, e)
        held = left > 0
        y, most, e = np.sqrt(left[held]), most[held], e[held]
        load, radius = way.load(piece, y, most, e), way.radius(piece, y, most, e)
        if way.stiff:
            stiffness, slope = way.stiffness(piece, y, most, e), way.slope(piece, y, most, e)
        else:
            stiffness = slope = np.full(len(y), np.nan)
    else:
        d, e = d[d > 0], e[d > 0]
        y = np.sqrt(d)
        load, radius = law.load(piece, y, e), law.radius(piece, y, e)
        stiffness, slope = law.stiffness(piece, y, e), law.slope(piece, y, e)
    return {
        "load": load,
        "area": radius**2,
        "stiffness": stiffness,
        "contacts": np.ones(len(y)),
        "conductance": radius,
        "load_slope": 2 / 3 * slope,
        "yielded": np.full(len(y), float(piece > 0)),
    }[name]


def worst(scene):
    """Largest difference, of the largest value of each quantity."""
    sampler = cells_of(scene)
    drawn, heights = sampler.block(0, 1).sums, summits_drawn(scene, sampler, 0)[0]
    found = []
    for name in scene.quantities:
        expected = literal(scene, heights, name)
        largest = np.abs(expected).max()
        found.append(np.abs(drawn[name][0] - expected).max() / (largest if largest > 0 else 1.0))
    return max(found)


@pytest.mark.parametrize(
    "separations",
    [
        pytest.param(h, id=name, marks=[] if name in ("equal", "close") else pytest.mark.slow)
        for name, h in SEPARATIONS.items()
    ],
)
@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_sums_are_those_of_the_asperities(law, grading, separations):
    back = (
        {} if "Chang" in type(law).__name__ or isinstance(law, laws.JacksonGreen) else {"unload_from": "loop"}
    )
    assert worst(scene_of(law, grading, separations, **back)) < 1e-12


@pytest.mark.parametrize("critical", np.geomspace(1e-3, 10, 7))
def test_critical_penetrations_over_four_decades(critical):
    scene = scene_of(laws.KogutEtsion(critical=critical), analytic.Exponential(1.5), SEPARATIONS["equal"])
    assert worst(scene) < 1e-12


@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_break_that_is_no_edge_is_refused(monkeypatch, number):
    """A row that ends inside a cell is never interpolated over: that would be off by up to 0.8 %."""
    find = cells.begins_and_breaks

    def without_one(scene, low, high):
        begins, breaks = find(scene, low, high)
        inner = np.setdiff1d(breaks, [low, high, *begins])
        return begins, np.delete(breaks, np.searchsorted(breaks, inner[number]))

    scene = scene_of(laws.KogutEtsion(critical=0.3), analytic.Exponential(1.5), (0.0, 0.7, 1.1))
    assert worst(scene) < 1e-12
    monkeypatch.setattr(cells, "begins_and_breaks", without_one)
    with pytest.raises(ValueError, match=r"break of the contact law at s = .* is not an edge"):
        cells_of(scene)


@pytest.mark.parametrize("sampler", ["cells", "tail"])
def test_all_exact_samplers_sum_the_same_formulas(sampler):
    """Asperities drawn by themselves, outside the cells or in `tail`, follow the law too."""
    scene = scene_of(laws.KogutEtsion(critical=0.05), analytic.Exponential(2.0), (2.0, 2.5, 3.0, 4.5))
    scene = replace(scene, sampler=sampler, n_surfaces=50)
    heights = [mcgw.heights(scene, i) for i in range(50)]
    drawn = mcgw.simulate(scene)
    for name in scene.quantities:
        expected = np.array([literal(scene, s, name) for s in heights])
        np.testing.assert_allclose(drawn[name], expected, rtol=1e-12, atol=1e-13 * expected.max())


def test_hertz_by_another_name_is_hertz():
    """A law of one piece whose formulas are Hertz's, by the rows of other laws: 1e-13."""

    class Twin(laws.ContactLaw):
        name = "twin"

    hertz = scene_of(laws.Hertz(), analytic.Exponential(2.0), SEPARATIONS["equal"])
    twin = hertz.replace(law=Twin())
    ours, theirs = (cells_of(scene).block(0, 1).sums for scene in (twin, hertz))
    for name in hertz.quantities:
        np.testing.assert_allclose(ours[name], theirs[name], rtol=1e-13)
