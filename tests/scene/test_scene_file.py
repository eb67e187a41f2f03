"""Scenes as TOML: what is read, refused, and reads back the same; what is left out is marked in files."""

from dataclasses import replace

import numpy as np
import pytest
from tables.scene_keys import text, text_of

import analytic
import mcgw


def test_heights_from_a_file_of_numpy_are_those_of_a_text(tmp_path):
    z = np.random.default_rng(1).weibull(1.6, size=3)
    np.save(tmp_path / "z.npy", z)
    np.savetxt(tmp_path / "z.csv", z, header="m")
    one, other = (
        mcgw.scene_from(text_of("heights", "file", f"'z.{kind}'"), folder=tmp_path).heights
        for kind in ("npy", "csv")
    )
    assert one == other == type(one)(one.heights)
    assert len(one.heights) == 3


def test_other_ways_to_write_numbers():
    written = text(
        heights=None, contact={"separations": "[-0.0]"}, ensemble={"n_asperities": "1_000", "seed": "0x10"}
    )
    scene = mcgw.scene_from(written.replace("\n", "\r\n").encode())
    assert (scene.n_asperities, scene.seed) == (1000, 16)
    assert "-0.0" not in mcgw.scene_text(scene)
    assert mcgw.scene_from(text(heights=None, ensemble={"n_asperities": "1e6"})).n_asperities == 10**6


# --- what nobody gave ---

SURFACE = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11)
LARGE = replace(SURFACE, nominal_area=1e-5)


def again(scene):
    """As it is read from its own text."""
    return mcgw.scene_from(mcgw.scene_text(scene))


def test_n_follows_the_surface_unless_it_was_given(tmp_path):
    left_out = mcgw.Scene(surface=SURFACE, separations=(1.0,), seed=1)
    given = left_out.replace(n_asperities=1000)
    assert left_out == given  # the same ensemble, by whatever way
    assert hash(left_out.n_asperities) == hash(1000)
    assert repr(left_out) == repr(given)
    for scene in (left_out, given):  # and the same file
        assert mcgw.run(scene.replace(n_surfaces=2), tmp_path / "e.h5").n_surfaces == 2
    for change in ({"surface": LARGE}, {"nominal_area": 1e-5}, {"nominal_area": "10 mm²"}):
        for way in (lambda s: s, lambda s: s.replace(title="between"), again):
            assert way(left_out).replace(**change).n_asperities == 10_000
            assert way(given).replace(**change).n_asperities == 1000
    assert left_out.replace(eta="2000/mm^2", nominal_area="1 cm^2").n_asperities == 200_000


def test_a_drawn_seed_stays_and_a_number_that_follows_is_not_written():
    scene = mcgw.scene_from(text(heights=None, ensemble={"seed": None, "n_asperities": None}))
    written = mcgw.scene_text(scene)
    assert "n_asperities" not in written
    assert "n_asperities = 7\n" in mcgw.scene_text(scene.replace(n_asperities=7))
    assert mcgw.scene_from(written).seed == scene.seed == scene.replace(title="y").seed


def test_the_most_surfaces_of_a_stop_rule_are_not_those_without_it():
    ruled = mcgw.Scene(surface=SURFACE, separations=(1.0,), ensemble=mcgw.Sampling(rel_err=0.01))
    assert (ruled.n_surfaces, ruled.replace(rel_err=None).n_surfaces) == (10**9, 1000)
    assert ruled.replace(n_surfaces=50).replace(rel_err=None).n_surfaces == 50
    left_out = mcgw.scene_text(ruled).replace("n_surfaces = 1000000000\n", "")
    assert mcgw.scene_from(left_out).replace(rel_err=None).n_surfaces == 1000


def test_replace_takes_fields_of_scene_and_surface_only():
    scene = mcgw.Scene(surface=SURFACE, separations=(1.0,))
    assert scene.replace(sigma="2 um", title="t", max_seconds="1 min").surface.sigma == 2e-6
    assert scene.replace(max_seconds="1 min").max_seconds == 60
    assert scene.replace(surface=LARGE, sigma=3e-6).surface == replace(LARGE, sigma=3e-6)
    with pytest.raises(TypeError):
        scene.replace(sigam=1.0)
    for key, law in (("gamma", "Homogeneous"), ("k", "Hertz"), ("alpha", "Gaussian")):
        with pytest.raises(mcgw.SceneError, match=rf"\.{key} = 2\.0: give it to the law, {law}, or leave"):
            scene.replace(**{key: 2.0})
