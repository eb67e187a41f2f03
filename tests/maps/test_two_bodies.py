"""Two rough bodies as one: sums by hand, and files of scenes that name two files."""

import numpy as np
import pytest

import mcgw
from mcgw.maps import Topography


def test_sums_of_two_bodies_and_what_lies_in_series():
    """By hand: moments, moduli, the softer one, both conductivities and 2 k1 k2/(k1 + k2)."""
    one = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", 3e11)
    other = mcgw.SpectralSurface(2e-12, 3e-3, 9e7, "1 mm^2", 6e11)
    bodies = [
        mcgw.Scene(
            x, separations=[0.0], contact=mcgw.Contact(hardness=hard), joint=mcgw.Joint(conductivities=(k, k))
        )
        for x, hard, k in ((one, 3e9, 150.0), (other, 2e9, 16.0))
    ]
    pair = mcgw.combine(*bodies)
    m = pair.moments
    assert (m.m0, m.m2, m.m4) == pytest.approx((3e-12, 4e-3, 9.5e7), rel=1e-13)
    assert (pair.surface.E_star, pair.surface.nominal_area) == (pytest.approx(2e11, rel=1e-14), 1e-6)
    assert (pair.hardness, pair.conductivities) == (2e9, (150.0, 16.0))
    assert pair.conductivity == pytest.approx(2 * 150 * 16 / 166, rel=1e-14)
    law = bodies[0].replace(hardness=None, law=mcgw.KogutEtsion(hardness=1e9))
    assert mcgw.combine(law, bodies[1]).hardness == 1e9
    assert mcgw.combine(bodies[0], other).conductivity is None
    given = mcgw.combine(one.moments, other, nominal_area="2 mm^2", E_star="5 GPa").surface
    assert (given.nominal_area, given.E_star) == (2e-6, 5e9)


def test_what_is_not_known_of_both_is_asked_for():
    a, b = (mcgw.SpectralSurface(1e-12, 1e-3, 5e6, area, 3e11) for area in ("1 mm^2", "2 mm^2"))
    scene = mcgw.Scene(a, separations=[0.0])
    pair = mcgw.Joint(conductivities=(150.0, 16.0))
    flat = mcgw.Scene(mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11), separations=[0.0])
    for one, other, keys, told in (
        (a, a.moments, {"E_star": 1e9}, "nominal_area: "),
        (a, a.moments, {"nominal_area": 1e-6}, "E_star: "),
        (a, b, {}, "nominal_area: is not the same"),
        (scene.replace(joint=pair), scene, {}, r"conductivities = .*those of a pair"),
        (flat, scene, {}, "combine: the scene has no spectrum"),
    ):
        with pytest.raises(mcgw.SceneError, match=told):
            mcgw.combine(one, other, **keys)
    with pytest.raises(TypeError, match=r"combine: give scenes, surfaces.*not str"):
        mcgw.combine("a.toml", a)


ONE = """
[surface]
m0 = "1 um^2"
m2 = 1e-3
m4 = 9e7
nominal_area = "1 mm^2"
bodies = [{E = "182 GPa", nu = 0.3}, {E = inf}]
[contact]
separations = [0.0]
[contact.law]
hardness = "2 GPa"
[joint]
conductivities = [150, 150]
"""
OTHER = ONE.replace("1 um", "2 um").replace("2 GPa", "3 GPa").replace("150", "16")
PAIR = """
[surface]
bodies = [{file = "a.toml"}, {file = "b.toml"}]
nominal_area = 1e-6
[contact]
separations = [0.0, 1.0]
"""


def load(folder, text, one=ONE, **keys):
    """The pair, beside files of both bodies."""
    (folder / "a.toml").write_text(one)
    (folder / "b.toml").write_text(OTHER)
    (folder / "pair.toml").write_text(text)
    return mcgw.load_scene(folder / "pair.toml", **keys)


def test_a_scene_names_the_files_of_two_bodies(tmp_path):
    """As `combine` of both scenes, read back from its text; what the scene gives itself counts."""
    scene = load(tmp_path, PAIR)
    one, other = (mcgw.load_scene(tmp_path / name) for name in ("a.toml", "b.toml"))
    pair = mcgw.combine(one, other)
    assert scene.surface == pair.surface
    assert (scene.hardness, scene.film.conductivities) == (pair.hardness, pair.conductivities)
    assert scene.heights.alpha == pytest.approx(3e-12 * 18e7 / 4e-6, rel=1e-12)
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
    own = {"contact.law.hardness": 1e9, "joint.resistivity": 1e-7}
    changed = load(tmp_path, PAIR, changes=own)
    assert (changed.hardness, changed.film.conductivities) == (1e9, None)
    assert load(tmp_path, PAIR, changes={"contact.law": "kogut-etsion"}).law.hardness == 2e9


def test_a_file_of_mcgw_fit_is_a_body(tmp_path):
    """Its moments under [fitted] count, whatever heights it has."""
    rough = Topography(1e-7 * np.random.default_rng(1).normal(size=(64, 64)), (1e-6, 1e-6))
    found = mcgw.fit(rough, cutoff=None)
    scene = load(tmp_path, PAIR, one=mcgw.scene_text(mcgw.fitted_scene(found, E_star=2e11)))
    expected = mcgw.combine(found.moments, mcgw.load_scene(tmp_path / "b.toml"), nominal_area=1, E_star=1)
    assert scene.heights.alpha == pytest.approx(expected.moments.alpha)


BOTH = "give {file = ...} of both, or E and nu of both"
SAME = ("", "")


@pytest.mark.parametrize(("a", "pair", "told"), [
    (SAME, ('{file = "b.toml"}', "{E = 1e9}"), BOTH),
    (SAME, ('"b.toml"}', '"b.toml", nu = 0.3}'), BOTH),
    (SAME, ('"b.toml"}', '"b.toml"}, {E = 1}'), BOTH),
    *((SAME, ("nominal_area", f"{key} = 1\nnominal_area"), f"surface.{key}: follows from the files")
      for key in ("sigma", "radius", "eta", "E_star", "m0", "m2", "m4")),
    (SAME, ("nominal_area = 1e-6", ""), "surface.nominal_area: missing"),
    (SAME, ("b.toml", "c.toml"), "c.toml: No such file"),
    (SAME, ("b.toml", "pair.toml"), "pair.toml: names the files of two bodies itself"),
    (("inf", "9e9"), SAME, "two elastic bodies; a file describes one on a rigid plane, {E = inf}"),
    (("150, 150", "150, 1"), SAME, "joint.conductivities = [150.0, 1.0]: those of a pair"),
    (("m2 = 1e-3", "m2 = -1"), SAME, "a.toml: surface.m2 = -1: give a finite number > 0"),
    (('m0 = "1 um^2"\nm2 = 1e-3\nm4', "sigma = 1e-6\nradius = 1e-5\neta"), SAME, "has no spectrum"),
    (("[contact]", "[contact"), SAME, "a.toml: "),
])  # fmt: skip
def test_files_that_do_not_describe_two_bodies_are_refused_in_one_line(tmp_path, a, pair, told):
    with pytest.raises(mcgw.SceneError) as refused:
        load(tmp_path, PAIR.replace(*pair), one=ONE.replace(*a))
    assert told in refused.value.problems[0]
    assert len(refused.value.problems) == 1


def test_a_contact_that_is_no_table_is_refused(tmp_path):
    with pytest.raises(mcgw.SceneError, match="contact = 3: must be a table"):
        load(tmp_path, "contact = 3\n" + PAIR.partition("[contact]")[0])
