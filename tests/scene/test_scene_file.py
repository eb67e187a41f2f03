"""Scenes as TOML: what is read, refused, and reads back the same; what is left out is marked in files."""

import re
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from oracles.inside import SURFACE_UNITS
from tables.scene_keys import text_of

import analytic
import mcgw

GOOD = """
[surface]
sigma = 1e-6
radius = 1e-5
eta = 1e9
nominal_area = 1e-6
E_star = 1e11
[contact]
separations = [0.0, 2.0]
[ensemble]
n_surfaces = 10
seed = 5
"""


def problems(text):
    with pytest.raises(mcgw.SceneError) as caught:
        mcgw.scene_from(text)
    return caught.value.problems


def test_what_is_left_out_has_its_default():
    scene = mcgw.scene_from(GOOD)
    assert scene.grading == analytic.Homogeneous()
    assert scene.quantities == ("load", "area", "stiffness", "contacts")
    assert (scene.n_asperities, scene.count, scene.sampler, scene.seed) == (1000, "fixed", "auto", 5)


@pytest.mark.parametrize("path", sorted(Path(__file__).parents[2].glob("runs/*.toml")), ids=lambda p: p.name)
def test_every_scene_of_runs_reads_back_the_same(path):
    scene = mcgw.load_scene(path)
    assert scene.title
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


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


def changed(old, new):
    assert old in GOOD
    return GOOD.replace(old, new)


def separations(text):
    return changed("[0.0, 2.0]", text)


def put(section, line):
    return GOOD.replace(f"[{section}]", f"[{section}]\n{line}")


# Text of a scene, and what its error must say: the key, and what would do.
BAD = [
    (separations("[1.0, -5e-324]"), "contact.separations: -4.94066e-324 is too close to 0"),
    (put("ensemble", "n_asperities = 9007199254740993"), "between 1 and 2^53"),
    (changed("sigma = 1e-6", "sigma = 1e-320"), "beyond double precision"),
    (changed("E_star = 1e11", "E_star = 1e308"), "beyond double precision"),
    (GOOD + '[grading]\nlaw = "table"\ns = [0.0, 9.0]\nratio = [1.0, -1.0]', "negative from s = 4.5"),
    (GOOD + '[grading]\nlaw = "table"\ns = [1.0, 0.0]\nratio = [1.0, 2.0]', "the heights must increase"),
    (put("contact", 'quantities = ["lod"]'),
     "contact.quantities = 'lod': did you mean load? choose one of load, area"),
    (changed("[contact]", "[contatc]"), "contact.separations: missing"),
    (put("surface", "sigma = 2e-6"), "this is not TOML"),
    (b"\xef\xbb\xbf" + GOOD.encode(), "this is not TOML"),
    (put("ensemble", f"n_asperities = {'9' * 5000}"), "this is not TOML"),
    (separations("[" * 5000 + "]" * 5000), "this is not TOML"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "message"), BAD)
def test_bad_scenes_are_refused_in_one_line(text, message):
    found = problems(text)
    assert any(message in line for line in found), found
    assert all("\n" not in line and len(line) < 300 for line in found)


def test_all_mistakes_at_once():
    text = changed("sigma = 1e-6", "sigam = 1e-6").replace("seed = 5", "seed = -1\nn_asperities = true")
    found = {line.split(" = ")[0].split(":")[0] for line in problems(text)}
    assert found == {"surface.sigma", "surface.sigam", "ensemble.n_asperities", "ensemble.seed"}


def test_other_ways_to_write_numbers():
    text = (
        put("ensemble", "n_asperities = 1_000").replace("seed = 5", "seed = 0x10").replace("[0.0,", "[-0.0,")
    )
    scene = mcgw.scene_from(text.replace("\n", "\r\n").encode())
    assert (scene.n_asperities, scene.seed) == (1000, 16)
    assert "-0.0" not in mcgw.scene_text(scene)
    assert mcgw.scene_from(put("ensemble", "n_asperities = 1e6")).n_asperities == 10**6


def test_negative_moduli_are_named_clipped_or_allowed():
    text = GOOD.replace("[0.0, 2.0]", "[-2.0, 2.0]") + '[grading]\nlaw = "exponential"\ngamma = 2.0\n'
    (line,) = problems(text)
    height = re.search(r"negative from s = (-?[\d.]+)", line)
    assert height
    assert -2.01 < float(height[1]) < -1.99  # gamma = 2: negative below ln 2, touched from -2 on
    for word in ("clip", "allow"):
        scene = mcgw.scene_from(text + f'negative = "{word}"\n')
        assert (scene.modulus(np.array([-1.0]))[0] < 0) == (word == "allow")
    (line,) = problems(GOOD + '[grading]\nlaw = "exponential"\ngamma = -0.5\n')
    assert "negative from s = 1.099" in line  # ln(1 + 1/0.5)


