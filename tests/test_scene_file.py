"""Scenes as TOML: what is read, what is refused and how, and that they read back the same."""

import re
from pathlib import Path

import numpy as np
import pytest

import analytic
import mcgw
from mcgw.scene.scene import Scene, SceneError

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
    with pytest.raises(SceneError) as caught:
        mcgw.scene_from(text)
    return caught.value.problems


def test_what_is_left_out_has_its_default():
    scene = mcgw.scene_from(GOOD)
    assert scene.grading == analytic.Homogeneous()
    assert scene.quantities == ("load", "area", "stiffness", "contacts")
    assert (scene.n_asperities, scene.count, scene.sampler, scene.seed) == (1000, "fixed", "auto", 5)


def test_a_seed_left_out_is_drawn():
    text = GOOD.replace("seed = 5", "")
    assert mcgw.scene_from(text).seed != mcgw.scene_from(text).seed


@pytest.mark.parametrize(
    "path", sorted(Path(__file__).parent.parent.glob("runs/*.toml")), ids=lambda p: p.name
)
def test_every_scene_of_runs_reads_back_the_same(path):
    scene = mcgw.load_scene(path)
    assert scene.title
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


def test_bodies_make_the_composite_modulus():
    text = GOOD.replace("E_star = 1e11", "bodies = [{E = 70e9, nu = 0.33}, {E = inf}]")
    assert mcgw.scene_from(text).surface.E_star == pytest.approx(70e9 / (1 - 0.33**2), rel=1e-15)


def test_separations_as_a_range_or_one_number():
    text = GOOD.replace("[0.0, 2.0]", "{start = 0, stop = 4.0, num = 41}")
    assert mcgw.scene_from(text).separations == tuple(np.linspace(0, 4, 41))
    assert mcgw.scene_from(GOOD.replace("[0.0, 2.0]", "1")).separations == (1.0,)


def test_a_table_in_the_scene_or_beside_it(tmp_path):
    inline = GOOD + '[grading]\nlaw = "table"\ns = [-1.0, 1.0]\nratio = [0.5, 2.0]\n'
    assert mcgw.scene_from(inline).grading == analytic.Table([-1, 1], [0.5, 2])
    (tmp_path / "indents.csv").write_text("z,E_star\n-1e-6,5e10\n1e-6,2e11\n")
    scene = tmp_path / "scene.toml"
    scene.write_text(GOOD + '[grading]\nlaw = "table"\nfile = "indents.csv"\n')
    assert mcgw.load_scene(scene).grading == analytic.Table([-1, 1], [0.5, 2])
    assert mcgw.scene_from(mcgw.scene_text(mcgw.load_scene(scene))) == mcgw.load_scene(scene)


