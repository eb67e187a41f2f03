"""The same bits by any number of threads and in any block; and the functions and rules that they rest on."""

import numpy as np
import pytest
from oracles.inside import SAMPLERS, sampler_of

import analytic
import mcgw
from analytic.heights import GAUSSIAN


def test_normal_law_against_mpmath():
    """Density and probability to the last digits, as far down as there are any."""
    import mpmath as mp

    rng = np.random.default_rng(1)
    x = np.concatenate([rng.uniform(-8, 8, 200), rng.uniform(-37, 0, 200)])
    with mp.workdps(40):
        for ours, exact in ((GAUSSIAN.cdf, mp.ncdf), (GAUSSIAN.pdf, mp.npdf)):
            wanted = [exact(mp.mpf(v)) for v in x.tolist()]
            error = [abs(mp.mpf(a) / b - 1) for a, b in zip(ours(x).tolist(), wanted, strict=True)]
            assert max(error) < 12 * 2.0**-53, ours
    np.testing.assert_array_equal(GAUSSIAN.cdf(np.array([-np.inf, np.inf])), [0, 1])


# --- threads, blocks, or company do not change them ------------------------------------------------------


SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, 1e-6, 78.6e9)
SCENES = {name: {"sampler": name} for name in SAMPLERS[1:]} | {
    "crowds": {"accuracy": 1e-2, "n_asperities": 10**6},
    "radii": {
        "surface": SPECTRAL.surface,
        "heights": analytic.Nayak(5.0),
        "summits": mcgw.RandomCurvature(5.0),
    },
    "yields, and back": {"law": mcgw.KogutEtsion(critical=0.05), "unload_from": "loop"},
    "pressed": {"interaction": "mean-plane"},
    "pressed, tail": {"interaction": "body", "sampler": "tail", "n_asperities": 200},
}


@pytest.mark.parametrize("name", SCENES)
def test_threads_blocks_and_company(make_scene, name):
    """In blocks of 1, 7, 64 or all at once, or a single one far down; another seed is another ensemble."""
    scene = make_scene(n_surfaces=70, **SCENES[name])
    drawn = sampler_of(scene)
    whole = drawn.block(0, 140)
    for size, firsts in ((1, range(0, 140, 5)), (7, (0, 63, 133)), (64, (0, 63))):
        for first in firsts:
            part = drawn.block(first, size)
            for quantity, values in part.items():
                np.testing.assert_array_equal(values, whole[quantity][first : first + len(values)])
    one, two = (mcgw.simulate(scene, threads=threads) for threads in (1, 2))
    for quantity in scene.quantities:
        np.testing.assert_array_equal(one[quantity], two[quantity])
    np.testing.assert_array_equal(one["load"], whole["load"][:70])
    other = sampler_of(scene.replace(seed=scene.seed + 1)).block(0, 70)["load"]
    assert (other[:, :5] != whole["load"][:70, :5]).all()


@pytest.mark.parametrize("sampler", ["cells", "tail", "direct"])
def test_separations_in_any_order_and_repeated(make_scene, sampler):
    """Columns go with their separations, to the last bit."""
    dice = np.random.default_rng(8)
    for n in (1, 1, 2, 3, 5, 5, 5):
        h = tuple(dice.uniform(0, 6, n).round(3).tolist())
        shuffled = tuple(dice.permutation([*h, *dice.choice(h, 2)]).tolist())
        a, b = (
            sampler_of(make_scene(separations=x, sampler=sampler, n_asperities=300)).block(0, 3)
            for x in (h, shuffled)
        )
        for name, values in b.items():
            for k, x in enumerate(shuffled):
                np.testing.assert_array_equal(values[:, k], a[name][:, h.index(x)])


@pytest.mark.parametrize(("metre", "pascal"), [(-30, 7), (13, -30), (30, 30), (0, 1), (1, 0)])
def test_units_of_length_and_stress_are_free(make_scene, metre, pascal):
    """Other units, powers of two apart: the very same digits."""
    scene = make_scene(separations=(0.0, 1.0, 2.5), sampler="tail", n_asperities=300)
    s, a, p = scene.surface, 2.0**metre, 2.0**pascal
    other = analytic.Surface(s.sigma * a, s.radius * a, s.eta / a**2, s.nominal_area * a**2, s.E_star * p)
    units = {"load": a * a * p, "area": a * a, "stiffness": a * p, "contacts": 1.0}
    before = sampler_of(scene).block(0, 3)
    for name, values in sampler_of(scene.replace(surface=other)).block(0, 3).items():
        np.testing.assert_array_equal(values, before[name] * units[name])
