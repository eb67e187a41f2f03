"""Properties that hold for any scene: hypothesis chooses them, always the same ones."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import analytic
import mcgw
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.samplers import SAMPLERS
from mcgw.scene.scene import Scene
from mcgw.store.run_folder import missing
from mcgw.store.shards import Span
from mcgw.store.trailer import Trailer

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=40)
settings.load_profile("fixed")

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
heights = st.floats(0, 6).map(lambda h: round(h, 3))
some_heights = st.lists(heights, min_size=1, max_size=5).map(tuple)


@st.composite
def surfaces(draw):
    length = st.floats(1e-9, 1e-3)
    density, area, modulus = (draw(st.floats(a, b)) for a, b in ((1e6, 1e12), (1e-12, 1), (1e3, 1e12)))
    return analytic.Surface(draw(length), draw(length), density, area, modulus)


@st.composite
def scenes(draw):
    gradings = [
        st.just(analytic.Homogeneous()),
        st.floats(0, 50).map(analytic.Exponential),
        st.lists(st.floats(0.1, 9), min_size=3, max_size=3).map(
            lambda r: analytic.Table([-9.0, 1.0, 9.0], r)
        ),
    ]
    names = st.lists(st.sampled_from(list(analytic.QUANTITIES)), min_size=1, unique=True)
    return Scene(
        surface=draw(surfaces()),
        separations=draw(some_heights),
        title=draw(st.text(st.characters(codec="utf-8", exclude_categories=["Cs"]), max_size=30)),
        grading=draw(st.one_of(gradings)),
        negative=draw(st.sampled_from(["clip", "allow"])),
        quantities=tuple(draw(names)),
        n_surfaces=draw(st.integers(1, 10**9)),
        n_asperities=draw(st.integers(1, 2**53)),
        count=draw(st.sampled_from(["fixed", "poisson"])),
        seed=draw(st.integers(0, 2**64 - 1)),
        sampler=draw(st.sampled_from(SAMPLERS)),
    )


@given(scenes())
def test_a_scene_reads_as_written(scene):
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


def small(separations, **changes):
    values = {"sampler": "tail", "n_asperities": 300, "n_surfaces": 9, "seed": 3} | changes
    return Scene(surface=SURFACE, separations=separations, **values)


@given(some_heights, st.randoms(use_true_random=False), st.sampled_from(["cells", "tail", "direct"]))
@settings(max_examples=25)
def test_separations_in_any_order_and_repeated(h, dice, sampler):
    """Columns go with their separations, to the last bit."""
    shuffled = [*h, *dice.choices(h, k=2)]
    dice.shuffle(shuffled)
    a = sampler_of(small(h, sampler=sampler)).block(0, 3).sums
    b = sampler_of(small(tuple(shuffled), sampler=sampler)).block(0, 3).sums
    for name, values in b.items():
        for k, x in enumerate(shuffled):
            np.testing.assert_array_equal(values[:, k], a[name][:, h.index(x)])


@given(st.integers(0, 10**6), st.integers(1, 80), st.integers(1, 79), st.sampled_from(["tail", "aggregate"]))
@settings(max_examples=25)
def test_blocks_cut_anywhere(first, n, cut, sampler):
    drawn, cut = sampler_of(small((1.0, 2.0), sampler=sampler)), min(cut, n - 1)
    whole = drawn.block(first, n).sums
    for start, stop in ((0, cut), (cut, n)):
        if start < stop:
            for name, values in drawn.block(first + start, stop - start).sums.items():
                np.testing.assert_array_equal(values, whole[name][start:stop])


@given(st.integers(-30, 30), st.integers(-30, 30))
@settings(max_examples=15)
def test_units_of_length_and_stress_are_free(metre, pascal):
    """Other units, powers of two apart: the very same digits."""
    s, scene = SURFACE, small((0.0, 1.0, 2.5))
    a, p = 2.0**metre, 2.0**pascal
    other = analytic.Surface(s.sigma * a, s.radius * a, s.eta / a**2, s.nominal_area * a**2, s.E_star * p)
    units = {"load": a * a * p, "area": a * a, "stiffness": a * p, "contacts": 1.0}
    before = sampler_of(scene).block(0, 3).sums
    for name, values in sampler_of(replace(scene, surface=other)).block(0, 3).sums.items():
        np.testing.assert_array_equal(values, before[name] * units[name])


@given(st.integers(1, 500), st.integers(1, 60), st.lists(st.integers(0, 499), max_size=8))
def test_gaps_and_what_is_held_make_the_whole(n, size, cuts):
    """Held blocks at random: what is missing fills the rest once, in blocks that end at multiples."""
    edges = sorted({0, n, *(c for c in cuts if c < n)})
    spans = [Span(a, b - a) for a, b in pairwise(edges)]
    held = spans[::2]
    gaps = missing(n, size, held)
    covered = sorted([*gaps, *held])
    assert covered[0].first == 0
    assert covered[-1].stop == n
    assert all(a.stop == b.first for a, b in pairwise(covered))
    assert all(span.first // size == (span.stop - 1) // size for span in gaps)


@given(st.binary(max_size=600))
def test_no_bytes_are_taken_for_a_trailer(data):
    try:
        Trailer.from_bytes(data)
    except mcgw.store.ensembles.StoreError:
        return
    raise AssertionError(data)


@given(st.integers(0, 8 * 512 - 1))
def test_a_changed_trailer_is_none(bit):
    data = bytearray(Trailer(7, "e" * 64, {"first": 3}).to_bytes())
    data[bit // 8] ^= 1 << bit % 8
    test_no_bytes_are_taken_for_a_trailer.hypothesis.inner_test(bytes(data))