BAD = {
    "unknown key": ("sigma = 1e-6", "sigam = 1e-6", "surface.sigam: unknown key; did you mean sigma?"),
    "missing": ("radius = 1e-5", "", "surface.radius: missing; give it in m"),
    "type": ("radius = 1e-5", 'radius = "big"', "surface.radius = 'big': give a finite number > 0 in m"),
    "bool": ("n_surfaces = 10", "n_surfaces = true", "ensemble.n_surfaces = True: give a whole number >= 1"),
    "fraction": (
        "n_surfaces = 10",
        "n_surfaces = 1.5",
        "ensemble.n_surfaces = 1.5: give a whole number >= 1",
    ),
    "zero": ("n_surfaces = 10", "n_surfaces = 0", "ensemble.n_surfaces = 0: give a whole number >= 1"),
    "nan": ("sigma = 1e-6", "sigma = nan", "surface.sigma = nan: give a finite number > 0 in m"),
    "negative": ("eta = 1e9", "eta = -1.0", "surface.eta = -1.0: give a finite number > 0 in 1/m^2"),
    "empty": ("[0.0, 2.0]", "[]", "contact.separations = []: give at least one separation d/sigma"),
    "nan in a list": ("[0.0, 2.0]", "[nan]", "contact.separations = [nan]: give a list of finite numbers"),
    "no list": ("[0.0, 2.0]", '"0, 2"', "contact.separations = '0, 2': give a list of finite numbers"),
    "seed": ("seed = 5", "seed = -1", "ensemble.seed = -1: give a whole number >= 0"),
    "large seed": ("seed = 5", "seed = 18446744073709551616", "ensemble.seed = 18446744073709551616: give a"),
    "sampler": ("seed = 5", 'sampler = "cell"', "ensemble.sampler = 'cell': did you mean cells? choose one"),
    "huge N": ("seed = 5", "n_asperities = 99999999999999999999", "must lie between 1 and 2^53"),
    "grading": (
        "[contact]",
        "[grading]\ngamma = inf\n[contact]",
        "grading.gamma = inf: give a finite number",
    ),
    "unsorted table": (
        "[contact]",
        '[grading]\nlaw = "table"\ns = [1.0, 0.0]\nratio = [1.0, 2.0]\n[contact]',
        "the heights must increase",
    ),
    "no file": (
        "[contact]",
        '[grading]\nlaw = "table"\nfile = "absent.csv"\n[contact]',
        "grading.file = 'absent.csv': give a CSV file, or lists s and ratio; absent.csv: No such file",
    ),
    "scale": ("E_star = 1e11", "E_star = 1e308", "beyond double precision"),
    "quantity": (
        "[ensemble]",
        'quantities = ["lod"]\n[ensemble]',
        "contact.quantities: 'lod' is not one of load",
    ),
    "one body": ("E_star = 1e11", "bodies = [{E = 70e9}]", "give two, as [{E = 70e9, nu = 0.33}, {E = inf}]"),
    "section": ("[contact]", "[contatc]\n[contact]", "contatc: unknown key; did you mean contact?"),
    "no TOML": ("[surface]", "[surface", "not a TOML scene:"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_scenes(case):
    old, new, message = BAD[case]
    assert old in GOOD
    found = problems(GOOD.replace(old, new))
    assert any(message in line for line in found), found
    assert all("\n" not in line for line in found)


def test_all_mistakes_at_once():
    text = GOOD
    for case in ("unknown key", "nan", "bool", "seed", "sampler"):
        old, new, _ = BAD[case]
        text = text.replace(old, new) if old in text else text + new + "\n"
    found = "\n".join(problems(text))
    for key in ("surface.sigma: missing", "surface.sigam", "n_surfaces", "seed"):
        assert key in found


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


def test_a_wrong_scene_in_python_is_refused_too():
    with pytest.raises(SceneError, match="n_surfaces = 0"):
        Scene(surface=mcgw.scene_from(GOOD).surface, separations=(0.0,), n_surfaces=0)


def test_files_that_are_none(tmp_path):
    with pytest.raises(SceneError, match="No such file"):
        mcgw.load_scene(tmp_path / "absent.toml")
    with pytest.raises(SceneError, match="not a regular file"):
        mcgw.load_scene(tmp_path)
    (tmp_path / "binary.toml").write_bytes(bytes(range(256)))
    with pytest.raises(SceneError, match="not a TOML scene"):
        mcgw.load_scene(tmp_path / "binary.toml")


@pytest.mark.parametrize("gamma", [-3.0, -0.01, 0.0, 0.4, 1.0, 1.000001, 2.0, 50.0])
def test_a_negative_modulus_is_found_where_all_heights_are_looked_at(gamma):
    """A grading that rises all the way is looked at its ends alone, and found the same."""
    grading = analytic.Exponential(gamma)
    scene = mcgw.scene_from(GOOD).replace(grading=grading, negative="allow")
    found = []
    for h in np.linspace(-3.0, 3.0, 61):
        start, high = max(h, scene.least - 1), max(scene.highest, h + 1)
        found.append(scene.negative_above(h))
        assert found[-1] == analytic.first_negative(grading, start, high)
    assert any(x is not None for x in found) == (gamma < 0 or gamma >= 2)  # elsewhere far below, or nowhere
