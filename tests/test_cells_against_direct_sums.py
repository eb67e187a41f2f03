"""`cells` (moments times response) against exactly rounded sums over the very same heights."""

import dataclasses

import numpy as np
import pytest
from oracles import sums_of_heights

import analytic
import mcgw
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.samplers import sampler_of

GRADINGS = {
    "gamma 0": analytic.Exponential(0.0),
    "gamma 0.2": analytic.Exponential(0.2),
    "homogeneous": analytic.Homogeneous(),
    "gamma 2": analytic.Exponential(2.0),
    "table": analytic.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5]),
    "step": analytic.Custom(lambda s: np.where(s > 1.234, 2.0, 0.5), (1.234,)),
    "untold step": analytic.Custom(lambda s: np.where(s > 0.777, 2.0, 0.5)),
    "steep": analytic.Custom(lambda s: 1.5 + np.tanh(1e3 * (s - 0.5))),
    "steeper": analytic.Custom(lambda s: 1.5 + np.tanh(1e6 * (s - 0.5))),
    "exp(12 s)": analytic.Custom(lambda s: np.exp(12 * s)),
    "exp(20 s)": analytic.Custom(lambda s: np.exp(20 * s)),
    "exp(30 s)": analytic.Custom(lambda s: np.exp(30 * s)),
    "exp(-30 s)": analytic.Custom(lambda s: np.exp(-30 * s)),
    "exp(60 s)": analytic.Custom(lambda s: np.exp(60 * (s - 3))),
}
MANY = 20  # surfaces: what goes wrong in rare cells does not show in each
RANDOM = np.random.default_rng(3)
SEPARATIONS = {
    "equal": tuple(np.linspace(0, 4, 41)),
    "geometric": tuple(np.geomspace(1e-3, 4, 25)),
    "random, unsorted, repeated": (*RANDOM.uniform(-1, 3.5, 12), 0.5, 0.5, -0.0),
    "close": (1.0, 1.0 + 1e-9, 1.0 + 3e-9, 1.0 + 1e-6, 1.5),
    "one": (0.7,),
}


def last_digit(scene, heights, quantity):
    """Relative change of each sum if all heights are one digit off."""
    n = analytic.QUANTITIES[quantity].exponent
    changes = []
    for h in scene.separations:
        d = heights[heights > h] - h
        changes.append(
            n * np.spacing(d.max() + abs(h)) * (d ** (n - 1)).sum() / (d**n).sum() if d.size and n else 0.0
        )
    return np.array(changes)


def worst(scene, surface, sampler=None):
    """Largest relative difference, over all quantities and separations that are reached.

    Less what the last digit of a listed height is good for where a contact just touches.
    """
    sampler = sampler or sampler_of(scene)
    drawn = sampler.block(surface, 1).sums
    heights = summits_drawn(scene, sampler, surface)[0]
    errors = []
    for quantity in scene.quantities:
        exact = sums_of_heights(scene, heights, quantity)
        found = drawn[quantity][0]
        reached = exact > 0
        np.testing.assert_array_equal(found[~reached], 0.0)
        error = np.abs(found[reached] / exact[reached] - 1)
        errors.append((error - last_digit(scene, heights, quantity)[reached]).max(initial=0.0))
    return max(errors)


@pytest.mark.parametrize("grading", GRADINGS)
def test_gradings(make_scene, grading):
    scene = make_scene(
        grading=GRADINGS[grading],
        separations=SEPARATIONS["equal"],
        quantities=tuple(analytic.QUANTITIES),
        sampler="cells",
        n_asperities=20_000,
    )
    sampler = sampler_of(scene)
    # the accuracy promised; the response is built for 1e-13
    assert max(worst(scene, surface, sampler) for surface in range(MANY)) < 1e-12


@pytest.mark.parametrize("separations", SEPARATIONS)
@pytest.mark.parametrize("n_asperities", [300, 1_000_000])
def test_separations(make_scene, separations, n_asperities):
    scene = make_scene(
        separations=SEPARATIONS[separations],
        n_asperities=n_asperities,
        grading=analytic.Exponential(0.2),
        quantities=tuple(analytic.QUANTITIES),
        sampler="cells",
    )
    sampler = sampler_of(scene)
    surfaces = MANY if n_asperities < 1000 else 1  # in which a million fill every cell
    assert max(worst(scene, surface, sampler) for surface in range(surfaces)) < 1e-12


@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS.keys())
@pytest.mark.parametrize("separations", [(1.0,), (0.0, 0.3, 0.31, 2.0), tuple(np.linspace(0, 4, 17))])
def test_the_sparse_product_is_that_of_the_matrix(make_scene, grading, separations):
    scene = make_scene(grading=grading, separations=separations, n_asperities=30_000, negative="allow")
    response = sampler_of(scene).response
    moments = np.random.default_rng(1).normal(size=(response.layout.starts[-1], 70))
    plain = np.einsum("qhm,mi->qih", response.matrix(), moments)
    size = np.einsum("qhm,mi->qih", np.abs(response.matrix()), np.abs(moments))
    assert np.all(np.abs(response @ moments - plain) <= 1e-14 * size)


def test_from_minus_40(make_scene):
    scene = make_scene(separations=(-40.0, -9.0, 0.0, 4.0), grading=analytic.Homogeneous(), sampler="cells")
    assert worst(scene, 0) < 1e-12
    assert len(mcgw.heights(scene, 0)) == scene.n_asperities


