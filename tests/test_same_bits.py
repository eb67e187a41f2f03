"""Results do not depend on threads, blocks, or what else is simulated."""

import numpy as np
import pytest

import analytic
import mcgw
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.samplers import SAMPLERS


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_threads(make_scene, sampler):
    scene = make_scene(sampler=sampler, n_surfaces=70)
    one, two = mcgw.simulate(scene, threads=1), mcgw.simulate(scene, threads=2)
    for name in scene.quantities:
        np.testing.assert_array_equal(one.values(name), two.values(name))


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_blocks_and_company(make_scene, sampler):
    """Surfaces drawn in blocks of 1, 7, 64 or all at once, or a single one far down the list."""
    drawn = sampler_of(make_scene(sampler=sampler))
    whole = drawn.block(0, 140).sums
    for size in (1, 7, 64):
        for first in (0, 63, 133):
            part = drawn.block(first, size if first < 133 else 7).sums
            for name, values in part.items():
                np.testing.assert_array_equal(values, whole[name][first : first + len(values)])


def test_repeated_and_unsorted_separations(make_scene):
    h = (2.0, 0.0, 2.0, -0.0, 1.0)
    sums = sampler_of(make_scene(separations=h, sampler="cells")).block(0, 3).sums
    ordered = sampler_of(make_scene(separations=tuple(sorted(set(h))), sampler="cells")).block(0, 3).sums
    for name in sums:
        np.testing.assert_array_equal(sums[name][:, 0], sums[name][:, 2])
        np.testing.assert_array_equal(sums[name][:, 1], sums[name][:, 3])
        np.testing.assert_allclose(sums[name][:, [1, 4, 0]], ordered[name], rtol=1e-13)


def test_change_of_units_changes_no_digit(make_scene):
    """Lengths in units of 2^-10 m instead of m, stress likewise: powers of two, so exactly."""
    scene = make_scene(sampler="cells")
    s = scene.surface
    other = analytic.Surface(
        s.sigma * 1024, s.radius * 1024, s.eta / 1024**2, s.nominal_area * 1024**2, s.E_star / 1024**2
    )
    a = sampler_of(scene).block(0, 5).sums
    b = sampler_of(make_scene(surface=other, sampler="cells")).block(0, 5).sums
    np.testing.assert_array_equal(a["load"], b["load"])  # N stays N
    np.testing.assert_array_equal(a["area"] * 1024**2, b["area"])
    np.testing.assert_array_equal(a["stiffness"] / 1024, b["stiffness"])


def test_another_seed_is_another_ensemble(make_scene):
    a, b = (sampler_of(make_scene(seed=seed)).block(0, 2).sums["load"] for seed in (1, 2))
    assert (a[:, :5] != b[:, :5]).all()


def test_sums_of_a_huge_cell_are_compensated():
    """3e6 uniforms in pieces: the sum of T_0 is exact, the mean of T_1 and T_2 is that of a uniform."""
    n = 3_000_001
    moments = cell_moments(5, 0, np.array([[n]]), Layout(np.array([4]), np.array([0])))[:, 0]
    assert moments[0] == n
    assert abs(moments[1]) < 5 * np.sqrt(n / 3)
    assert abs(moments[2] + n / 3) < 5 * np.sqrt(n * 4 / 45 * 4)


@pytest.mark.parametrize("threads", [0, -1])
def test_no_threads_is_an_error(make_scene, threads):
    with pytest.raises(ValueError, match="whole number >= 1"):
        mcgw.simulate(make_scene(), threads=threads)