def test_files_that_are_none(tmp_path):
    with pytest.raises(mcgw.SceneError, match="No such file"):
        mcgw.load_scene(tmp_path / "absent.toml")
    (tmp_path / "long.toml").write_text(GOOD + "#" * 2**21)
    with pytest.raises(mcgw.SceneError, match="longer than 2097152 bytes"):
        mcgw.load_scene(tmp_path / "long.toml")


@pytest.mark.parametrize("gamma", [-3.0, -0.01, 0.0, 0.4, 1.0, 1.000001, 2.0, 50.0])
def test_a_negative_modulus_is_found_where_all_heights_are_looked_at(gamma):
    """A grading that rises all the way is looked at its ends alone, and found the same."""
    grading = analytic.Exponential(gamma)
    scene = mcgw.scene_from(GOOD).replace(grading=grading, negative="allow")
    found = []
    for h in np.linspace(-3.0, 3.0, 31):
        start, high = max(h, scene.least - 1), max(scene.highest, h + 1)
        found.append(scene.negative_above(h))
        assert found[-1] == analytic.first_negative(grading, start, high)
    assert any(x is not None for x in found) == (gamma < 0 or gamma >= 2)  # elsewhere far below, or nowhere


# --- what nobody gave ---

SURFACE = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11)
LARGE = replace(SURFACE, nominal_area=1e-5)


def test_n_follows_the_surface_unless_it_was_given(tmp_path):
    left_out = mcgw.Scene(surface=SURFACE, separations=(1.0,), seed=1)
    given = mcgw.Scene(surface=SURFACE, separations=(1.0,), ensemble=mcgw.Sampling(n_asperities=1000), seed=1)
    assert left_out == given  # the same ensemble, by whatever way
    assert hash(left_out.n_asperities) == hash(1000)
    assert repr(left_out) == repr(given)
    for scene in (left_out, given):  # and the same file
        assert mcgw.run(scene.replace(n_surfaces=2), tmp_path / "e.h5").n_surfaces == 2
    changes = (
        lambda s: s.replace(surface=LARGE),
        lambda s: s.replace(nominal_area=1e-5), lambda s: s.replace(nominal_area="10 mm²"),
    )  # fmt: skip
    for change in changes:
        assert change(left_out).n_asperities == 10_000
        assert change(left_out.replace(title="between")).n_asperities == 10_000
        assert change(given).n_asperities == 1000
        assert change(left_out.replace(n_asperities=1000)).n_asperities == 1000
        assert change(mcgw.scene_from(mcgw.scene_text(left_out))).n_asperities == 10_000
        assert change(mcgw.scene_from(mcgw.scene_text(given))).n_asperities == 1000
    assert left_out.replace(eta="2000/mm^2", nominal_area="1 cm^2").n_asperities == 200_000


def test_a_drawn_seed_stays_and_a_number_that_follows_is_not_written():
    text = text_of("", "title", "'x'").replace("seed = 1\n", "").replace("n_asperities = 3\n", "")
    scene = mcgw.scene_from(text.replace("resample = false\n", ""))
    written = mcgw.scene_text(scene)
    assert "n_asperities" not in written
    assert "n_asperities = 7\n" in mcgw.scene_text(scene.replace(n_asperities=7))
    assert mcgw.scene_from(written).seed == scene.seed == scene.replace(title="y").seed


def test_the_most_surfaces_of_a_stop_rule_are_not_those_without_it():
    ruled = mcgw.Scene(surface=SURFACE, separations=(1.0,), ensemble=mcgw.Sampling(rel_err=0.01))
    assert (ruled.n_surfaces, ruled.replace(rel_err=None).n_surfaces) == (10**9, 1000)
    assert ruled.replace(n_surfaces=50).replace(rel_err=None).n_surfaces == 50
    text = mcgw.scene_text(ruled).replace("n_surfaces = 1000000000\n", "")
    assert mcgw.scene_from(text).replace(rel_err=None).n_surfaces == 1000
    with pytest.raises(mcgw.SceneError, match=r"ensemble\.n_surfaces = 0"):
        mcgw.Scene(surface=SURFACE, separations=(1.0,), n_surfaces=0)


def test_replace_takes_fields_of_scene_and_surface_only():
    scene = mcgw.Scene(surface=SURFACE, separations=(1.0,))
    every = {f.name for f in fields(mcgw.Scene)} | SURFACE_UNITS.keys()
    assert every >= {"title", "sigma", "E_star"}
    assert scene.replace(sigma="2 um", title="t", max_seconds="1 min").surface.sigma == 2e-6
    assert scene.replace(max_seconds="1 min").max_seconds == 60
    assert scene.replace(surface=LARGE, sigma=3e-6).surface == replace(LARGE, sigma=3e-6)
    with pytest.raises(TypeError):
        scene.replace(sigam=1.0)
    with pytest.raises(ValueError, match=r"^surface\.sigma = '2 N': give a finite number > 0"):
        scene.replace(sigma="2 N")