def test_tail_sums_its_own_heights(make_scene):
    assert worst(make_scene(sampler="tail"), 3) < 1e-13


def test_a_wrong_exponent_is_seen(make_scene):
    """The companion: sums with exponent 1.4 differ from those with 3/2 far beyond the tolerance."""
    scene = make_scene(sampler="cells", quantities=("load",))
    wrong = sums_of_heights(scene, mcgw.heights(scene, 0), "load", exponent=1.4)
    right = sampler_of(scene).block(0, 1).sums["load"][0]
    assert np.abs(wrong[:5] / right[:5] - 1).max() > 1e-2


def test_derivative_of_the_load_is_the_stiffness(make_scene):
    """-dP/dd = K on one surface: central differences in the separation, error O(step^2)."""
    step = 1e-4
    h = np.linspace(0.5, 2.5, 5)
    scene = make_scene(
        separations=tuple(np.concatenate([h - step, h, h + step])),
        quantities=("load", "stiffness"),
        sampler="cells",
        n_asperities=10**6,
    )
    sums = sampler_of(scene).block(0, 1).sums
    before, _, after = sums["load"][0].reshape(3, -1)
    stiffness = sums["stiffness"][0].reshape(3, -1)[1]
    slope = (before - after) / (2 * step * scene.surface.sigma)
    # Each root sqrt(s - h) within a step of h spoils the difference: 1e-5 of the load here.
    np.testing.assert_allclose(slope, stiffness, rtol=1e-5)


def test_heights_in_all_are_the_asperities_asked_for(make_scene):
    for count in ("fixed", "poisson"):
        scene = make_scene(sampler="cells", count=count, separations=(0.5, 2.0))
        touching, every = mcgw.heights(scene, 1), mcgw.heights(scene, 1, untouched=True)
        np.testing.assert_array_equal(every[: len(touching)], touching)
        assert (touching > 0.5).all()
        assert (every[len(touching) :] <= 0.5).all()
        if count == "fixed":
            assert len(every) == scene.n_asperities
        else:
            assert abs(len(every) - 3000) < 5 * 3000**0.5
        np.testing.assert_array_equal(touching, summits_drawn(scene, sampler_of(scene), 1)[0])


def test_aggregate_and_direct_keep_no_heights(make_scene):
    for sampler in ("aggregate", "direct", "stratified"):
        with pytest.raises(ValueError, match="keeps no heights"):
            mcgw.heights(make_scene(sampler=sampler), 0)


def test_what_is_not_asked_is_not_computed(make_scene):
    """Fewer quantities need fewer moments; contacts alone need none, and draw no uniform."""
    size = {}
    for quantities in (("load", "area", "stiffness"), ("area",), ("contacts",)):
        scene = make_scene(sampler="cells", quantities=quantities, n_asperities=10**6)
        sampler = sampler_of(scene)
        size[quantities] = sampler.response.layout.sizes.sum()
        assert set(sampler.block(0, 1).sums) == set(quantities)
    assert size["load", "area", "stiffness"] > size["area",] > 0 == size["contacts",]
    full = make_scene(sampler="cells", n_asperities=10**6)
    alone = dataclasses.replace(full, quantities=("contacts",))
    np.testing.assert_array_equal(
        sampler_of(alone).block(0, 5).sums["contacts"], sampler_of(full).block(0, 5).sums["contacts"]
    )


@pytest.mark.parametrize(
    ("law", "middle", "slope", "separations"),
    [
        (analytic.Weibull(2.55), 1.14, 24.0, (0.0, 1e-28, 0.6)),
        (analytic.Weibull(1.82), 2.12, 47.0, (-27.6, -21.7, -10.8)),
        (analytic.ExponentialHeights(), 2.65, 3.35, (0.01803722, 0.01803731)),
        (analytic.ExponentialHeights(), 0.03, 5.0, (-27.7, -27.3)),
    ],
)
def test_a_smooth_step_under_any_law(make_scene, law, middle, slope, separations):
    """The law of heights, the grading and the root bend together: cells are cut until all is resolved."""
    scene = make_scene(
        heights=law,
        grading=analytic.Custom(lambda s: 1.5 + np.tanh(slope * (s - middle))),
        separations=separations,
        sampler="cells",
        quantities=tuple(analytic.QUANTITIES),
    )
    sampler = sampler_of(scene)
    assert max(worst(scene, surface, sampler) for surface in range(MANY)) < 1e-12


@pytest.mark.parametrize("keep", ["sums", "moments"])
@pytest.mark.parametrize(
    ("shape", "gamma", "separations", "n"),
    [
        (4.63, 0.7144619, (-1.655150524, 2.22019398), 17),
        (45.423, 1.43735, (0.46187410402, 3.14785127), 6),
        (1.80686, 0.6479186, (-1.87281584, -1.85053286), 9407),
        (1.6853, 0.69289, (-3.42293094, 2.2294051), 1638),
    ],
)
def test_a_smooth_grading_is_never_refused(make_scene, shape, gamma, separations, n, keep):
    """Where the law of heights bends as fast as cells allow, a cell needs all but one of its coefficients."""
    scene = make_scene(
        heights=analytic.Weibull(shape),
        grading=analytic.Exponential(gamma),
        negative="allow",
        separations=separations,
        n_asperities=n,
        keep=keep,
        sampler="cells",
        quantities=tuple(analytic.QUANTITIES),
    )
    sampler = sampler_of(scene)
    assert max(worst(scene, surface, sampler) for surface in range(MANY)) < 1e-12
